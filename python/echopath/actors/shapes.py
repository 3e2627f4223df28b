"""Simple bodies, one mesh each. Lengths in m; `edge`: longest side of the triangles' grid, None for as few as possible.

Targets (plate, dihedral, trihedral) look along -x: placed at (x, 0, 0) they face a radar at the origin.
"""
from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .. import _core
from ..arguments.checks import array, checked, count, optional, real, refused
from . import surfaces

ROUND_PIECES = 12   # default pieces of an icosahedron edge of a sphere, and of a quarter turn of other round bodies
FACE_EDGE = 1.33    # longest edge, in radii, of an icosahedron face once it is pushed out to the sphere
MOST_SUBDIVISIONS = 500  # 5 million triangles
SHORTEST, LONGEST = 1e-9, 1e9  # m, of bodies whose coordinates double precision holds

_LENGTH = real(SHORTEST, LONGEST, unit="m")
_EDGE = optional(_LENGTH)


def _lengths(number: int):
    """The rule of so many lengths in m, or one for all of them."""
    of_numbers = array("[]", f"[{number}]")

    def check(argument: str, value) -> list[float]:
        return [_LENGTH(argument, item) for item in np.broadcast_to(of_numbers(argument, value), number).tolist()]

    return check


@checked(width=_LENGTH, height=_LENGTH, edge=_EDGE)
def plate(width: float, height: float, *, edge: float | None = None) -> _core.Mesh:
    """Flat rectangle about the origin in the plane x = 0, `width` along y and `height` along z in m, front towards -x.

    edge: longest side in m of the grid of triangles, None for as few as possible.
    Raises TypeError or ValueError naming the argument.
    """
    edge = surfaces.edge_length(edge, max(width, height))
    return _mesh(surfaces.parallelogram([0, width / 2, -height / 2], [0, -width, 0], [0, 0, height], edge))


@checked(size=_LENGTH, height=optional(_LENGTH), edge=_EDGE)
def dihedral(size: float, height: float | None = None, *, edge: float | None = None) -> _core.Mesh:
    """Two rectangles at a right angle that open towards -x.

    They meet on the z axis; each is `size` wide and `height` high in m (default: square), z from -height/2 to height/2.
    Peak radar cross section 8 pi (size height / wavelength)^2 towards -x. `edge` is as in `plate`.
    Raises TypeError or ValueError naming the argument.
    """
    height = size if height is None else height
    edge = surfaces.edge_length(edge, max(size, height))
    side, up = size / np.sqrt(2.0), np.array([0.0, 0.0, height])
    left, right = np.array([-side, side, 0.0]), np.array([-side, -side, 0.0])
    return _mesh(surfaces.joined(surfaces.parallelogram(-up / 2, up, left, edge),
                                 surfaces.parallelogram(-up / 2, right, up, edge)))


@checked(size=_LENGTH, edge=_EDGE)
def trihedral(size: float, *, edge: float | None = None) -> _core.Mesh:
    """Corner reflector of three right-angled triangles, apex at the origin, that opens towards -x.

    `size` in m is the length of the three edges at the apex, one of which lies in the plane y = 0 and rises. Peak radar
    cross section 4 pi size^4 / (3 wavelength^2) towards -x. `edge` is as in `plate`.
    Raises TypeError or ValueError naming the argument.
    """
    pieces = surfaces.num_pieces(np.sqrt(2.0) * size, surfaces.edge_length(edge, size, 6.0))
    turn = np.radians([0.0, 120.0, 240.0])
    across = np.sqrt(2.0 / 3.0)
    tips = size * np.column_stack([np.full(3, -1.0 / np.sqrt(3.0)), across * np.sin(turn), across * np.cos(turn)])
    apex = np.zeros(3)
    faces = [surfaces.triangle(apex, *_facing(tips[k], tips[(k + 1) % 3]), pieces) for k in range(3)]
    return _mesh(surfaces.joined(*faces))


@checked(size=_lengths(3), edge=_EDGE)
def box(size: float | Sequence[float], *, edge: float | None = None) -> _core.Mesh:
    """Closed box about the origin; `size` is one length in m or three (x, y, z), `edge` as in `plate`.

    Raises TypeError or ValueError naming the argument.
    """
    x, y, z = size
    edge = surfaces.edge_length(edge, max(x, y, z), 12.0)
    low = -np.array([x, y, z]) / 2.0
    axes = np.diag([x, y, z])
    sides = []
    for k in range(3):
        u, v, w = axes[(k + 1) % 3], axes[(k + 2) % 3], axes[k]
        sides += [surfaces.parallelogram(low, v, u, edge), surfaces.parallelogram(low + w, u, v, edge)]
    return _mesh(surfaces.joined(*sides))


