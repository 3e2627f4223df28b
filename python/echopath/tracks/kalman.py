"""A Kalman filter of points in the plane that go straight at constant speed but for random accelerations."""
from __future__ import annotations

import numpy as np

_H = np.eye(2, 4)


class Filter:
    """State (x, y, vx, vy) in m and m/s with its covariance [4, 4].

    Source: Bar-Shalom, Li, Kirubarajan 2001, chapter 5 and section 6.3.2 (piecewise constant white acceleration).
    """

    def __init__(self, point, point_covariance, speed_std: float):
        self.state = np.array([*point, 0.0, 0.0])
        self.covariance = np.zeros((4, 4))
        self.covariance[:2, :2] = point_covariance
        self.covariance[2:, 2:] = speed_std**2 * np.eye(2)

    def predict(self, step: float, acceleration_std: float) -> None:
        """Goes on by `step` s."""
        move = np.eye(4)
        move[0, 2] = move[1, 3] = step
        push = np.vstack([0.5 * step**2 * np.eye(2), step * np.eye(2)])
        self.state = move @ self.state
        self.covariance = move @ self.covariance @ move.T + acceleration_std**2 * push @ push.T

    def distances(self, points, covariances):
        """Squared Mahalanobis distance of points [M, 2] with covariances [M, 2, 2], and log det of the innovation's, [M] each."""
        innovation = points - self.state[:2]
        spread = covariances + self.covariance[:2, :2]
        squared = np.einsum("mi,mi->m", innovation, np.linalg.solve(spread, innovation[..., None])[..., 0])
        return squared, np.linalg.slogdet(spread)[1]

    def update(self, point, point_covariance) -> None:
        """Takes a point in, by the form of Joseph, which keeps the covariance symmetric and positive."""
        gain = np.linalg.solve(self.covariance[:2, :2] + point_covariance, self.covariance[:2]).T
        self.state = self.state + gain @ (point - self.state[:2])
        rest = np.eye(4) - gain @ _H
        self.covariance = rest @ self.covariance @ rest.T + gain @ point_covariance @ gain.T
