"""Where the antennas are in the world."""
from __future__ import annotations

import numpy as np

from echopath.base.numerics.rotations import matrices


def world_from_antenna(radar, antenna, time: float):
    """[4, 4], translation in m."""
    local = np.eye(4)
    local[:3, :3], local[:3, 3] = matrices(antenna.orientation), antenna.position
    return np.asarray(radar.world_from_radar(time)) @ local
