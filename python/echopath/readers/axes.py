"""Coordinates of a file -> those of a scene: x forward, y left, z up, in m."""
from __future__ import annotations

import numpy as np

from .options import AXES, ReadOptions


class Axes:
    """Takes points and transforms of a file to a scene: a rotation of the axes and a scale.

    options: `unit` and `up` of the caller go before what the file says; unit: m per unit of the file; up: "x", "y" or "z"
    """

    def __init__(self, options: ReadOptions, unit: float = 1.0, up: str = "z"):
        self.unit = float(unit if options.unit is None else options.unit)
        self.up = options.up or up
        self._order = list(AXES[self.up])

    def points(self, points) -> np.ndarray:
        """[..., 3] in units of the file -> [..., 3] in m."""
        return self.unit * self.turned(points)

    def turned(self, points) -> np.ndarray:
        """[..., 3] with the axes of the file -> with those of a scene, in the same unit."""
        return np.asarray(points, np.float64)[..., self._order]

    def matrices(self, matrices) -> np.ndarray:
        """Transforms [..., 4, 4] between frames of the file -> between the same frames in axes and units of a scene."""
        moved = np.array(matrices, np.float64)
        moved[..., :3, :3] = moved[..., self._order, :][..., self._order]
        moved[..., :3, 3] = self.points(np.asarray(matrices)[..., :3, 3])
        moved[..., 3, :] = 0.0, 0.0, 0.0, 1.0  # to the last bit, which inverses of others miss
        return moved

    def quaternions(self, xyzw) -> np.ndarray:
        """Unit quaternions [..., 4] (x, y, z, w) in the axes of the file -> (w, x, y, z) in those of a scene."""
        return np.asarray(xyzw, np.float64)[..., [3, *self._order]]
