"""Paths: curves in space that are known by the distance along them.

A path is p(u) over a parameter u, with `knots` between which it is smooth. Its length is the integral of |p'|, by Gauss and
Legendre's rule on short pieces. Over the distance s of each piece, u is the quintic that has the value, u' = 1 / |p'| and u'' at
both ends; pieces are halved until it errs by less than a nanometre. Beyond its ends a path goes straight on.
"""
from __future__ import annotations

import numpy as np

PIECES = 4             # of each interval between knots, for the integral of the length, at first
MOST_HALVINGS = 24     # of a piece: those that a hairpin needs lie in it alone
FINE_PARTS = 256       # of each interval between knots, of even u: |p'| is small where a spline bends within little way
DISTANCE_TOLERANCE = 1e-9   # m, of u over the distance, and by which distances may lie beyond the end
ROUNDING = 4.0 * np.finfo(float).eps  # of the length: no piece of a path of thousands of kilometres meets that tolerance
LONG_END = 4.0              # times the chord next to it: what a longer chord at an end swings by, not-a-knot, grows with its cube
ON_THE_SPOT = 1e-5     # m, of way, in less of which a path that looks the other way turns back
TURNS_BACK = -1.0 + 1e-12   # cosine of the turn, from which on no arc leads from one line to the next
NEWTON_STEPS = 5       # after which a distance is met to rounding, where the most pieces do not meet the tolerance
SLOWEST = 1e-30        # |p'|, which vanishes where a path turns back on itself
NODES, WEIGHTS = np.polynomial.legendre.leggauss(8)


class Path:
    """A curve p(u) with its length, both in m."""

    def __init__(self, knots):
        self.knots = np.asarray(knots, float)
        self._divide()
        self.length = float(self._s[-1])
        self._turned = np.unwrap(self._bearing(self.slopes_at(self._u)))
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

    def fine_places(self, most: int):
        """Distances [N] in m, about `most` of them at the most, which lie close where the path bends within little way."""
        parts = np.linspace(0.0, 1.0, int(np.clip(most / len(self.knots), 1, FINE_PARTS)), endpoint=False)
        return self.distances((self.knots[:-1, None] + np.diff(self.knots)[:, None] * parts).ravel())

    def turning_places(self):
        """Distances [N] in m at which it turns back on itself: no curve has so small a radius."""
        slopes = self.slopes_at(self._u)
        lengths = np.linalg.norm(slopes, axis=-1)
        moves = lengths > 1e-12 * lengths.max()
        tangents, distances = slopes[moves] / lengths[moves, None], self._s[moves]
        is_back = (np.sum(tangents[:-1] * tangents[1:], axis=-1) < 0.0) & (np.diff(distances) < ON_THE_SPOT)
        return 0.5 * (distances[:-1] + distances[1:])[is_back]

    def at(self, distances):
        """(points [N, 3] in m, unit tangents [N, 3], curvature vectors [N, 3] in 1/m) at distances [N] in m."""
        inside = np.minimum(np.maximum(distances, 0.0), self.length)
        point, first, second = self.jets(self._parameters(inside))
        squared = np.sum(first**2, axis=-1, keepdims=True)
        if not squared.all():  # where it turns back, as it goes on
            turns_back = squared[:, 0] == 0.0
            first[turns_back], squared[turns_back] = _unit(second[turns_back]), 1.0
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

    def _divide(self) -> None:
        """Chooses the pieces, and the quintics of u over the distance in each."""
        parts = np.linspace(0.0, 1.0, PIECES, endpoint=False)
        self._u = np.append((self.knots[:-1, None] + np.diff(self.knots)[:, None] * parts).ravel(), self.knots[-1])
        for _ in range(MOST_HALVINGS + 1):
            self._s = np.concatenate([[0.0], np.cumsum(self._integral(self._u[:-1], self._u[1:]))])
            self._quintics = self._made_quintics()
            is_off = self._errors() >= max(DISTANCE_TOLERANCE, ROUNDING * self._s[-1])
            self._is_met = not is_off.any()
            if self._is_met:
                return
            middles = 0.5 * (self._u[:-1] + self._u[1:])[is_off]
            last, self._u = self._u, np.insert(self._u, 1 + np.flatnonzero(is_off), middles)
        self._u = last

    def _made_quintics(self):
        """[K, 6] of the powers of the share of the distance within each piece."""
        inside = 1e-9 * np.diff(self._u)        # derivatives of either side of a knot differ
        ends = []
        for at in (self._u[:-1] + inside, self._u[1:] - inside):
            _, first, second = self.jets(at)
            speed = np.maximum(np.linalg.norm(first, axis=-1), SLOWEST)
            ends.append((1.0 / speed, -np.sum(first * second, axis=-1) / speed**4))
        steps, rise = np.diff(self._s), np.diff(self._u)
        (d0, b0), (d1, b1) = ((slope * steps, bend * steps**2) for slope, bend in ends)
        value, slope, bend = rise - d0 - 0.5 * b0, d1 - d0 - b0, b1 - b0
        return np.stack([self._u[:-1], d0, 0.5 * b0, 10.0 * value - 4.0 * slope + 0.5 * bend,
                         -15.0 * value + 7.0 * slope - bend, 6.0 * value - 3.0 * slope + 0.5 * bend], axis=-1)

    def _errors(self):
        """m [K], of the quintics in the middle of their pieces."""
        u = np.clip(self._quintics @ 0.5 ** np.arange(6), self._u[:-1], self._u[1:])
        return np.abs(self._integral(self._u[:-1], u) - 0.5 * np.diff(self._s))

    def _parameters(self, distances):
        """Parameters [N] at distances [N] within the path."""
        k = np.clip(np.searchsorted(self._s, distances, side="right") - 1, 0, len(self._s) - 2)
        wanted = distances - self._s[k]
        share, rows = wanted / (self._s[k + 1] - self._s[k]), self._quintics[k]
        u = rows[:, 5]
        for power in (4, 3, 2, 1, 0):
            u = u * share + rows[:, power]
        low, high = self._u[k], self._u[k + 1]
        u = np.clip(u, low, high)
        return u if self._is_met else self._polished(u, low, high, wanted)

    def _polished(self, u, low, high, wanted):
        """Parameters [N] from a start, by Newton steps until the distances [N] from `low` are as wanted."""
        for _ in range(NEWTON_STEPS):
            speed = np.maximum(np.linalg.norm(self.slopes_at(u), axis=-1), SLOWEST)
            step = (self._integral(low, u) - wanted) / speed
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


