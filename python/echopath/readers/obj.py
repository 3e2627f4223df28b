"""Mesh files (OBJ, PLY, STL, OFF) as models: a node for each group, taken apart by material."""
from __future__ import annotations

from pathlib import Path

from .axes import Axes
from .mesh_files import Groups, parts_of_file
from .model import Model
from .options import ReadOptions
from .sampled import chosen_animation
from .tree import Tree


def read(path: Path, options: ReadOptions) -> Model:
    """A Model of a mesh file. Its axes are those of a scene and its unit is 1 m, unless the options say otherwise."""
    chosen_animation(options, ())
    axes = Axes(options)
    parts, libraries = parts_of_file(path, axes)
    tree = Tree(options)
    groups = Groups(tree, parts)
    for part in parts:
        parent, name = groups.place_of(part, part.name)
        tree.add(name, parent, mesh=part.mesh, foreign_material=part.material, smooth=part.smooth)
    for sentence in _notes_of_libraries(path, libraries, {part.material for part in parts} - {""}):
        tree.note(sentence)
    return tree.model(format=path.suffix[1:].upper(), unit=axes.unit, up=axes.up)


def _notes_of_libraries(path: Path, libraries: list[str], used: set[str]) -> list[str]:
    """What to say of the MTL files of an OBJ file: those that are missing, and names that none of them has."""
    notes, known, missing = [], set(), False
    for line in dict.fromkeys(name.replace("\\", "/") for name in libraries):  # as programs of Windows write paths
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
    statements = (_text(line).split(maxsplit=1) for line in path.read_bytes().splitlines())  # as any system ends them
    return {words[1].strip() for words in statements if len(words) == 2 and words[0] == "newmtl"}


def _text(line: bytes) -> str:
    """As the OBJ file is read, whose names these are: UTF-8, or else Latin-1."""
    try:
        return line.decode("utf-8-sig")
    except UnicodeDecodeError:
        return line.decode("latin-1")
