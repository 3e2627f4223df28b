"""Where the antennas of a radar are."""
from __future__ import annotations

import numpy as np


def centre_of(radar):
    """[3] m, in the radar's frame: half-way between the mean transmitter and the mean receiver."""
    return 0.5 * sum(np.mean([antenna.position for antenna in antennas], axis=0)
                     for antennas in (radar.transmitters, radar.receivers))
