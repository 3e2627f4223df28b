"""Mesh files (OBJ, PLY, STL, OFF) as models: a node for each group, taken apart by material."""
from __future__ import annotations

from pathlib import Path

from .. import _core
from .axes import Axes
from .model import Model
from .options import ReadOptions
from .sampled import chosen_animation
from .tree import Tree

NAMES = {".obj": "OBJ", ".ply": "PLY", ".stl": "STL", ".off": "OFF"}


def read(path: Path, options: ReadOptions) -> Model:
    """A Model of a mesh file. Its axes are those of a scene and its unit is 1 m, unless the options say otherwise."""
    chosen_animation(options, ())
    axes = Axes(options)
    surfaces, libraries = _core.load_surfaces(path, axes.unit)
    tree = Tree(options)
    materials_of_group: dict[str, int] = {}
    for name, _, _ in surfaces:
        materials_of_group[name] = materials_of_group.get(name, 0) + 1
    groups: dict[str, int] = {}
    for name, material, mesh in surfaces:
        parent = -1
        if materials_of_group[name] > 1:
            if name not in groups:
                groups[name] = tree.add(name)
            parent = groups[name]
        own_name = name if parent < 0 else material or "no_material"
        tree.add(own_name, parent, mesh=turned(mesh, axes), foreign_material=material)
    for sentence in _notes_of_libraries(path, libraries, {material for _, material, _ in surfaces} - {""}):
        tree.note(sentence)
    return tree.model(format=NAMES[path.suffix.lower()], unit=axes.unit, up=axes.up)


def turned(mesh: _core.Mesh, axes: Axes) -> _core.Mesh:
    """A mesh in m with the vertical axis of a file, turned to z up."""
    if axes.up == "z":
        return mesh
    return _core.Mesh(axes.turned(mesh.vertices), mesh.triangles, original_triangle=mesh.original_triangle)


def _notes_of_libraries(path: Path, libraries: list[str], used: set[str]) -> list[str]:
    """What to say of the MTL files of an OBJ file: those that are missing, and names that none of them has."""
    notes, known, missing = [], set(), False
    for line in dict.fromkeys(libraries):
        names = [line] if _is_file(path.parent / line) else line.split()  # a name may hold spaces
        for name in names:
            try:
                known |= _materials_of(path.parent / name)
            except (OSError, ValueError):
                missing = True
                notes.append(f"the material file '{name}' cannot be read; materials go by their names in the OBJ file")
    lacking = sorted(used - known)
    if libraries and not missing and lacking:
        notes.append(f"materials that no MTL file has: {', '.join(lacking[:8])}{', ...' if len(lacking) > 8 else ''}")
    return notes


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def _materials_of(path: Path) -> set[str]:
    """The names of the materials in an MTL file. Raises OSError, or ValueError for a name that cannot be one."""
    with path.open(encoding="utf-8", errors="replace") as lines:
        statements = (line.split(maxsplit=1) for line in lines)
        return {words[1].strip() for words in statements if len(words) == 2 and words[0] == "newmtl"}
