"""A Kalman filter of points in the plane that go straight at constant speed but for random accelerations."""
from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..base.radar.velocities import folded
from .points import Points

KNOWN = 0.25  # of the ambiguity, the most that a speed may be uncertain by to be told from those that look the same


class Fit(NamedTuple):
    """How well M points go with a filter.

    place: [M], squared Mahalanobis distance; speed: [M], likewise of the radial velocity, 0 where that tells nothing
    cost: [M], minus twice the log likelihood of both together, but for a constant
    """

    place: np.ndarray
    speed: np.ndarray
    cost: np.ndarray


class Filter:
    """State (x, y, vx, vy) in m and m/s with its covariance [4, 4].

    Source: Bar-Shalom, Li, Kirubarajan 2001, chapter 5 and section 6.3.2 (piecewise constant white acceleration). A radial
    velocity is known up to whole ambiguities: it is taken in, as the one nearest to the expected one, as soon as the filter knows
    the speed along that line to a quarter of one; until then all are equally likely.
    """

    def __init__(self, found: Points, index: int, speed_std: float):
        """Begins with a point. speed_std: m/s, of each coordinate of its velocity, as far as that is not measured"""
        self.state = np.array([*found.points[index], 0.0, 0.0])
        self.covariance = np.zeros((4, 4))
        self.covariance[:2, :2] = found.covariances[index]
        self.covariance[2:, 2:] = speed_std**2 * np.eye(2)
        self._take(found, index, first=2)

    def predict(self, step: float, acceleration_std: float) -> None:
        """Goes on by `step` s."""
        move = np.eye(4)
        move[0, 2] = move[1, 3] = step
        push = np.vstack([0.5 * step**2 * np.eye(2), step * np.eye(2)])
        self.state = move @ self.state
        self.covariance = move @ self.covariance @ move.T + acceleration_std**2 * push @ push.T

    def fit(self, found: Points) -> Fit:
        """How well points go with it, each for itself."""
        rows, innovation, noise, tells = self._measured(found)
        spread = rows @ self.covariance @ rows.transpose(0, 2, 1) + noise
        joint = np.einsum("mi,mi->m", innovation, np.linalg.solve(spread, innovation[..., None])[..., 0])
        off = innovation[:, :2]
        place = np.einsum("mi,mi->m", off, np.linalg.solve(spread[:, :2, :2], off[..., None])[..., 0])
        speed = np.where(tells, innovation[:, 2] ** 2 / spread[:, 2, 2], 0.0)
        alone = place + np.linalg.slogdet(spread[:, :2, :2])[1] + found.log_of_any_speed
        return Fit(place, speed, np.where(tells, joint + np.linalg.slogdet(spread)[1], alone))

    def update(self, found: Points, index: int) -> None:
        """Takes a point in."""
        self._take(found, index, first=0)

    def _take(self, found: Points, index: int, first: int) -> None:
        """Takes of a point what is measured from x (0), y (1) or the speed (2) on, by the form of Joseph, which keeps the
        covariance symmetric and positive."""
        rows, innovation, noise, tells = (values[0] for values in self._measured(found.some([index])))
        kept = slice(first, 3 if tells else 2)
        rows, innovation, noise = rows[kept], innovation[kept], noise[kept, kept]
        gain = np.linalg.solve(rows @ self.covariance @ rows.T + noise, rows @ self.covariance).T
        self.state = self.state + gain @ innovation
        rest = np.eye(4) - gain @ rows
        self.covariance = rest @ self.covariance @ rest.T + gain @ noise @ gain.T

    def _measured(self, found: Points) -> tuple:
        """(what is measured of a state [M, 3, 4], by how much it is off [M, 3], its covariance [M, 3, 3], whether the speed
        tells [M]) of x, y and the speed along the line of sight."""
        rows = np.zeros((len(found.points), 3, 4))
        rows[:, 0, 0] = rows[:, 1, 1] = 1.0
        rows[:, 2, 2:] = found.sights
        noise = np.zeros((len(found.points), 3, 3))
        noise[:, :2, :2], noise[:, 2, 2] = found.covariances, found.speed_std**2
        of_speed = np.einsum("mi,ij,mj->m", found.sights, self.covariance[2:, 2:], found.sights) + found.speed_std**2
        tells = found.ambiguity * KNOWN > np.sqrt(of_speed)
        off = found.speeds - found.sights @ self.state[2:]
        return rows, np.column_stack([found.points - self.state[:2], folded(off, found.ambiguity)]), noise, tells
