"""Scenes and radars in HDF5 groups (layout: data/README.md)."""
from __future__ import annotations

import numpy as np

import echopath as ep

from .h5 import read_array, read_attribute, read_group, read_texts, write_array, write_texts

NONE = -1  # index that means "has none"


class _Pool:
    """Objects that several nodes share, each kept once."""

    def __init__(self):
        self.items = []

    def index(self, item) -> int:
        if item is None:
            return NONE
        for index, known in enumerate(self.items):
            if known is item:
                return index
        self.items.append(item)
        return len(self.items) - 1


def write_scene(group, scene) -> None:
    """Writes nodes, meshes, materials, motions and vertex sequences; what nodes share is written once."""
    nodes = list(scene.nodes)
    write_texts(group, "name", [node.name for node in nodes])
    write_texts(group, "material_name", [node.material_name for node in nodes])
    write_array(group, "smooth", np.array([node.smooth for node in nodes], np.uint8))
    write_array(group, "parent", np.array([node.parent for node in nodes], np.int32))
    placements = np.array([node.placement for node in nodes], np.float64).reshape(-1, 4, 4)
    write_array(group, "placement", placements, unit="m")
    for kind, (folder, write, _) in _SHARED.items():
        pool = _Pool()
        write_array(group, kind, np.array([pool.index(getattr(node, kind)) for node in nodes], np.int32))
        _write_pool(group.create_group(folder), pool, write)


def read_scene(group):
    """The scene of a group, with the mesh IDs it had."""
    names = read_texts(group, "name")
    count = len(names)
    material_names = read_texts(group, "material_name", count)
    smooth = read_array(group, "smooth", np.uint8, (count,))
    parents = read_array(group, "parent", np.int32, (count,))
    placements = read_array(group, "placement", np.float64, (count, 4, 4))
    shared = {kind: _read_shared(group, kind, count) for kind in _SHARED}
    nodes = []
    for index in range(count):
        parent = int(parents[index])
        if not NONE <= parent < index:
            raise ep.FileError(f"{group.name}/parent: must name an earlier node, is {parent} at node {index}")
        own_name = names[index] if parent == NONE else names[index].removeprefix(names[parent] + "/")
        nodes.append(ep._core.Node(name=own_name, parent=parent, placement=placements[index],
                                   material_name=material_names[index], smooth=bool(smooth[index]),
                                   **{kind: items[index] for kind, items in shared.items()}))
    scene = ep.Scene()
    scene._add_nodes(nodes)
    return scene


def _write_pool(group, pool: _Pool, write) -> None:
    for index, item in enumerate(pool.items):
        write(group.create_group(str(index)), item)


def _read_shared(group, kind: str, count: int) -> list:
    """What each node has of one kind, None where it has none."""
    folder, _, read = _SHARED[kind]
    indices = read_array(group, kind, np.int32, (count,))
    source = read_group(group, folder)
    items = [read(read_group(source, str(index))) for index in range(len(source))]
    if count and not (indices.min() >= NONE and indices.max() < len(items)):
        raise ep.FileError(f"{group.name}/{kind}: must lie in {NONE} to {len(items) - 1}")
    return [None if index == NONE else items[index] for index in indices]


def _write_mesh(group, mesh) -> None:
    """As before vertices were duplicated: vertex sequences go by those, and the same repair follows on reading."""
    vertices = np.zeros((mesh.num_input_vertices, 3))
    vertices[mesh.original_vertex] = mesh.vertices
    write_array(group, "vertices", vertices, unit="m", compress=True)
    write_array(group, "triangles", mesh.original_vertex[mesh.triangles], compress=True)
    write_array(group, "original_triangle", mesh.original_triangle, compress=True)


def _read_mesh(group):
    vertices = read_array(group, "vertices", np.float64, (None, 3))
    triangles = read_array(group, "triangles", np.uint32, (None, 3))
    original_triangle = read_array(group, "original_triangle", np.uint32, (len(triangles),))
    mesh = ep.Mesh(vertices, triangles, original_triangle)
    if len(mesh.triangles) != len(triangles):
        raise ep.FileError(f"{group.name}/triangles: {len(triangles) - len(mesh.triangles)} have no area")
    return mesh


_MATERIAL_KINDS = {"conductor": bool, "permittivity": complex, "conductivity": float, "reflectivity": float,
                   "roughness_height": float, "scattering": float, "cross_polarization": float, "mirror": bool}


def _write_material(group, material) -> None:
    for field in _MATERIAL_KINDS:
        value = getattr(material, field)
        if value is not None:
            group.attrs[field] = value


def _read_material(group):
    return ep.Material(**{field: read_attribute(group, field, kind) for field, kind in _MATERIAL_KINDS.items()
                          if field in group.attrs})


def write_motion(group, motion) -> None:
    """Writes a linear motion, keyframes or a vertex sequence."""
    if isinstance(motion, ep.LinearMotion):
        group.attrs["kind"] = "linear"
        write_array(group, "velocity", motion.velocity, unit="m/s")
        write_array(group, "angular_velocity", motion.angular_velocity, unit="rad/s")
        return
    if not isinstance(motion, (ep.KeyframeMotion, ep.VertexSequence)):
        raise ValueError(f"motion: must be a LinearMotion, KeyframeMotion or VertexSequence, got {motion!r}")
    group.attrs["kind"] = "vertices" if isinstance(motion, ep.VertexSequence) else "keyframes"
    group.attrs["interpolation"] = motion.interpolation
    write_array(group, "times", motion.times, unit="s")
    if isinstance(motion, ep.VertexSequence):
        write_array(group, "vertices", motion.vertices, unit="m")
    else:
        write_array(group, "translations", motion.translations, unit="m")
        write_array(group, "rotations", motion.rotations)


def read_motion(group):
    """The motion of a group."""
    kind = read_attribute(group, "kind", str)
    if kind == "linear":
        return ep.LinearMotion(velocity=read_array(group, "velocity", np.float64, (3,)),
                               angular_velocity=read_array(group, "angular_velocity", np.float64, (3,)))
    times = read_array(group, "times", np.float64, (None,))
    interpolation = read_attribute(group, "interpolation", str)
    if kind == "vertices":
        vertices = read_array(group, "vertices", np.float64, (len(times), None, 3))
        return ep.VertexSequence(times=times, vertices=vertices, interpolation=interpolation)
    if kind == "keyframes":
        return ep.KeyframeMotion(times=times, translations=_filled(group, "translations", (None, 3)),
                                 rotations=_filled(group, "rotations", (None, 4)), interpolation=interpolation)
    raise ep.FileError(f"{group.name}: unknown kind of motion '{kind}'")


def _filled(group, name: str, shape: tuple):
    values = read_array(group, name, np.float64, shape)
    return values if len(values) else None


# What nodes share: name of the node's field -> (group, how to write one, how to read one).
_SHARED = {"mesh": ("meshes", _write_mesh, _read_mesh), "material": ("materials", _write_material, _read_material),
           "motion": ("motions", write_motion, read_motion), "sequence": ("sequences", write_motion, read_motion)}
