"""Scenes in HDF5 groups (layout: data/README.md)."""
from __future__ import annotations

import numpy as np

from ... import _core
from ...scene.node import ALWAYS
from ...scene.scene import Scene
from ..h5 import blames_group, read_array, read_attribute, read_group, read_texts, write_array, write_attribute, write_texts
from .deformation import read_deformation, write_deformation
from .kept_meshes import KeptMeshes
from .motion import read_motion, write_motion

NONE = -1  # index that means "has none"


class _Pool:
    """Objects that several nodes share, each kept once, and first those that others are parts of."""

    def __init__(self, items=()):
        self.items, self._index = [], {}
        for item in items:
            self.index(item)

    def index(self, item) -> int:
        if item is None:
            return NONE
        if id(item) not in self._index:  # of what `items` keeps alive
            self._index[id(item)] = len(self.items)
            self.items.append(item)
        return self._index[id(item)]


def write_scene(group, scene) -> None:
    """Writes nodes, meshes, materials, motions and deformations; what nodes share is written once."""
    nodes = list(scene.nodes)
    write_texts(group, "name", [node.name for node in nodes])
    write_texts(group, "material_name", [node.material_name for node in nodes])
    write_array(group, "smooth", np.array([node.smooth for node in nodes], np.uint8))
    write_array(group, "visible", np.array([node.visible for node in nodes], np.uint8))
    if scene._has_lifetimes:
        lifetimes = [node.lifetime or ALWAYS for node in nodes]
        write_array(group, "lifetime", np.array(lifetimes, np.float64), unit="s")
    write_array(group, "parent", np.array([node.parent for node in nodes], np.int32))
    placements = np.array([node.placement for node in nodes], np.float64).reshape(-1, 4, 4)
    write_array(group, "placement", placements, unit="m")
    wholes = [node.mesh.whole for node in nodes if node.mesh is not None]
    for kind, (folder, write, _) in _SHARED.items():
        pool = _Pool(wholes if kind == "mesh" else [])
        write_array(group, kind, np.array([pool.index(getattr(node, kind)) for node in nodes], np.int32))
        _write_pool(group.create_group(folder), pool, write)


@blames_group
def read_scene(group, meshes: KeptMeshes | None = None):
    """The scene of a group, with the mesh IDs it had; meshes: those of the scene that was read before it, None: of none."""
    names = read_texts(group, "name")
    count = len(names)
    material_names = read_texts(group, "material_name", count)
    smooth = read_array(group, "smooth", np.uint8, (count,))
    visible = read_array(group, "visible", np.uint8, (count,))
    lifetimes = _read_lifetimes(group, count)
    parents = read_array(group, "parent", np.int32, (count,))
    placements = read_array(group, "placement", np.float64, (count, 4, 4))
    shared = {kind: _read_shared(group, kind, count, meshes) for kind in _SHARED}
    nodes = []
    for index in range(count):
        parent = int(parents[index])
        if not NONE <= parent < index:
            raise _core.FileError(f"{group.name}/parent: must name an earlier node, is {parent} at node {index}")
        own_name = names[index] if parent == NONE else names[index].removeprefix(names[parent] + "/")
        nodes.append(_core.Node(name=own_name, parent=parent, placement=placements[index],
                                material_name=material_names[index], smooth=bool(smooth[index]),
                                visible=bool(visible[index]), lifetime=lifetimes[index],
                                **{kind: items[index] for kind, items in shared.items()}))
    scene = Scene()
    scene._add_nodes(nodes)
    return scene


def _read_lifetimes(group, count: int) -> list:
    """(begin, end) in s of each node, None of what is always there."""
    if "lifetime" not in group:
        return [None] * count
    lifetimes = read_array(group, "lifetime", np.float64, (count, 2))
    if not np.all(lifetimes[:, 0] < lifetimes[:, 1]):
        raise _core.FileError(f"{group.name}/lifetime: must hold begins and ends, ascending")
    return [(begin, end) for begin, end in lifetimes.tolist()]


def _write_pool(group, pool: _Pool, write) -> None:
    for index, item in enumerate(pool.items):
        write(group.create_group(str(index)), item, pool)


