"""Foreign files by their suffix."""
from __future__ import annotations

import importlib
import os
from collections.abc import Mapping
from pathlib import Path

from .. import _core
from ..checks import anything, checked, choice, flag, optional, real, refused, text
from ..meshes import UNIT
from .model import Model
from .options import ReadOptions

# suffix -> module of this package with `read(path, options) -> Model`; imported when the first such file is read
READERS: dict[str, str] = {".glb": "gltf", ".gltf": "gltf"}


@checked(unit=optional(UNIT), up=optional(choice("x", "y", "z")), materials=anything, animation=optional(text), loop=flag,
         offset=real(unit="s"))
def load_model(path: str | os.PathLike[str], *, unit: float | None = None, up: str | None = None,
               materials: Mapping[str, object] | None = None, animation: str | None = None, loop: bool = False,
               offset: float = 0.0) -> Model:
    """The objects of a foreign file as a tree of nodes, for Scene.add.

    path: its suffix tells the format: .glb or .gltf (glTF 2.0)
    unit: m per unit of the file, 1e-12 to 1e9; None: as the file says (glTF: 1)
    up: the file's vertical axis, "x", "y" or "z"; None: as the file says (glTF: "y"). The model stands with z up and looks
        along +x where the file follows its format
    materials: {name in the file: Material or a name in `materials`}; other names go by `foreign_materials`, and what is
        not known there gets a default, which the notes tell
    animation: name of one of the file's; None: its first one, if there is any; "": at rest
    loop: True: the animation begins anew at its end; False: its last pose is held
    offset: s, the time of the animation at time 0 of the scene
    Returns a Model, whose `notes` say what was left out, guessed or mended. Raises FileError naming the file and the place
    in it; ValueError or TypeError naming the argument.
    """
    path = Path(path)
    module = READERS.get(path.suffix.lower())
    if module is None:
        raise refused(ValueError, "path", f"a file of the kinds {', '.join(READERS)}", str(path))
    if not (materials is None or isinstance(materials, Mapping)):
        raise refused(TypeError, "materials", "a mapping of names to materials or None", materials)
    if not path.is_file():
        raise _core.FileError(f"{path}: cannot be read (no such file)")
    options = ReadOptions(unit, up, dict(materials or {}), animation, loop, offset)
    return importlib.import_module(f".{module}", __package__).read(path, options)
