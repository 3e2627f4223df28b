"""Measures of triangles."""
from __future__ import annotations

import numpy as np


def areas_of(corners) -> np.ndarray:
    """m^2 [N], of triangles [N, corner, 3] in m."""
    return 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=-1)
