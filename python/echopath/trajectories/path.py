"""Paths: curves in space that are known by the distance along them.

A path is p(u) over a parameter u, with `knots` between which it is smooth. Its length is the integral of |p'|, by Gauss and
Legendre's rule on short pieces, and u is found from a distance by Newton steps. Beyond its ends a path goes straight on.
"""
from __future__ import annotations

import numpy as np

PIECES = 4             # of each interval between knots, for the integral of the length
NEWTON_STEPS = 5       # after which a distance is met to rounding, from a start that is right to a few per cent
NODES, WEIGHTS = np.polynomial.legendre.leggauss(8)


class Path:
    """A curve p(u) with its length, both in m."""

    def __init__(self, knots):
        self.knots = np.asarray(knots, float)
        parts = np.linspace(0.0, 1.0, PIECES, endpoint=False)
        self._u = np.append((self.knots[:-1, None] + np.diff(self.knots)[:, None] * parts).ravel(), self.knots[-1])
        self._s = np.concatenate([[0.0], np.cumsum(self._integral(self._u[:-1], self._u[1:]))])
        self.length = float(self._s[-1])
        bearing = self._bearing(self.slopes_at(self._u))
        self._turned = np.unwrap(bearing)
        self.junctions = self.distances(self.knots)

    def jets(self, u):
        """p, p' and p'' by u, each [N, 3], at parameters [N] within the knots."""
        raise NotImplementedError

    def slopes_at(self, u):
        """p' [N, 3] alone."""
        return self.jets(u)[1]

    def distances(self, u):
        """Distances [N] in m of parameters [N]."""
        k = np.clip(np.searchsorted(self._u, u, side="right") - 1, 0, len(self._u) - 2)
        return self._s[k] + self._integral(self._u[k], np.asarray(u, float))

    def at(self, distances):
        """(points [N, 3] in m, unit tangents [N, 3], curvature vectors [N, 3] in 1/m) at distances [N] in m."""
        inside = np.clip(distances, 0.0, self.length)
        point, first, second = self.jets(self._parameters(inside))
        squared = np.sum(first**2, axis=-1, keepdims=True)
        tangent = first / np.sqrt(squared)
        bend = (second - np.sum(second * tangent, axis=-1, keepdims=True) * tangent) / squared
        beyond = (np.asarray(distances, float) - inside)[:, None]
        return point + beyond * tangent, tangent, np.where(beyond == 0.0, bend, 0.0)

    def points(self, distances):
        """Points [N, 3] in m at distances [N] in m."""
        return self.at(distances)[0]

    def bearings(self, distances):
        """(direction in the plane in rad from +x to the left, without jumps; its change in rad/m), each [N]."""
        _, tangent, bend = self.at(distances)
        bearing = self._bearing(tangent)
        nearby = np.interp(distances, self._s, self._turned)
        return bearing + 2.0 * np.pi * np.round((nearby - bearing) / (2.0 * np.pi)), turn_of(tangent, bend)

    def slopes(self, distances):
        """(angle above the plane in rad, its change in rad/m), each [N]."""
        _, tangent, bend = self.at(distances)
        level = np.hypot(tangent[:, 0], tangent[:, 1])
        return np.arctan2(tangent[:, 2], level), bend[:, 2] / level

    def _parameters(self, distances):
        """Parameters [N] at distances [N] within the path."""
        k = np.clip(np.searchsorted(self._s, distances, side="right") - 1, 0, len(self._s) - 2)
        low, high = self._u[k], self._u[k + 1]
        wanted = distances - self._s[k]
        u = low + (high - low) * wanted / (self._s[k + 1] - self._s[k])
        for _ in range(NEWTON_STEPS):
            step = (self._integral(low, u) - wanted) / np.linalg.norm(self.slopes_at(u), axis=-1)
            u = np.clip(u - step, low, high)
            if np.abs(step).max(initial=0.0) < 1e-14 * self._u[-1]:
                break
        return u

    def _integral(self, begin, end):
        """Lengths [N] in m from parameters `begin` to `end` [N], which lie in one piece each."""
        half = 0.5 * (end - begin)
        u = begin[:, None] + half[:, None] * (1.0 + NODES)
        speeds = np.linalg.norm(self.slopes_at(u.ravel()), axis=-1).reshape(u.shape)
        return half * (speeds @ WEIGHTS)

    @staticmethod
    def _bearing(tangent):
        return np.arctan2(tangent[:, 1], tangent[:, 0])


def turn_of(tangent, bend):
    """Change [N] in rad/m of the direction in the plane, of tangents [N, 3] and curvature vectors [N, 3] in 1/m."""
    level = tangent[:, 0] ** 2 + tangent[:, 1] ** 2
    return (tangent[:, 0] * bend[:, 1] - tangent[:, 1] * bend[:, 0]) / level