def _unit(vectors):
    """Of their directions [N, 3], +x of one that has none."""
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.where(lengths > 0.0, vectors / np.where(lengths > 0.0, lengths, 1.0), [1.0, 0.0, 0.0])


def turn_of(tangent, bend):
    """Change [N] in rad/m of the direction in the plane, of tangents [N, 3] and curvature vectors [N, 3] in 1/m."""
    level = tangent[:, 0] ** 2 + tangent[:, 1] ** 2
    return (tangent[:, 0] * bend[:, 1] - tangent[:, 1] * bend[:, 0]) / level


class SplinePath(Path):
    """A C2 cubic spline over the chord lengths through points [P, 3]; two points: a line, three: a parabola.

    Its ends are not-a-knot, which is of the fourth order. Where the last chord is much longer than the one next to it, as that
    of a track that was lost before its last row, noise of centimetres would swing it by many metres: there it has the slope of
    the parabola through the last three points.
    """

    def __init__(self, points):
        from scipy.interpolate import CubicSpline

        points = np.asarray(points, float)
        knots = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=-1))])
        backwards = np.cumsum(np.diff(knots)[::-1])
        ends = _end_of_spline(points[:3], knots[1:3]), _end_of_spline(points[::-1][:3], -backwards[:2])
        self._spline = CubicSpline(knots, points, bc_type=ends if len(points) > 3 else "not-a-knot")
        super().__init__(knots)

    def jets(self, u):
        return self._spline(u), self._spline(u, 1), self._spline(u, 2)

    def slopes_at(self, u):
        return self._spline(u, 1)


def _end_of_spline(points, away):
    """SciPy's condition at an end, from the points [3, 3] there, inwards, and how far [2] the others are from the first."""
    if len(points) < 3 or abs(away[0]) <= LONG_END * abs(away[1] - away[0]):
        return "not-a-knot"
    near, far = (points[1:] - points[0]) / away[:, None]
    return 1, near - away[0] * (far - near) / (away[1] - away[0])


class ArcPath(Path):
    """Straight lines and arcs, which follow each other without a kink; u is the distance."""

    def __init__(self, starts, directions, normals, curvatures, lengths):
        self._starts, self._directions, self._normals = starts, directions, normals
        self._curvatures = curvatures
        self.knots = np.concatenate([[0.0], np.cumsum(lengths)])
        super().__init__(self.knots)

    def jets(self, u):
        k = np.minimum(np.maximum(np.searchsorted(self.knots, u, side="right") - 1, 0), len(self.knots) - 2)
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


def turned_path(points, radius: float):
    """Straight lines between points [P, 3] whose corners are rounded by arcs of a radius in m: an ArcPath.

    Raises ValueError for an arc that does not fit between the points.
    """
    steps = np.diff(points, axis=0)
    lengths = np.linalg.norm(steps, axis=-1)
    directions = steps / lengths[:, None]
    cosines = np.sum(directions[:-1] * directions[1:], axis=-1)
    back = np.flatnonzero(cosines < TURNS_BACK)
    if len(back):
        raise ValueError(f"turn_radius: must be None where the path turns back, as it does at points[{back[0] + 1}], got "
                         f"{radius:g}")
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
