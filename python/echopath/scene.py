"""Scenes: a tree of named nodes with meshes, materials and motions."""
from __future__ import annotations

import math

import numpy as np

from . import _core
from .keywords import known_keywords
from .materials import materials

_ORIGIN = (0.0, 0.0, 0.0)


class Scene(_core.Scene):
    """A tree of named nodes.

    nodes: list of Node, parents first; meshes: list of SceneMesh by mesh ID (.id, .name, .triangles [F, 3], .material)
    world_vertices(mesh_id, time): [V, 3] in m; num_triangles; breakpoints [N] in s
    """

    @known_keywords
    def add(self, mesh_or_actor=None, *, name, material=None, motion=None, position=_ORIGIN, yaw=0.0, transform=None,
            parent=None, smooth=False) -> str:
        """Adds an object and returns its full name, "street/pedestrian".

        mesh_or_actor: a Mesh; an Actor or a list of (name, Mesh), which becomes a node with a child for each part
            (a '/' in a part's name makes a group, a node at rest, in between); None: an empty node to hang others on
        name: without '/', '*', '?' and quotes, unique among its siblings
        material: a Material or a name in `materials`; each mesh needs one, an actor's parts bring theirs (one given
            here replaces them)
        motion: LinearMotion, KeyframeMotion, or for a mesh a VertexSequence or a Skin; None: at rest. A mesh with a Skin
            becomes a node with a child for each joint that dominates any of its triangles, named after the joint
            (Skin.parts); one that is itself part of a mesh (Mesh.part) is not taken apart
        position [3] in m, yaw in rad about z (left positive): placement at rest relative to the parent
        transform: [4, 4] instead of position and yaw; a motion turns the node about its own origin
        parent: full name of a node; None: the root
        smooth: True for meshes that stand for curved surfaces: normals, positions and curvature are interpolated, except
            across creases of more than 30 degrees; parts of actors may bring it themselves
        Raises ValueError or TypeError naming the argument; then nothing has been added.
        """
        if not isinstance(smooth, bool):
            raise TypeError(f"smooth: must be True or False, got {smooth!r}")
        batch = _Batch(self, self._index_of(parent), smooth)
        batch.add_object(mesh_or_actor, name, material, motion, _placement(position, yaw, transform))
        self._add_nodes(batch.nodes)
        return f"{parent}/{name}" if parent else name

    def to_pyvista(self, time: float = 0.0):
        """The meshes at `time` in s as a pyvista.MultiBlock by their full names, in the order of their IDs; points in m.

        Field data of a block: mesh_id; of its material material (name, "" without one), conductor and mirror (0 or 1),
        permittivity (real, imaginary), conductivity (S/m), reflectivity, roughness_height (m), scattering and
        cross_polarization, those that it has. Needs pyvista, raises ModuleNotFoundError without it.
        """
        from echopath_viewer import blocks_of

        return blocks_of(self, time)

    def _repr_html_(self) -> str:
        from .notebook import scene_html

        return scene_html(self)

    def _index_of(self, parent) -> int:
        if parent is None:
            return -1
        index = self.find(parent)
        if index is None:
            names = [node.name for node in self.nodes]
            nearest = ", ".join(_core.nearest_names(parent, names)) or "none, the scene is empty"
            raise ValueError(f"parent: must be the full name of a node (nearest: {nearest}), got {parent!r}")
        return index


