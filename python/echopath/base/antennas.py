"""Where the antennas of a radar are, and which of them look the same way."""
from __future__ import annotations

import numpy as np


def centre_of(radar):
    """[3] m, in the radar's frame: half-way between the mean transmitter and the mean receiver."""
    return 0.5 * sum(np.mean([antenna.position for antenna in antennas], axis=0)
                     for antennas in (radar.transmitters, radar.receivers))


def middle_of_antennas(radar, time: float):
    """[3] m, in the world at a time in s: `centre_of`."""
    world_from_radar = radar.world_from_radar(time)
    return world_from_radar[:3, :3] @ centre_of(radar) + world_from_radar[:3, 3]


def look_of(antenna) -> tuple:
    """Pattern, orientation and polarisation: antennas of one look differ in their places alone."""
    return antenna.pattern, antenna.orientation.tolist(), np.asarray(antenna.polarization).tolist()
