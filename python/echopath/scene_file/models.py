"""Foreign files that the tables of a scene file name, and the materials that they give."""
from __future__ import annotations

from pathlib import Path

from .. import _core
from ..base.materials import known_with, material_fields, materials
from ..base.storage.files import named_file
from ..readers import load_model
from ..readers.model import Model
from ..trajectories import Trajectory
from .errors import blamed
from .tables.object_tables import MODEL_KEYS, ModelKeys


def material_of(value, key: str) -> _core.Material | None:
    """The material of a value of a table, a name that must be known or a table of its own; None of None."""
    if value is None:
        return None
    with blamed(key):
        if isinstance(value, str):
            return materials[value]
        given = value.model_dump(exclude_unset=True)
        base, frequency = given.pop("base", None), given.pop("frequency", None)
        given = material_fields(given)
        return known_with(base, frequency, **given) if base is not None else _core.Material(**given)


def model_of(table: ModelKeys, folder: Path, key: str) -> Model:
    """The content of the foreign file that a table names."""
    settings = {name: getattr(table, name) for name in MODEL_KEYS if getattr(table, name) is not None}
    settings["materials"] = {name: material_of(value, f"{key}.materials.{name}") for name, value in table.materials.items()}
    with blamed(f"{key}.model"):
        return load_model(named_file(folder, table.model), **settings)


def model_along(model: Model, table: ModelKeys, key: str, trajectory: Trajectory | None) -> Model:
    """The model as its table plays it along a trajectory; as it is where the table has no way."""
    if table.way is None:
        return model
    with blamed(f"{key}.way"):
        return model.along(trajectory, way=None if table.way == "auto" else table.way)
