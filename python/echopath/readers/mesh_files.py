"""What mesh files (OBJ, PLY, STL, OFF) hold, as meshes in the axes and units of a scene."""
from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .. import _core
from .axes import Axes
from .normals import welded_corners
from .tree import Tree

NO_AREA = "has no face with an area"


@dataclass(frozen=True)
class MeshPart:
    """The faces of one group and material. object: that the group lies in, "" for none; name: of the group, or of the file

    material: its name in the file, "" without; smooth: whether its normals say that it stands for a curved surface
    """

    object: str
    name: str
    material: str
    mesh: _core.Mesh
    smooth: bool

    @property
    def full_name(self) -> str:
        return f"{self.object}/{self.name}" if self.object else self.name


def parts_of_file(path: Path, axes: Axes, faceted: bool = False) -> tuple[list[MeshPart], list[str]]:
    """(parts with an area, what lines `mtllib` name) of a mesh file; faceted: whatever its normals say. Raises ep.FileError."""
    surfaces, libraries = _core.load_surfaces(path, axes.unit)
    made = (part_of(*surface, None if faceted else normals, axes) for *surface, normals in surfaces)
    parts = [part for part in made if part is not None]
    if not parts:
        raise _core.FileError(f"{path}: {NO_AREA}")
    return parts, libraries


def part_of(object_name: str, name: str, material: str, vertices, triangles, face, normals, axes: Axes) -> MeshPart | None:
    """The part of a group, in the units of a scene but the axes of its file; normals: of the corners, [3 F, 3], or None.

    Returns None where no triangle has an area.
    """
    smooth = False
    if normals is not None:
        kept, triangles, smooth = welded_corners(vertices, triangles, normals.reshape(-1, 3, 3))
        vertices = vertices[kept]
    try:
        mesh = _core.Mesh(axes.turned(vertices), triangles, original_triangle=face)
    except ValueError:
        return None
    return MeshPart(object_name, name, material, mesh, smooth)


@dataclass(frozen=True)
class MovedPart:
    """As MeshPart, as it is in the first of some frames; vertices: [T, V, 3] in m over all; name: "" for that of the file."""

    object: str
    name: str
    material: str
    vertices: np.ndarray
    mesh: _core.Mesh
    smooth: bool


def parts_of_frames(files: Sequence[Path], axes: Axes) -> list[MovedPart]:
    """Those of files whose faces are those of the first one. Raises ep.FileError naming one that has others."""
    surfaces, frames = _core.load_frames(files, axes.unit)
    parts = []
    for (object_name, name, material, first, triangles, _, normals), vertices in zip(surfaces, frames):
        smooth = False
        if normals is not None:  # which may say that vertices are two, but not that two of one place move as one
            kept, triangles, smooth = welded_corners(first, triangles, normals.reshape(-1, 3, 3), np.arange(len(first)))
            vertices = vertices[:, kept]
        vertices = axes.turned(vertices)
        try:
            mesh = _core.Mesh(vertices[0], triangles)
        except ValueError:
            continue  # no triangle with an area
        parts.append(MovedPart(object_name, "" if name == files[0].stem else name, material, vertices, mesh, smooth))
    if not parts:
        raise _core.FileError(f"{files[0]}: {NO_AREA}")
    return parts


class Groups:
    """Nodes of the objects and groups that parts lie in, each made once."""

    def __init__(self, tree: Tree, parts: Sequence[MeshPart] | Sequence[MovedPart]):
        self._tree = tree
        self._num_materials = Counter((part.object, part.name) for part in parts)
        self._made: dict[tuple[str, ...], int] = {}

    def place_of(self, part: MeshPart | MovedPart, name: str) -> tuple[int, str]:
        """(the node that a part lies in, its name there): of groups of several materials the name of its own.

        name: of its group
        """
        parent = self._once((part.object,), part.object, -1) if part.object else -1
        if self._num_materials[part.object, part.name] == 1:
            return parent, name
        return self._once((part.object, name), name, parent), part.material or "no_material"

    def _once(self, key: tuple[str, ...], name: str, parent: int) -> int:
        if key not in self._made:
            self._made[key] = self._tree.add(name, parent)
        return self._made[key]