class _Batch:
    """The nodes of one `add`, made before any of them is added."""

    def __init__(self, scene, parent: int, smooth: bool):
        self.nodes = []
        self._first = scene.num_nodes
        self._parent = parent
        self._smooth = smooth

    def add_object(self, content, name, material, motion, placement) -> None:
        if content is None or isinstance(content, _core.Mesh):
            self._add_mesh(name, self._parent, placement, motion, content, material)
            return
        parts = _parts_of(content, material)
        if motion is None:
            motion = getattr(content, "motion", None)
        self._add(name, self._parent, placement, motion, None, None)
        groups = {(): self._first}
        for part_name, mesh, part_material, part_motion, part_placement, part_smooth in parts:
            *path, own_name = str(part_name).split("/")
            self._add_mesh(own_name, self._group(groups, tuple(path)), part_placement, part_motion, mesh, part_material,
                           part_smooth)

    def _add_mesh(self, name, parent: int, placement, motion, mesh, material, smooth: bool = False) -> None:
        """A node with the mesh; below it the mesh's regions where a skin moves them."""
        if not isinstance(motion, _core.Skin) or mesh is None or mesh.whole is not None:
            self._add(name, parent, placement, motion, mesh, material, smooth)
            return
        group = self._add(name, parent, placement, None, None, None)
        for joint, part in motion.parts(mesh):
            self._add(joint, group, None, motion, part, material, smooth)

    def _group(self, groups: dict, path: tuple) -> int:
        """The node of a group, added with those above it where it is not there yet."""
        if path not in groups:
            groups[path] = self._add(path[-1], self._group(groups, path[:-1]), None, None, None, None)
        return groups[path]

    def _add(self, name, parent: int, placement, motion, mesh, material, smooth: bool = False) -> int:
        if not isinstance(name, str):
            raise TypeError(f"name: must be text, got {name!r}")
        material, material_name = _material(material, mesh, name)
        deformation = motion if isinstance(motion, _core.Deformation) else None
        if deformation is not None and mesh is None:
            raise ValueError(f"motion: a {type(motion).__name__} needs a mesh, and '{name}' has none of its own")
        if not (motion is None or deformation or isinstance(motion, _core.Motion)):
            raise TypeError(f"motion: must be a LinearMotion, KeyframeMotion, VertexSequence or Skin, got {motion!r}")
        self.nodes.append(_core.Node(name=name, parent=parent, placement=placement, motion=None if deformation else motion,
                                     mesh=mesh, deformation=deformation, material=material, material_name=material_name,
                                     smooth=(self._smooth or smooth) and mesh is not None))
        return self._first + len(self.nodes) - 1


def _parts_of(content, material) -> list:
    """(name, mesh, material, motion, placement, smooth) of each part of an actor or of a list of named meshes."""
    if hasattr(content, "parts"):
        return [(part.name, part.mesh, part.material if material is None else material, part.motion,
                 _placement(part.position, 0.0, None), getattr(part, "smooth", False)) for part in content.parts]
    if isinstance(content, (list, tuple)):
        if not all(_is_named_mesh(item) for item in content):
            raise TypeError("mesh_or_actor: a list must hold pairs (name, Mesh)")
        return [(name, mesh, material, None, None, False) for name, mesh in content]
    kind = type(content).__name__
    raise TypeError(f"mesh_or_actor: must be a Mesh, an Actor, a list of (name, Mesh) or None, got {kind}")


def _is_named_mesh(item) -> bool:
    return isinstance(item, (list, tuple)) and len(item) == 2 and isinstance(item[1], _core.Mesh)


def _material(material, mesh, name: str):
    """(Material or None, its name or "")."""
    if mesh is None:
        if material is not None:
            raise ValueError(f"material: must not be given without a mesh, got {material!r} for '{name}'")
        return None, ""
    if material is None:
        raise ValueError(f"material: the mesh '{name}' needs one, a Material or one of {', '.join(materials)}")
    if isinstance(material, str):
        try:
            return materials[material], material
        except KeyError as error:
            raise ValueError(f"material: {error.args[0]}") from None
    if not isinstance(material, _core.Material):
        raise TypeError(f"material: must be a Material or a name, got {material!r}")
    return material, materials.name_of(material)


def _placement(position, yaw, transform):
    """parent_from_node at rest, [4, 4]."""
    if transform is not None:
        if tuple(np.ravel(position)) != _ORIGIN or yaw != 0.0:
            raise ValueError("transform: must not be given together with position or yaw")
        return transform
    position = np.asarray(position, dtype=np.float64)
    if position.shape != (3,) or not np.isfinite(position).all():
        raise ValueError(f"position: must be three finite numbers in m, got {position.tolist()}")
    if not math.isfinite(yaw):
        raise ValueError(f"yaw: must be a finite angle in rad, got {yaw}")
    cos, sin = math.cos(yaw), math.sin(yaw)
    x, y, z = position
    return np.array([[cos, -sin, 0.0, x], [sin, cos, 0.0, y], [0.0, 0.0, 1.0, z], [0.0, 0.0, 0.0, 1.0]])
