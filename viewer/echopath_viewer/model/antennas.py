"""Where the antennas are in the world."""
from __future__ import annotations

import numpy as np


def world_from_antenna(radar, antenna, time: float):
    """[4, 4], translation in m."""
    local = np.eye(4)
    local[:3, :3], local[:3, 3] = rotation_of(antenna.orientation), antenna.position
    return np.asarray(radar.world_from_radar(time)) @ local


def rotation_of(quaternion):
    """[3, 3] of a unit quaternion (w, x, y, z)."""
    w, x, y, z = quaternion
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
