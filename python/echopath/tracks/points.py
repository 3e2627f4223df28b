"""What a tracker takes in: points in the plane with their covariances."""
from __future__ import annotations

import dataclasses
import math

import numpy as np

from ..arguments.checks import array, refused
from ..arguments.iterables import iterable
from ..base.radar.antennas import velocity_of_antennas
from ..base.radar.velocities import ambiguity_of
from ..detections import Detections

_POINTS = array("[D, 2]", "[D, 3]", finite=True)
_NONE = np.zeros((0, 3)), np.zeros(0), np.zeros(0), np.zeros(3), False


@dataclasses.dataclass(frozen=True)
class Points:
    """M points of a frame.

    points: [M, 2] m; covariances: [M, 2, 2] m^2
    speeds: [M] m/s, of the points along `sights` [M, 2], but for whole ambiguities; speed_std: m/s
    ambiguity: m/s, 0: the speeds are not known, infinity: they are unique
    """

    points: np.ndarray
    covariances: np.ndarray
    speeds: np.ndarray
    sights: np.ndarray
    speed_std: float = 1.0
    ambiguity: float = 0.0

    @property
    def log_of_any_speed(self) -> float:
        """Minus twice the log likelihood of a speed of which nothing is known, beside that of a Gaussian without its constant."""
        return 2.0 * math.log(self.ambiguity) - math.log(2.0 * math.pi) if 0.0 < self.ambiguity < math.inf else 0.0

    def some(self, indices) -> Points:
        """Those at [K] places."""
        return dataclasses.replace(self, points=self.points[indices], covariances=self.covariances[indices],
                                   speeds=self.speeds[indices], sights=self.sights[indices])


@dataclasses.dataclass(frozen=True)
class Carrier:
    """What carries the points of a radar into the world at a time.

    world_from_radar: [4, 4]; velocity: [3] m/s, of its antennas in the world; ambiguity: m/s, of its radial velocities, 0:
    these are not known
    """

    world_from_radar: np.ndarray
    velocity: np.ndarray
    ambiguity: float


def carrier_of(radar, time: float) -> Carrier:
    """Of a radar at a time in s."""
    return Carrier(radar.world_from_radar(time), velocity_of_antennas(radar, time), ambiguity_of(radar))


def points_of(detections, carrier: Carrier | None, range_std: float, azimuth_std: float, speed_std: float | None,
              merge_distance: float) -> Points:
    """Points of one frame, those nearer than `merge_distance` in m to each other made one, with the speed of the strongest.

    detections: Detections, or points [D, 2] or [D, 3] in m in the radar's frame; carrier: into the world, None: to leave them
        there, without speeds, as what is ambiguous and how the radar moves is not known
    range_std: m, azimuth_std: rad, speed_std: m/s, of each; speed_std None: the speeds tell nothing
    """
    own, weights, speeds, centre, has_heights = _own_points(detections)
    own, speeds = _merged(own, weights, speeds, merge_distance)
    sight = own - centre
    covariances = _covariances(sight, has_heights, range_std, azimuth_std)
    if carrier is None:
        return Points(own[:, :2], covariances[:, :2, :2], np.zeros(len(own)), np.zeros((len(own), 2)))
    turn, shift = carrier.world_from_radar[:3, :3], carrier.world_from_radar[:3, 3]
    sights = _units(sight) @ turn.T
    points, covariances = (own @ turn.T + shift)[:, :2], turn[:2] @ covariances @ turn[:2].T
    if speed_std is None or np.any(np.isnan(speeds)):
        return Points(points, covariances, np.zeros(len(own)), np.zeros((len(own), 2)))
    return Points(points, covariances, speeds + sights @ carrier.velocity, sights[:, :2], speed_std, carrier.ambiguity)


def _covariances(sight, has_heights: bool, range_std: float, azimuth_std: float):
    """[M, 3, 3] m^2, in the radar's frame, of points whose ways from the radar are `sight` [M, 3] in m: in all directions across
    these, or in azimuth alone where heights are not known."""
    along, left = _outer(_units(sight)), _outer(_units(np.cross([0.0, 0.0, 1.0], sight)))
    across = np.eye(3) - along if has_heights else left
    return range_std**2 * along + (azimuth_std * np.linalg.norm(sight, axis=1))[:, None, None] ** 2 * across


def _units(vectors):
    """Vectors [M, 3] of length 1; zeros stay."""
    return vectors / np.maximum(np.linalg.norm(vectors, axis=1), 1e-12)[:, None]


def _own_points(detections) -> tuple:
    """Points [D, 3], weights [D], radial velocities [D] in m/s, NaN where they are not known, the place [3] that they are counted
    from, in the radar's frame, and whether their heights are known."""
    if isinstance(detections, Detections):
        points, weights = detections.points, detections.power
        is_known = np.isfinite(points).all(axis=1)
        if len(points) and not is_known.any():
            raise ValueError("detections: must have azimuths, which the radar's antennas cannot tell")
        has_heights = bool(np.isfinite(detections.elevation[is_known]).all())
        return points[is_known], weights[is_known], detections.velocity[is_known], detections.centre, has_heights
    if isinstance(detections, np.ndarray) and detections.dtype.kind in "fiu" and detections.size == 0:
        return _NONE
    if isinstance(detections, (list, tuple)) and not len(detections):
        return _NONE
    points = _POINTS("detections", detections)
    flat = np.zeros((len(points), 3))
    flat[:, :points.shape[1]] = points
    return flat, np.ones(len(points)), np.full(len(points), np.nan), np.zeros(3), points.shape[1] == 3


def _merged(points, weights, speeds, merge_distance: float) -> tuple:
    """Means of the points that chains of steps shorter than `merge_distance` join, by weight, and the speed of the one of
    the largest weight."""
    if merge_distance == 0.0 or len(points) < 2:
        return points, speeds
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import KDTree

    near = KDTree(points).query_pairs(np.nextafter(merge_distance, 0.0), output_type="ndarray").T
    joined = coo_array((np.ones(near.shape[1], bool), tuple(near)), shape=(len(points), len(points)))
    count, group = connected_components(joined, directed=False)
    sums = np.stack([np.bincount(group, weights * column, count) for column in points.T], axis=1)
    by_weight = np.lexsort((-weights, group))
    strongest = by_weight[np.searchsorted(group[by_weight], np.arange(count))]
    return sums / np.bincount(group, weights, count)[:, None], speeds[strongest]


def _outer(vectors):
    return vectors[:, :, None] * vectors[:, None, :]


def detections_rule(argument: str, value) -> list:
    """A list with the detections of each frame."""
    rule = "a list with the Detections or points [D, 2] of each frame"
    if isinstance(value, Detections):
        raise refused(TypeError, argument, f"{rule}, not those of one", value)
    return list(iterable(argument, value, rule))
