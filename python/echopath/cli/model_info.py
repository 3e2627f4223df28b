"""What `echopath info` says of a foreign file."""
from __future__ import annotations

from collections import Counter
from pathlib import Path

import numpy as np

import echopath as ep

from ..base.text.counts import counted
from ..readers.sizes import has_skin, names_of, unit_doubt
from ..scene.boxes import box_of
from . import report
from .lists import more_line

MAX_MATERIALS = 60  # named one by one

COMPACT = 0.1  # least side over the greatest, of a body rather than of a terrain or a town


def describe_model(path: Path, model: ep.Model, *, with_overlaps: bool = True) -> list[str]:
    """Lines on the content, size, axes, unit, materials and animations of a model, what lies on each other in it, and what its
    reader noted."""
    scene = ep.Scene()
    scene.add(model, name="model")
    low, high = box_of(scene)
    size = high - low
    meshes = [node for node in model.nodes if node.mesh is not None]
    lines = [f"{path.resolve().name}: {model.format}", report.line("meshes, nodes", f"{len(meshes):,}, {len(model.nodes):,}"),
             report.line("triangles", f"{model.num_triangles:,}"),
             report.line("size", f"{size[0]:.4g} x {size[1]:.4g} x {size[2]:.4g} m (forward, left, up)"),
             report.line("from, to", f"{report.point(low)}, {report.point(high)} m"),
             report.line("axes", f"{model.up} is up in the file; x ahead, y left, z up here"),
             report.line("unit", f"{model.unit:g} m")]
    is_body = len(meshes) == 1 and size.min() > COMPACT * size.max()
    doubt = unit_doubt(float(size.max()), model.unit, names_of(model, path.stem), has_skin(model), is_body)
    lines += [report.line("unit?", doubt)] if doubt else []
    overlaps = _overlaps(scene) if with_overlaps else []
    return lines + (_tree(model) + _materials(meshes) + overlaps if meshes else []) + _animations(model) + _notes(model)


def _overlaps(scene: ep.Scene) -> list[str]:
    names = [mesh.name.removeprefix("model/") for mesh in scene.meshes]
    return report.overlaps_or_none(scene, 0.0, names)


def _tree(model: ep.Model) -> list[str]:
    """The upper part of the tree, as far as the lines go, each node with the triangles below it."""
    triangles = np.array([0 if node.mesh is None else len(node.mesh.triangles) for node in model.nodes])
    depth = np.zeros(len(model.nodes), int)
    for index in range(len(model.nodes) - 1, -1, -1):
        if model.nodes[index].parent >= 0:
            triangles[model.nodes[index].parent] += triangles[index]
    for index, node in enumerate(model.nodes):
        depth[index] = 0 if node.parent < 0 else depth[node.parent] + 1
    deepest = max((level for level in range(depth.max(initial=0) + 1) if (depth <= level).sum() <= report.MAX_LISTED), default=0)
    listed = [index for index in _in_order(model) if depth[index] <= deepest][:report.MAX_LISTED]
    lines = [report.line("  " * (1 + int(depth[i])) + model.nodes[i].name,
                         counted(triangles[i], "triangle") + _words(model.nodes[i])) for i in listed]
    return ["tree", *lines, *more_line(len(model.nodes), len(listed), "node")]


def _in_order(model: ep.Model) -> list[int]:
    """Indices of the nodes, each followed by what is below it."""
    children: dict[int, list[int]] = {}
    for index, node in enumerate(model.nodes):
        children.setdefault(node.parent, []).append(index)
    order, waiting = [], children.get(-1, [])[::-1]
    while waiting:
        order.append(waiting.pop())
        waiting += children.get(order[-1], [])[::-1]
    return order


def _words(node) -> str:
    words = [f", {node.foreign_material}"] if node.foreign_material else []
    words += [", moving"] if node.motion is not None else []
    words += [f", {type(node.deformation).__name__}"] if node.deformation is not None else []
    return "".join(words)


def _materials(meshes) -> list[str]:
    """Foreign names with what they are taken for, those of most meshes first."""
    pairs = Counter((node.foreign_material or "(none)", _meaning(node.material)) for node in meshes)
    lines = [report.line(f"  {name}", f"{meaning}, {counted(count, 'mesh')}")
             for (name, meaning), count in pairs.most_common(MAX_MATERIALS)]
    return ["materials, and what they are taken for", *lines, *more_line(len(pairs), MAX_MATERIALS)]


def _meaning(material) -> str:
    return material if isinstance(material, str) else ep.materials.name_of(material) or repr(material)


def _animations(model: ep.Model) -> list[str]:
    if not model.animations:
        return []
    lines = [report.line(f"  {name}", f"{model.duration:.4g} s" if name == model.animation else "not read")
             for name in model.animations]
    return ["animations", *lines]


def _notes(model: ep.Model) -> list[str]:
    return (["notes"] + [f"  {note}" for note in model.notes]) if model.notes else []
