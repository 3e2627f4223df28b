"""Kalman filters of points in the plane that go straight at constant speed but for random accelerations."""
from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..base.radar.velocities import folded
from .points import Points

KNOWN = 0.25  # of the ambiguity, the most that a speed may be uncertain by to be told from those that look the same


class Fit(NamedTuple):
    """How well each of K points goes with its filter.

    place: [K], squared Mahalanobis distance; speed: [K], likewise of the radial velocity, 0 where that tells nothing
    cost: [K], minus twice the log likelihood of both together, but for a constant
    """

    place: np.ndarray
    speed: np.ndarray
    cost: np.ndarray


@dataclass(frozen=True)
class Filters:
    """States [K, 4] (x, y, vx, vy) in m and m/s of K filters with their covariances [K, 4, 4].

    Source: Bar-Shalom, Li, Kirubarajan 2001, chapter 5 and section 6.3.2 (piecewise constant white acceleration). A radial
    velocity is known up to whole ambiguities: it is taken in, as the one nearest to the expected one, as soon as the filter knows
    the speed along that line to a quarter of one; until then all are equally likely.
    """

    states: np.ndarray
    covariances: np.ndarray

    def __len__(self) -> int:
        return len(self.states)

    def some(self, indices) -> Filters:
        """Those at [N] places."""
        return Filters(self.states[indices], self.covariances[indices])

    def with_others(self, others: Filters) -> Filters:
        """These, and others behind them."""
        return Filters(np.concatenate([self.states, others.states]), np.concatenate([self.covariances, others.covariances]))

    def predicted(self, step: float, acceleration_std: float) -> Filters:
        """After `step` s."""
        move = np.eye(4)
        move[0, 2] = move[1, 3] = step
        push = np.vstack([0.5 * step**2 * np.eye(2), step * np.eye(2)])
        return Filters(self.states @ move.T, move @ self.covariances @ move.T + acceleration_std**2 * push @ push.T)

    def fit(self, found: Points) -> Fit:
        """How well K points go with these filters, each with its own."""
        rows, innovation, noise, tells = self._measured(found)
        spread = rows @ self.covariances @ rows.transpose(0, 2, 1) + noise
        joint = np.einsum("mi,mi->m", innovation, np.linalg.solve(spread, innovation[..., None])[..., 0])
        off = innovation[:, :2]
        place = np.einsum("mi,mi->m", off, np.linalg.solve(spread[:, :2, :2], off[..., None])[..., 0])
        speed = np.where(tells, innovation[:, 2] ** 2 / spread[:, 2, 2], 0.0)
        alone = place + np.linalg.slogdet(spread[:, :2, :2])[1] + found.log_of_any_speed
        return Fit(place, speed, np.where(tells, joint + np.linalg.slogdet(spread)[1], alone))

    def updated(self, indices, found: Points) -> Filters:
        """After those at [N] places took in a point each of the N found ones."""
        taken = self.some(indices)._taken(found, first=0)
        states, covariances = self.states.copy(), self.covariances.copy()
        states[indices], covariances[indices] = taken.states, taken.covariances
        return Filters(states, covariances)

    def _taken(self, found: Points, first: int) -> Filters:
        """After each took of its point what is measured from x (0), y (1) or the speed (2) on."""
        rows, innovation, noise, tells = self._measured(found)
        states, covariances = self.states.copy(), self.covariances.copy()
        for end, which in ((3, tells), (2, ~tells)):
            kept, of = slice(first, end), np.flatnonzero(which)
            states[of], covariances[of] = _corrected(states[of], covariances[of], rows[of, kept], innovation[of, kept],
                                                     noise[of, kept, kept])
        return Filters(states, covariances)

    def _measured(self, found: Points) -> tuple:
        """(what is measured of each state [K, 3, 4], by how much it is off [K, 3], its covariance [K, 3, 3], whether the speed
        tells [K]) of x, y and the speed along the line of sight."""
        rows = np.zeros((len(self), 3, 4))
        rows[:, 0, 0] = rows[:, 1, 1] = 1.0
        rows[:, 2, 2:] = found.sights
        noise = np.zeros((len(self), 3, 3))
        noise[:, :2, :2], noise[:, 2, 2] = found.covariances, found.speed_std**2
        of_speed = np.einsum("mi,mij,mj->m", found.sights, self.covariances[:, 2:, 2:], found.sights) + found.speed_std**2
        tells = found.ambiguity * KNOWN > np.sqrt(of_speed)
        off = found.speeds - np.einsum("mi,mi->m", found.sights, self.states[:, 2:])
        return rows, np.column_stack([found.points - self.states[:, :2], folded(off, found.ambiguity)]), noise, tells


def begun(found: Points, speed_std: float) -> Filters:
    """The Filters that begin with K points. speed_std: m/s, of each coordinate of a velocity, as far as that is not measured"""
    states, covariances = np.zeros((len(found.points), 4)), np.zeros((len(found.points), 4, 4))
    states[:, :2], covariances[:, :2, :2] = found.points, found.covariances
    covariances[:, 2:, 2:] = speed_std**2 * np.eye(2)
    return Filters(states, covariances)._taken(found, first=2)


def _corrected(states, covariances, rows, innovation, noise) -> tuple:
    """(states, covariances) after what was measured by the form of Joseph, which keeps covariances symmetric and positive."""
    columns = rows.transpose(0, 2, 1)
    gain = np.linalg.solve(rows @ covariances @ columns + noise, rows @ covariances).transpose(0, 2, 1)
    rest = np.eye(4) - gain @ rows
    return (states + (gain @ innovation[..., None])[..., 0],
            rest @ covariances @ rest.transpose(0, 2, 1) + gain @ noise @ gain.transpose(0, 2, 1))
