"""Scene files: TOML read against a schema, faults told by their place (keys: data/README.md)."""
from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

from ..arguments.checks import checked, path as file_or_folder
from ..readers.load import READ_RULES
from ..readers.material_names import Meaning
from ..readers.options import ReadOptions
from .scene_file import SceneFile


@checked(path=file_or_folder, **READ_RULES)
def load_scene(path: str | os.PathLike[str], *, unit: float | None = None, up: str | None = None,
               materials: Mapping[str, Meaning] | None = None, animation: str | None = None, loop: bool = False,
               offset: float = 0.0, smooth: bool | None = None, frequency: float | None = None) -> SceneFile:
    """Reads a scene file (keys and units: data/README.md), or what load_model reads as the content of a scene.

    path: of the TOML file, or of a foreign scene in one of the formats of load_model, by its suffix
    unit, up, materials, animation, loop, offset, smooth, frequency: of a foreign scene, as of load_model
    Returns a SceneFile; that of a foreign scene has its content below one object, named after the file, the settings of an
    empty scene file, and no radar. `[[objects]]` with `model` put it into a scene file.
    Raises ep.FileError when the file cannot be read; ValueError naming the file, the line, the dotted path of the key, the rule
    and the value for each fault of its content, or the line of a fault of its syntax, and for arguments beside the path of a
    scene file, whose objects have these as keys.
    """
    from .load import read_scene  # with scene files alone: pydantic and the schema take a third of the time to import

    options = ReadOptions(unit, up, materials or {}, animation, loop, offset, smooth, frequency)
    return read_scene(Path(path), options)


__all__ = ["SceneFile", "load_scene"]