def _read_shared(group, kind: str, count: int, meshes: KeptMeshes | None) -> list:
    """What each node has of one kind, None where it has none."""
    folder, _, read = _SHARED[kind]
    indices = read_array(group, kind, np.int32, (count,))
    source = read_group(group, folder)
    if kind == "mesh" and meshes is not None:
        items = meshes.of(source, lambda: _read_pool(source, read))
    else:
        items = _read_pool(source, read)
    if count and not (indices.min() >= NONE and indices.max() < len(items)):
        raise _core.FileError(f"{group.name}/{kind}: must lie in {NONE} to {len(items) - 1}, as there are {len(items)} "
                              f"{group.name}/{folder}")
    return [None if index == NONE else items[index] for index in indices]


def _read_pool(source, read) -> list:
    items = []
    for index in range(len(source)):
        items.append(read(read_group(source, str(index)), items))
    return items


def _write_mesh(group, mesh, pool: _Pool) -> None:
    """As before vertices were duplicated: deformations go by those, and the same repair follows on reading."""
    if mesh.whole is not None:
        write_attribute(group, "whole", pool.index(mesh.whole))
        write_array(group, "whole_triangle", mesh.whole_triangle, compress=True)
        return
    vertices = np.zeros((mesh.num_input_vertices, 3))
    vertices[mesh.original_vertex] = mesh.vertices
    write_array(group, "vertices", vertices, unit="m", compress=True)
    write_array(group, "triangles", mesh.original_vertex[mesh.triangles], compress=True)
    write_array(group, "original_triangle", mesh.original_triangle, compress=True)


@blames_group
def _read_mesh(group, earlier: list):
    if "whole" in group.attrs:
        index = read_attribute(group, "whole", int)
        if not 0 <= index < len(earlier):
            raise _core.FileError(f"{group.name}: attribute whole must name an earlier mesh, is {index}")
        return earlier[index].part(read_array(group, "whole_triangle", np.uint32, (None,)))
    vertices = read_array(group, "vertices", np.float64, (None, 3))
    triangles = read_array(group, "triangles", np.uint32, (None, 3))
    original_triangle = read_array(group, "original_triangle", np.uint32, (len(triangles),))
    mesh = _core.Mesh(vertices, triangles, original_triangle)
    if len(mesh.triangles) != len(triangles):
        raise _core.FileError(f"{group.name}/triangles: {len(triangles) - len(mesh.triangles)} have no area")
    return mesh


_MATERIAL_KINDS = {"conductor": bool, "permittivity": complex, "conductivity": float, "reflectivity": float,
                   "roughness_height": float, "scattering": float, "cross_polarization": float, "mirror": bool,
                   "lobe_exponent": int, "backscatter_share": float, "backscatter_exponent": int}


def _write_material(group, material) -> None:
    for field in _MATERIAL_KINDS:
        value = getattr(material, field)
        if value is not None:
            write_attribute(group, field, value)
    if material.layers:
        write_array(group, "layer_thickness", np.array([layer.thickness for layer in material.layers]), unit="m")
        write_array(group, "layer_permittivity", np.array([layer.permittivity for layer in material.layers], np.complex128))
        write_array(group, "layer_conductivity", np.array([layer.conductivity for layer in material.layers]), unit="S/m")


@blames_group
def _read_material(group):
    return _core.Material(layers=_read_layers(group), **{field: read_attribute(group, field, kind)
                                                         for field, kind in _MATERIAL_KINDS.items() if field in group.attrs})


def _read_layers(group) -> list:
    if "layer_thickness" not in group:
        return []
    thickness = read_array(group, "layer_thickness", np.float64, (None,))
    permittivity = read_array(group, "layer_permittivity", np.complex128, thickness.shape)
    conductivity = read_array(group, "layer_conductivity", np.float64, thickness.shape)
    return [_core.Layer(*layer) for layer in zip(thickness.tolist(), permittivity.tolist(), conductivity.tolist())]


def _alone(function):
    """For kinds whose items know nothing of one another."""
    return lambda *arguments: function(*arguments[:-1])


# What nodes share: name of the node's field -> (group, how to write one, how to read one).
_SHARED = {"mesh": ("meshes", _write_mesh, _read_mesh),
           "material": ("materials", _alone(_write_material), _alone(_read_material)),
           "motion": ("motions", _alone(write_motion), _alone(read_motion)),
           "deformation": ("deformations", _alone(write_deformation), _alone(read_deformation))}
