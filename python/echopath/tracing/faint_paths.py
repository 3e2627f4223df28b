"""How faint a diffuse path must be where `faint_power="auto"` leaves that to the radar."""
from __future__ import annotations

from .. import _core
from ..arguments.settings import FaintPower

SHARE_OF_NOISE = 0.025  # a cell as strong as the noise then sums up forty such paths or more, and fluctuates as with all


def faint_power_of(faint_power: FaintPower, radar: _core.Radar) -> float:
    """W. "auto" goes by the noise of a cell of the map, once the channels of the array are added in phase.

    faint_power: of `trace`
    """
    if faint_power != "auto":
        return faint_power
    return SHARE_OF_NOISE * _core.noise_power_in_cell(radar) / (len(radar.transmitters) * len(radar.receivers))
