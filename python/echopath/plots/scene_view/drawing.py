"""What the views of a scene show, in world coordinates: polygons with colours, edges of mirrors, rays and places of names."""
from __future__ import annotations

import dataclasses
import itertools

import numpy as np

from ...base.text.mesh_names import object_of
from ..clip import clip_triangles, outline
from .dots import most_of_each, thinned

BODY_COLOUR = np.array([0.35, 0.38, 0.44])
LIGHT = np.array([-0.55, -0.45, 0.70])  # towards the lamp
MOST_TRIANGLES = 100_000                # of all meshes that are no mirrors: Matplotlib takes 20 us to draw each of them
CUT = 1e-6                              # m: what lies as near to the border of the picture was cut there
MARGIN, SHARE_OF_MARGIN = 0.6, 0.25      # m around the rays, and most of the longest side of what is smaller
FLOOR = 0.02                            # of the height of what is drawn: level grounds end no farther above its lowest point
WIDE_GROUND, LYING = 0.5, 0.7           # of the longest side of the picture, and mean cosine of the slope, of grounds that rise
MIDDLE = 0.1                            # of the longer side of an object, to either side of its middle: what has its name above


@dataclasses.dataclass
class Drawing:
    """What the views show: polygons [N, 3] with colours [4], those of grounds, mesh by mesh, as (height, first, last), edges
    [2, 3] that end a mirror and that the picture cuts it at, rays [S, 2, 3] by number of bounces; names, mirror_names: {object:
    (lowest, highest) corner [3] of its box in the picture}."""

    bodies: list
    body_colours: list
    grounds: list
    mirrors: list
    mirror_edges: list
    mirror_cuts: list
    segments: dict
    radar: np.ndarray
    low: np.ndarray
    high: np.ndarray
    names: dict  # from the one with the strongest echo on
    mirror_names: dict
    margin: float  # m, around what is drawn


def collect(scene, shown, time: float, names, named: list) -> Drawing:
    """names: of the objects of meshes, None of others; named: those of them that the picture may bear"""
    transmitter, receiver = np.asarray(shown.frame.transmitter), np.asarray(shown.frame.receiver)
    points = np.asarray(shown.points(time)).reshape(-1, 3)
    segments = {int(count): _segments(shown, points, count, transmitter, receiver)
                for count in np.unique(shown.num_bounces)}
    corners = np.concatenate([points, transmitter[None], receiver[None], _object_vertices(scene, time)])
    corners = np.concatenate([corners, _small_mirrors(scene, time, corners.min(axis=0), corners.max(axis=0))])
    margin = min(MARGIN, max(SHARE_OF_MARGIN * np.ptp(corners, axis=0).max(), CUT))
    low, high = corners.min(axis=0) - margin, corners.max(axis=0) + margin
    middle = 0.5 * (transmitter + receiver)
    drawing = Drawing([], [], [], [], [], [], segments, middle, low, high, _places_of(scene, names, named, time), {}, margin)
    meshes = list(enumerate(scene.meshes))
    dots = {mesh_id: thinned(_triangles(scene, mesh_id, mesh, time), low, high)
            for mesh_id, mesh in meshes if not mesh.material.mirror}
    most = most_of_each(map(len, dots.values()), MOST_TRIANGLES)
    for mesh_id, mesh in meshes:
        triangles = _triangles(scene, mesh_id, mesh, time)
        if mesh.material.mirror:
            _add_mirror(drawing, triangles, mesh)
        else:
            shown = dots.pop(mesh_id)
            _add_body(drawing, triangles, shown if len(shown) <= most else thinned(triangles, low, high, most))
    return drawing


def _triangles(scene, mesh_id: int, mesh, time: float):
    """[N, 3, 3] of a mesh in the world."""
    return np.asarray(scene.world_vertices(mesh_id, time))[np.asarray(mesh.mesh.triangles)]


def _segments(paths, points, count: int, transmitter, receiver):
    """Straight pieces [S, 2, 3] of all paths of `count` bounces, from the transmitter by the hits to the receiver."""
    offsets = paths.offsets[paths.num_bounces == count]
    corners = np.empty((len(offsets), count + 2, 3))
    corners[:, 0], corners[:, -1] = transmitter, receiver
    corners[:, 1:-1] = points[offsets[:, None] + np.arange(count)]
    return np.stack([corners[:, :-1], corners[:, 1:]], axis=2).reshape(-1, 2, 3)


def _object_vertices(scene, time: float):
    """World vertices [N, 3] of the meshes that are no mirrors: what the picture must hold, small or not."""
    vertices = [np.asarray(scene.world_vertices(mesh_id, time)) for mesh_id, mesh in enumerate(scene.meshes)
                if not mesh.material.mirror]
    return np.concatenate([np.zeros((0, 3)), *vertices])