@checked(size=_lengths(2), z=real(-LONGEST, LONGEST, unit="m"), edge=_EDGE)
def ground(size: float | Sequence[float], *, z: float = 0.0, edge: float | None = None) -> _core.Mesh:
    """Horizontal rectangle about the z axis at the height `z`, front up.

    `size` is one length in m or two (x, y), `edge` as in `plate`.
    Raises TypeError or ValueError naming the argument.
    """
    x, y = size
    edge = surfaces.edge_length(edge, max(x, y))
    return _mesh(surfaces.parallelogram([-x / 2, -y / 2, z], [x, 0, 0], [0, y, 0], edge))


@checked(length=_LENGTH, height=_LENGTH, edge=_EDGE)
def wall(length: float, height: float, *, edge: float | None = None) -> _core.Mesh:
    """Vertical rectangle in the plane y = 0, x from -length/2 to length/2, z from 0 to height, front towards -y.

    So it stands on the left of a street along x; yaw = pi turns it for the right side. Lengths in m, `edge` as in `plate`.
    Raises TypeError or ValueError naming the argument.
    """
    edge = surfaces.edge_length(edge, max(length, height))
    return _mesh(surfaces.parallelogram([-length / 2, 0, 0], [length, 0, 0], [0, 0, height], edge))


@checked(radius=_LENGTH, edge=_EDGE, subdivisions=optional(count(1, MOST_SUBDIVISIONS)))
def sphere(radius: float, *, edge: float | None = None, subdivisions: int | None = None) -> _core.Mesh:
    """Sphere of that `radius` in m about the origin with its vertices on the surface.

    Give `edge`, or `subdivisions`, the number of pieces of an icosahedron's edge (20 subdivisions^2 triangles);
    default 12.
    Raises TypeError or ValueError naming the argument.
    """
    if edge is not None and subdivisions is not None:
        raise ValueError(f"edge and subdivisions: must not be given together, got {edge!r} and {subdivisions!r}")
    if edge is not None:
        subdivisions = surfaces.num_pieces(FACE_EDGE * radius, surfaces.edge_length(edge, 2.5 * radius))
    pieces = ROUND_PIECES if subdivisions is None else subdivisions
    return _mesh(surfaces.icosphere(radius, pieces))


@checked(semi_axes=_lengths(3), edge=_EDGE)
def ellipsoid(semi_axes: float | Sequence[float], *, edge: float | None = None) -> _core.Mesh:
    """Ellipsoid about the origin; `semi_axes` (x, y, z) in m, `edge` as in `plate`.

    Raises TypeError or ValueError naming the argument.
    """
    a, b, c = semi_axes
    section = surfaces.table_section([(-c, 0, 0, a, b, 2), (c, 0, 0, a, b, 2)], c, c)
    return _round_body("semi_axes", semi_axes, section, c, edge, min(a, b), max(a, b, c))


@checked(radius=_LENGTH, length=_LENGTH, edge=_EDGE)
def capsule(radius: float, length: float, *, edge: float | None = None) -> _core.Mesh:
    """Cylinder of `radius` along z with half spheres on its ends, `length` from tip to tip, about the origin.

    Lengths in m, `edge` as in `plate`.
    Raises TypeError or ValueError naming the argument.
    """
    if length < 2.0 * radius:
        raise ValueError(f"length: must be at least twice the radius {radius!r} m, got {length!r}")
    section = surfaces.table_section([(-length / 2, 0, 0, radius, radius, 2), (length / 2, 0, 0, radius, radius, 2)],
                                     radius, radius)
    return _round_body("length", length, section, 0.5 * length, edge, radius, length)


def _mesh(surface):
    return _core.Mesh(*surface)


def _facing(a, b):
    """The two tips of a corner's face in the order that its front shows into the corner, towards -x."""
    return (a, b) if np.cross(a, b)[0] < 0 else (b, a)


def _round_body(argument, value, section, half_length, edge, radius, size) -> _core.Mesh:
    """The mesh of a body that is swept along z (`surfaces.swept`), from -half_length to half_length m.

    argument, value: what to refuse where the body is too large for triangles as small as its smallest radius asks for
    edge, radius, size: m, as the user gave it, the smallest radius, the largest width
    """
    chosen = radius * np.pi / (2 * ROUND_PIECES) if edge is None else min(surfaces.edge_length(edge, 3.0 * size), radius)
    if surfaces.num_swept_triangles(section, -half_length, half_length, chosen) > surfaces.MAX_TRIANGLES:
        if edge == chosen:
            raise surfaces.too_short(edge)
        raise refused(ValueError, argument, f"small enough beside the smallest radius, {radius!r} m, for less than "
                      f"{surfaces.MAX_TRIANGLES} triangles", value)
    return _mesh(surfaces.swept(section, -half_length, half_length, chosen))
