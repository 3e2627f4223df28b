"""Foreign files by their suffix."""
from __future__ import annotations

import dataclasses
import importlib
import os
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from .. import _core
from ..arguments.checks import Rule, carrier, checked, choice, flag, optional, path as file_or_folder, real, refused, text
from ..arguments.names import first_names
from ..arguments.number_rules import unit_rule
from ..base.process.callers import warn_user
from ..base.storage.files import require_readable
from ..base.storage.pointers import pointers_are_told
from .loops import note_of_jump
from .material_names import Meaning, checked_materials, note_of_unused
from .model import Model
from .options import ReadOptions
from .sizes import figure_doubt

# suffix -> module of this package with `read(path, options) -> Model`; imported when the first such file is read
READERS: dict[str, str] = {
    ".glb": "gltf", ".gltf": "gltf", ".vrm": "gltf", **dict.fromkeys(_core.MESH_SUFFIXES, "obj"), ".xml": "mitsuba",
    ".usd": "usd", ".usda": "usd", ".usdc": "usd", ".usdz": "usd", ".npz": "frames", ".bvh": "bvh",
}


# rules of what load_model and load_scene may be told of a file
READ_RULES: dict[str, Rule] = {
    "unit": optional(unit_rule), "up": optional(choice("x", "y", "z")), "materials": checked_materials,
    "animation": optional(text), "loop": flag, "offset": real(unit="s"), "smooth": optional(flag), "frequency": optional(carrier),
}


@checked(path=file_or_folder, **READ_RULES)
def load_model(path: str | os.PathLike[str], *, unit: float | None = None, up: str | None = None,
               materials: Mapping[str, Meaning] | None = None, animation: str | None = None, loop: bool = False,
               offset: float = 0.0, smooth: bool | None = None, frequency: float | None = None) -> Model:
    """The objects of a foreign file as a tree of nodes, for Scene.add.

    path: its suffix tells the format: glTF 2.0 (.glb, .gltf, .vrm), OBJ, PLY, STL, OFF, USD, Mitsuba XML, NPZ, BVH; or a
        folder of OBJ files, one for each frame
    unit: m per unit of the file, 1e-12 to 1e9; None: as the file says, or its format (glTF: 1)
    up: the file's vertical axis, "x", "y" or "z"; None: as the file says, or its format (glTF: "y"). The model stands with z
        up and looks along +x where the file follows its format
    materials: {pattern of names in the file: Material or a name in ep.materials}, before `ep.foreign_materials`; what is not
        known there either gets a default, and patterns may take nothing: the notes tell
    animation: name of one of the file's; None: its first one, if there is any; "": at rest
    loop: True: the animation begins anew at its end, without end, that of glTF with its first key; False: its last pose is held,
        but frames and motion captures end with it
    offset: s, the time of the animation at time 0 of the scene
    smooth: whether its meshes stand for curved surfaces (Scene.add); None: those whose normals in the file turn over most of
        their area, smoothing groups of an OBJ file included, and what the format itself makes of curves, such as spheres
    frequency: Hz, at which materials by name have their values (`ep.materials.at`); None: 77 GHz, as in `ep.materials`. The
        notes name those that stay at 77 GHz
    Returns a Model, whose `notes` say what was left out, guessed or mended. Raises ep.FileError naming the file and the
    place in it, also of a file without any surface; ValueError or TypeError naming the argument; ModuleNotFoundError saying what
    to install. Warns (RuntimeWarning) of a figure with a skeleton whose size is hardly right, unless its unit is given.
    """
    file = Path(path)
    model = read_model(file, ReadOptions(unit, up, materials or {}, animation, loop, offset, smooth, frequency))
    doubt = figure_doubt(model, file.stem) if unit is None else None
    if doubt:
        warn_user(f"{file}: {doubt}")
    return model


def read_model(file: Path, options: ReadOptions) -> Model:
    """`load_model` without a word on its size."""
    try:
        reader = importlib.import_module(f".{reader_of(file)}", __package__)
        with pointers_are_told(file), np.errstate(all="ignore"):  # of numbers that no model can have, refused where checked
            model = reader.read(file, options)
    except RecursionError:
        raise _core.FileError(f"{file}: is nested too deeply") from None
    _require_surfaces(file, model)
    with np.errstate(all="ignore"):
        notes = [*note_of_unused(options.materials, [node.foreign_material for node in model.nodes]), *note_of_jump(model)]
    return dataclasses.replace(model, notes=(*model.notes, *notes)) if notes else model


def _require_surfaces(file: Path, model: Model) -> None:
    """Raises ep.FileError for a model without meshes, with what its notes tell of why."""
    if any(node.mesh is not None for node in model.nodes):
        return
    alone = f"; it has animations alone ({first_names(model.animations)})" if model.animations else ""
    raise _core.FileError("; ".join([f"{file}: holds no surface{alone}", *model.notes[:3]]))


def is_foreign(path: Path) -> bool:
    """Whether a path is one of those that load_model reads."""
    return path.suffix.lower() in READERS or path.is_dir()


def reader_of(path: Path) -> str:
    """The module that reads a file; raises ValueError for another kind and ep.FileError where there is nothing to read."""
    module = READERS.get(path.suffix.lower())
    if module is None and path.is_dir():
        return "frames"
    if module is None:
        hint = "; ep.load_scene reads scene files" if path.suffix.lower() == ".toml" else ""
        raise refused(ValueError, "path", f"a file of the kinds {', '.join(READERS)}, or a folder of OBJ files{hint}", str(path))
    if path.is_dir():
        raise _core.FileError(f"{path}: is a directory")
    require_readable(path)
    if not path.is_file():
        raise _core.FileError(f"{path}: cannot be opened")
    return module