def _small_mirrors(scene, time: float, low, high):
    """Corners [N, 3] of the boxes of mirrors that reach into the box of the rest, from low to high, and are no longer than it:
    vehicles and signs whose faces mirror are shown whole, walls and roads as far as the rest goes."""
    found = [np.zeros((0, 3))]
    for mesh_id, mesh in enumerate(scene.meshes):
        if not mesh.material.mirror:
            continue
        vertices = np.asarray(scene.world_vertices(mesh_id, time))
        ends = np.stack([vertices.min(axis=0), vertices.max(axis=0)])
        if np.ptp(ends, axis=0).max() <= (high - low).max() and (ends[0] <= high).all() and (ends[1] >= low).all():
            found.append(ends)
    return np.concatenate(found)


def _places_of(scene, names, named: list, time: float) -> dict:
    """(lowest, highest) corner [3] of the middle of each object that is named, {name: corners}. names: of the objects of meshes,
    or None"""
    objects = {name: [] for name in named}
    for mesh_id, name in enumerate(names):
        if name in objects:
            objects[name].append(np.asarray(scene.world_vertices(mesh_id, time)))
    return {name: _middle_of(np.concatenate(parts)) for name, parts in objects.items()}


def _middle_of(points) -> tuple:
    """(lowest, highest) corner [3] of the points [N, 3] of an object in the middle of its longer side: what is bent, as a rail
    along a curve, is not where its box is."""
    low, high = points.min(axis=0), points.max(axis=0)
    longer = int(np.argmax((high - low)[:2]))
    away = np.abs(points[:, longer] - 0.5 * (low + high)[longer])
    some = points[away <= max(away.min(), MIDDLE * (high - low)[longer])]
    return np.append(some[:, :2].min(axis=0), low[2]), np.append(some[:, :2].max(axis=0), high[2])


def _add_mirror(drawing: Drawing, triangles, mesh) -> None:
    polygons = clip_triangles(triangles, drawing.low, drawing.high)
    drawing.mirrors += polygons
    for edge in outline(polygons):
        (drawing.mirror_cuts if is_cut(edge, drawing.low, drawing.high) else drawing.mirror_edges).append(edge)
    if polygons:
        _add_mirror_name(drawing.mirror_names, object_of(mesh.name), np.concatenate(polygons))


def _add_body(drawing: Drawing, triangles, shown) -> None:
    """triangles: of the mesh; shown: those that are drawn in their place, each [N, 3, 3]"""
    polygons = clip_triangles(shown, drawing.low, drawing.high)
    if polygons:
        if _is_ground(drawing, triangles):
            drawing.grounds.append((triangles[..., 2].max(), len(drawing.bodies), len(drawing.bodies) + len(polygons)))
        drawing.bodies += polygons
        drawing.body_colours += _shaded(np.array([polygon[:3] for polygon in polygons]))


def _is_ground(drawing: Drawing, triangles) -> bool:
    """Whether triangles [N, 3, 3] lie at the lowest point of the picture: level ones, or those of a wide slope or hills."""
    sides, lowest = drawing.high - drawing.low, drawing.low[2] + drawing.margin
    if triangles[..., 2].max() <= lowest + FLOOR * sides[2]:
        return True
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    is_lying = np.abs(normals[:, 2]).sum() >= LYING * np.linalg.norm(normals, axis=1).sum()
    is_wide = np.ptp(triangles[..., :2], axis=(0, 1)).max() >= WIDE_GROUND * sides.max()
    return bool(is_lying and is_wide and triangles[..., 2].min() <= lowest + FLOOR * sides[2])


def _add_mirror_name(names: dict, name: str, corners) -> None:
    """Adds the name of a mirror with the box about its corners [N, 3], or widens the box."""
    low, high = names.get(name, (corners.min(axis=0), corners.max(axis=0)))
    names[name] = np.minimum(low, corners.min(axis=0)), np.maximum(high, corners.max(axis=0))


def is_cut(edge, low, high) -> bool:
    """Whether an edge [2, 3] lies on the border of the picture: there the mirror goes on."""
    return any(np.isclose(edge, border, rtol=0.0, atol=CUT).all(axis=0).any() for border in (low, high))


def _shaded(corners) -> list:
    """Colours [N, 4] of polygons under the lamp, both sides alike, from their first three corners [N, 3, 3]."""
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normal, axis=1)
    brightness = np.abs(normal @ LIGHT) / (np.where(length > 0.0, length, 1.0) * np.linalg.norm(LIGHT))
    colour = np.clip(BODY_COLOUR * (0.55 + brightness[:, None]), 0.0, 1.0)
    return list(np.column_stack([colour, np.ones(len(colour))]))


def grounds(drawing: Drawing) -> list:
    """Indices of the polygons of each ground, from the lowest on: seen from above, none hides what stands on it."""
    return [range(first, last) for _, first, last in sorted(drawing.grounds)]


def on_grounds(drawing: Drawing) -> list:
    """Indices of the polygons of all grounds."""
    return list(itertools.chain.from_iterable(grounds(drawing)))


def above_ground(drawing: Drawing) -> list:
    """Indices of the polygons of all other bodies."""
    on_ground = set(on_grounds(drawing))
    return [k for k in range(len(drawing.bodies)) if k not in on_ground]
