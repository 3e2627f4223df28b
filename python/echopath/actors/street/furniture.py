"""Poles, traffic signs and guard rails."""
from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from ... import _core
from ...arguments.checks import checked, one_of, optional, real, refused
from ...trajectories.arguments import checked_path, checked_points
from ...trajectories.path import Path
from ..actor import Actor, Part
from ..limits import LONGEST_ROW, row_rule, size_rule
from ..solids import extruded, outward, round_segments, tube
from ..surfaces import joined

SignShape = Literal["round", "triangle", "rectangle", "octagon"]

SIGN_THICKNESS = 0.003     # m, of aluminium sheet
SIGN_POLE_RADIUS = 0.038   # m: tubes of 76 mm
SIGN_GAP = 0.03            # m between sign and tube
# Corners of the shapes and the turn of the first one about the sign's axis, in rad from the top.
SIGN_CORNERS = {"round": (32, 0.0), "triangle": (3, 0.0), "octagon": (8, np.pi / 8)}

POLE_END_RADIUS = 0.04     # m, where no other is asked for
SUNK = 0.05                # m by which feet reach into the ground, so that they lie not on it
RAIL_HEIGHT, RAIL_DEPTH, RAIL_THICKNESS = 0.311, 0.081, 0.003   # m: the W profile of steel guard rails (EN 1317 systems)
RAIL_TOP = 0.75            # m above the ground
POST = (0.055, 0.10)       # m, along and across: beams IPE 100, whose flanges lie along the road
FLANGE, WEB = 0.0057, 0.0041   # m, thicknesses
POST_FRONT = RAIL_DEPTH + RAIL_THICKNESS + 0.002   # m behind the front of the rail
LENGTH = 20.0              # m, of a rail, where no other is asked for
BENDS = 1000               # places of a line at which it is asked how much it bends
SMALLEST_RADIUS = 0.5      # m, of a bent rail: its posts reach 0.2 m behind it
STRAY = 1e-3               # m, by which the sides of triangles leave a bent line
# The W profile from its lower to its upper edge: height over that of the rail, depth behind the front over the whole depth.
RAIL_LINE = ((0.0, 0.86), (0.05, 0.80), (0.12, 0.30), (0.19, 0.02), (0.25, 0.0), (0.31, 0.06), (0.40, 0.78), (0.45, 0.97),
             (0.50, 1.0), (0.55, 0.97), (0.60, 0.78), (0.69, 0.06), (0.75, 0.0), (0.81, 0.02), (0.88, 0.30), (0.95, 0.80),
             (1.0, 0.86))


@checked(height=size_rule, radius=size_rule, end_radius=optional(size_rule))
def pole(*, height: float = 6.0, radius: float = 0.07, end_radius: float | None = None) -> Actor:
    """A round metal pole that tapers from `radius` at the ground to `end_radius` at `height`, all in m.

    It stands at the origin, its foot 5 cm below the ground z = 0. One part, "tube".
    end_radius: None: 0.04, or `radius` where that is less
    Raises TypeError or ValueError naming the argument.
    """
    end = min(radius, POLE_END_RADIUS) if end_radius is None else end_radius
    surface = tube((0, 0, -SUNK), (0, 0, height), radius, end, segments=round_segments(radius))
    return Actor([Part("tube", _core.Mesh(*surface), "metal", smooth=True)])


@checked(shape=one_of(SignShape), size=size_rule, height=size_rule)
def traffic_sign(*, shape: SignShape = "round", size: float = 0.6, height: float = 2.2) -> Actor:
    """A flat metal traffic sign that looks along -x, on a tube of 76 mm.

    Parts: sign, pole. The sign's front is in the plane x = 0, its middle over the origin; the tube stands behind it.
    shape: "round", "triangle" (a corner up), "rectangle" (2/3 as wide as high) or "octagon"
    size: m, diameter, side of the triangle, height of the rectangle, or width over two sides of the octagon
    height: m, of the sign's lower edge above the ground
    Raises TypeError or ValueError naming the argument.
    """
    outline = _sign_outline(shape, size)
    outline[:, 1] += height - outline[:, 1].min()
    top = outline[:, 1].max() - 0.05 * size
    x = SIGN_THICKNESS + SIGN_GAP + SIGN_POLE_RADIUS
    mast = tube((x, 0, -SUNK), (x, 0, top), SIGN_POLE_RADIUS, segments=round_segments(SIGN_POLE_RADIUS))
    return Actor([Part("sign", _core.Mesh(*_prism(outline, SIGN_THICKNESS)), "metal"),
                  Part("pole", _core.Mesh(*mast), "metal", smooth=True)])