class SplinePath(Path):
    """A C2 cubic spline over the chord lengths through points [P, 3], not-a-knot at its ends."""

    def __init__(self, points):
        points = np.asarray(points, float)
        knots = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=-1))])
        self._values, self._bends = points, second_derivatives(knots, points)
        self.knots = knots
        super().__init__(knots)

    def jets(self, u):
        k = np.clip(np.searchsorted(self.knots, u, side="right") - 1, 0, len(self.knots) - 2)
        h = (self.knots[k + 1] - self.knots[k])[:, None]
        b = (u - self.knots[k])[:, None] / h
        a = 1.0 - b
        y0, y1, m0, m1 = self._values[k], self._values[k + 1], self._bends[k], self._bends[k + 1]
        point = a * y0 + b * y1 + ((a**3 - a) * m0 + (b**3 - b) * m1) * h**2 / 6.0
        first = (y1 - y0) / h + ((3.0 * b**2 - 1.0) * m1 - (3.0 * a**2 - 1.0) * m0) * h / 6.0
        return point, first, a * m0 + b * m1


class ArcPath(Path):
    """Straight lines and arcs, which follow each other without a kink; u is the distance."""

    def __init__(self, starts, directions, normals, curvatures, lengths):
        self._starts, self._directions, self._normals = starts, directions, normals
        self._curvatures = curvatures
        self.knots = np.concatenate([[0.0], np.cumsum(lengths)])
        super().__init__(self.knots)

    def jets(self, u):
        k = np.clip(np.searchsorted(self.knots, u, side="right") - 1, 0, len(self.knots) - 2)
        along, kappa = (u - self.knots[k])[:, None], self._curvatures[k][:, None]
        direction, normal = self._directions[k], self._normals[k]
        angle = kappa * along
        chord = along * np.sinc(angle / np.pi)
        sagitta = 0.5 * kappa * along**2 * np.sinc(0.5 * angle / np.pi) ** 2
        first = direction * np.cos(angle) + normal * np.sin(angle)
        second = kappa * (normal * np.cos(angle) - direction * np.sin(angle))
        return self._starts[k] + direction * chord + normal * sagitta, first, second

    def _parameters(self, distances):
        return distances


def second_derivatives(knots, values):
    """Those [P, C] of the C2 spline, not-a-knot at its ends, through values [P, C]; two points: a line, three: a parabola."""
    count = len(knots)
    h = np.diff(knots)
    slopes = np.diff(values, axis=0) / h[:, None]
    bends = np.zeros(values.shape)
    if count < 3:
        return bends
    jumps = 6.0 * np.diff(slopes, axis=0)
    if count == 3:
        bends[:] = jumps[0] / (3.0 * (h[0] + h[1]))
        return bends
    below, middle, above = h[:-1].copy(), 2.0 * (h[:-1] + h[1:]), h[1:].copy()
    middle[0] += h[0] + h[0] ** 2 / h[1]       # the first bend is that of the line through the next two
    above[0] -= h[0] ** 2 / h[1]
    middle[-1] += h[-1] + h[-1] ** 2 / h[-2]
    below[-1] -= h[-1] ** 2 / h[-2]
    bends[1:-1] = _tridiagonal(below, middle, above, jumps)
    bends[0] = bends[1] - h[0] / h[1] * (bends[2] - bends[1])
    bends[-1] = bends[-2] + h[-1] / h[-2] * (bends[-2] - bends[-3])
    return bends


def _tridiagonal(below, middle, above, right):
    """The solution [N, C] of a tridiagonal system, by elimination."""
    middle, right = middle.copy(), right.copy()
    for k in range(1, len(middle)):
        factor = below[k] / middle[k - 1]
        middle[k] -= factor * above[k - 1]
        right[k] -= factor * right[k - 1]
    right[-1] /= middle[-1]
    for k in range(len(middle) - 2, -1, -1):
        right[k] = (right[k] - above[k] * right[k + 1]) / middle[k]
    return right


def turned_path(points, radius: float):
    """Straight lines between points [P, 3] whose corners are rounded by arcs of a radius in m: an ArcPath.

    Raises ValueError for an arc that does not fit between the points.
    """
    steps = np.diff(points, axis=0)
    lengths = np.linalg.norm(steps, axis=-1)
    directions = steps / lengths[:, None]
    cosines = np.sum(directions[:-1] * directions[1:], axis=-1)
    turns = np.arccos(np.clip(cosines, -1.0, 1.0))
    cut = np.concatenate([[0.0], radius * np.tan(0.5 * turns), [0.0]])     # of the lines, at each point
    left = lengths - cut[:-1] - cut[1:]
    if np.any(left < -1e-9 * lengths):
        k = int(np.argmin(left / lengths))
        largest = radius * lengths[k] / (cut[k] + cut[k + 1])
        raise ValueError(f"turn_radius: must fit between points[{k}] and points[{k + 1}], where {largest:.6g} m is the largest, "
                         f"got {radius:g}")
    rows = []
    for k, direction in enumerate(directions):
        rows.append((points[k] + cut[k] * direction, direction, np.zeros(3), 0.0, max(left[k], 0.0)))
        if k < len(turns) and turns[k] > 1e-12:
            across = directions[k + 1] - cosines[k] * direction
            rows.append((points[k + 1] - cut[k + 1] * direction, direction, across / np.linalg.norm(across), 1.0 / radius,
                         radius * turns[k]))
    kept = [row for row in rows if row[4] > 0.0]
    return ArcPath(*(np.array([row[column] for row in kept]) for column in range(5)))
