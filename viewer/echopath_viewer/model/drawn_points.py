"""Places as they are drawn."""
from __future__ import annotations

import numpy as np

NEAR = 1e4  # m from the origin of the world: up to here single precision is off by half a millimetre at most


def as_drawn(points) -> np.ndarray:
    """Points [..., 3] in m in single precision, which is drawn quickly; in double where some are far, as in coordinates of maps:
    single precision would leave lumps of half a metre of what stands 5000 km away. VTK draws those from their own middle."""
    points = np.asarray(points)
    if points.dtype == np.float64 and max(np.fmax.reduce(points, axis=None, initial=0.0),
                                          -np.fmin.reduce(points, axis=None, initial=0.0)) > NEAR:
        return points
    return points.astype(np.float32, copy=False)
