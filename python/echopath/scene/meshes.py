"""Meshes of files."""
from __future__ import annotations

import os

from .. import _core
from ..arguments.checks import checked, file
from ..arguments.number_rules import unit_rule
from ..base.storage.pointers import pointers_are_told
from ..base.text.node_names import fit_paths


@checked(path=file, unit=unit_rule)
def load_mesh(path: str | os.PathLike[str], unit: float = 1.0) -> _core.Mesh:
    """All faces of a mesh file as one mesh.

    path: an OBJ, PLY (ASCII or binary), STL (text or binary) or OFF file; unit: m per file unit, 1e-12 to 1e9
    Returns a Mesh; its original_triangle counts the faces of the file from 0.
    Raises FileError naming the file, and the line where it is text; TypeError or ValueError naming the argument.
    """
    with pointers_are_told(path):
        return _core.load_mesh(path, unit)


@checked(path=file, unit=unit_rule)
def load_meshes(path: str | os.PathLike[str], unit: float = 1.0) -> list[tuple[str, _core.Mesh]]:
    """The groups of a mesh file.

    path: an OBJ file, whose groups (or objects, where there is no group) become meshes, an STL text, whose solids do, or a
        PLY, binary STL or OFF file. Groups of several materials stay whole (load_model takes them apart)
    unit: m per file unit, 1e-12 to 1e9
    Returns a list of (name, Mesh); the name is the file's stem where the file gives none, '/' in it parts groups of groups, and
    signs that a scene refuses become '_'. Groups without any area are left out. Raises FileError naming the file, and the line
    where it is text; TypeError or ValueError naming the argument.
    """
    with pointers_are_told(path):
        meshes = _core.load_meshes(path, unit)
    return list(zip(fit_paths(name for name, _ in meshes), (mesh for _, mesh in meshes)))