@checked(length=optional(row_rule), spacing=real(0.1, unit="m"), edge=real(0.02, unit="m"), points=optional(checked_points))
def guard_rail(*, length: float | None = None, spacing: float = 2.0, edge: float = 1.0,
               points: ArrayLike | None = None) -> Actor:
    """A steel guard rail, 0.75 m high, on posts of H section: along x about the origin, its front towards -y, or along a line.

    Parts: rail (the W profile of 311 mm x 81 mm, 3 mm thick), posts.
    length: m, of a straight rail; None: 20
    spacing: m, of the posts. edge: m, longest side of the rail's triangles along it, less where it is bent
    points: [P, 2] or [P, 3] in m, on the ground: the rail goes along the C2 spline through them, its front to their right
    Raises TypeError or ValueError naming the argument.
    """
    if points is None:
        length = LENGTH if length is None else length
        places = _post_places(length, spacing) - length / 2
        posts = [_post(x, POST_FRONT, RAIL_TOP - 0.03) for x in places]
        rail = _rail(length, np.linspace(0.0, 1.0, int(np.ceil(length / edge)) + 1))
    elif length is not None:
        raise ValueError(f"length: cannot be given beside points, which say how long the rail is, got {length:g}")
    else:
        rail, posts = _along(_checked_line(points), spacing, edge)
    return Actor([Part("rail", _core.Mesh(*rail), "metal", smooth=True), Part("posts", _core.Mesh(*joined(*posts)), "metal")])


def _post_places(length, spacing):
    """Distances [N] in m of the posts from the beginning of a rail."""
    return np.linspace(POST[0], length - POST[0], max(2, int(round(length / spacing)) + 1))


def _checked_line(points) -> Path:
    line = checked_path(checked_points("points", points), None)
    bend = np.linalg.norm(line.at(line.fine_places(BENDS))[2], axis=1).max()
    if not line.length <= LONGEST_ROW or bend * SMALLEST_RADIUS > 1.0:
        raise refused(ValueError, "points", f"those of a line of at most {LONGEST_ROW:g} m that nowhere bends with a radius "
                      f"below {SMALLEST_RADIUS:g} m", points)
    return line


def _along(line: Path, spacing, edge):
    """(rail, [post, ...]), surfaces along a line."""
    posts = [_bent(line, _post(0.0, POST_FRONT, RAIL_TOP - 0.03), at) for at in _post_places(line.length, spacing)]
    return _bent(line, _rail(line.length, _cuts_along(line, edge))), posts


def _cuts_along(line: Path, edge):
    """Shares [N + 1] of a line, from 0 to 1, between which sides stray little from it and are no longer than `edge` m."""
    places = np.unique(np.concatenate([line.fine_places(BENDS), np.linspace(0.0, line.length, BENDS)]))
    bend = np.linalg.norm(line.at(places)[2], axis=1)
    sides = np.minimum(edge, np.sqrt(8.0 * STRAY / np.maximum(bend, np.finfo(float).tiny)))
    steps = np.diff(places) / np.minimum(sides[:-1], sides[1:])
    count = np.concatenate([[0.0], np.cumsum(steps)])
    return np.interp(np.linspace(0.0, count[-1], int(np.ceil(count[-1])) + 1), count, places) / line.length


def _bent(line: Path, surface, at=None):
    """A surface along x, whose middle is at the origin, bent along a line, or turned to where the line is `at` so many m."""
    vertices, triangles = surface
    along = vertices[:, 0] + 0.5 * line.length if at is None else np.full(len(vertices), at)
    place, tangent, _ = line.at(along)
    level = tangent[:, :2] / np.linalg.norm(tangent[:, :2], axis=1, keepdims=True)
    left = np.column_stack([-level[:, 1], level[:, 0]])
    place[:, :2] += vertices[:, 1:2] * left
    if at is not None:
        place[:, :2] += vertices[:, :1] * level
    place[:, 2] += vertices[:, 2]
    return place, triangles


def _post(x, y, height):
    """A beam of H section from the ground to `height`, its nearer flange at y."""
    half, web = POST[0] / 2, WEB / 2
    low, high = FLANGE, POST[1] - FLANGE
    outline = np.array([(-half, 0), (half, 0), (half, low), (web, low), (web, high), (half, high), (half, POST[1]),
                        (-half, POST[1]), (-half, high), (-web, high), (-web, low), (-half, low)])
    vertices = np.concatenate([np.column_stack([outline + [x, y], np.full(12, z)]) for z in (-SUNK, height)])
    k = np.arange(12)
    n = (k + 1) % 12
    cap = np.array([(0, 1, 3), (1, 2, 3), (0, 3, 10), (0, 10, 11), (10, 3, 4), (10, 4, 9), (9, 4, 7), (4, 6, 7), (4, 5, 6),
                    (9, 7, 8)])
    sides = np.concatenate([np.stack([k, n, n + 12], -1), np.stack([k, n + 12, k + 12], -1)])
    return outward((vertices, np.concatenate([sides, cap[:, ::-1], cap + 12])))


def _rail(length, cuts):
    """Pieces of the rail one behind the other, without walls between them; cuts: shares [N + 1] of the length, from 0 to 1."""
    line = np.array(RAIL_LINE)
    dense = np.interp(np.linspace(0, 1, 49), np.linspace(0, 1, len(line)), np.arange(len(line)))
    z = np.interp(dense, np.arange(len(line)), line[:, 0])
    depth = _smoothed(np.interp(dense, np.arange(len(line)), line[:, 1]))
    front = np.column_stack([RAIL_DEPTH * depth, RAIL_TOP - RAIL_HEIGHT * (1.0 - z)])
    slope = np.gradient(front, axis=0)
    normal = np.column_stack([slope[:, 1], -slope[:, 0]]) / np.linalg.norm(slope, axis=1)[:, None]
    outline = np.concatenate([front, (front + RAIL_THICKNESS * normal)[::-1]])
    vertices, triangles = extruded(outline, length)
    return _cut_along_x(vertices, triangles, len(outline), cuts)


def _smoothed(values):
    """Rounds the bends of a line by two means over three neighbours; its ends stay."""
    for _ in range(2):
        values = np.concatenate([values[:1], 0.25 * values[:-2] + 0.5 * values[1:-1] + 0.25 * values[2:], values[-1:]])
    return values


def _cut_along_x(vertices, triangles, count, cuts):
    """The extruded surface with its long sides cut at shares [N + 1] of them; its first 2 `count` triangles are those sides."""
    first, last, pieces = vertices[:count], vertices[count:], len(cuts) - 1
    rings = np.concatenate([first + (last - first) * share for share in cuts])
    sides, caps = triangles[:2 * count], triangles[2 * count:]
    along = np.concatenate([sides + step * count for step in range(pieces)])
    return rings, np.concatenate([along, np.where(caps >= count, caps + (pieces - 1) * count, caps)])


def _sign_outline(shape, size):
    """Corners [N, 2] of (y, z) about the middle."""
    if shape == "rectangle":
        return 0.5 * size * np.array([[2 / 3, 1], [-2 / 3, 1], [-2 / 3, -1], [2 / 3, -1]])
    count, turn = SIGN_CORNERS[shape]
    radius = {"round": size / 2, "triangle": size / np.sqrt(3.0), "octagon": size / (2.0 * np.cos(np.pi / 8))}[shape]
    angle = turn + 2.0 * np.pi * np.arange(count) / count
    return radius * np.column_stack([-np.sin(angle), np.cos(angle)])


def _prism(outline, thickness):
    """A plate [0, thickness] along x of a convex outline [N, 2] of (y, z)."""
    count = len(outline)
    vertices = np.concatenate([np.column_stack([np.full(count, x), outline]) for x in (0.0, thickness)])
    k = np.arange(count)
    n = (k + 1) % count
    fan = np.stack([np.zeros(count - 2, int), k[1:-1], k[2:]], -1)
    triangles = np.concatenate([fan, fan[:, ::-1] + count, np.stack([k, count + k, n], -1),
                                np.stack([n, count + k, count + n], -1)])
    return outward((vertices, triangles))
