"""How faint a diffuse path must be where `faint_power="auto"` leaves that to the radar, and which other radars that suits."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..arguments.settings import FaintPower
from ..base.process.callers import warn_user
from ..base.text.counts import at_least

SHARE_OF_NOISE = 0.025  # a cell as strong as the noise then sums up forty such paths or more, and fluctuates as with all
MORE = 4.0              # as far over the noise another radar may hear the same paths: ten of them make a cell then


def faint_power_of(faint_power: FaintPower, radar: _core.Radar) -> float:
    """W. "auto" goes by the noise of a cell of the map, once the channels of the array are added in phase.

    faint_power: of `trace`
    """
    if faint_power != "auto":
        return faint_power
    return SHARE_OF_NOISE * _core.noise_power_in_cell(radar) / (len(radar.transmitters) * len(radar.receivers))


def warn_of_other_noise(paths: _core.Paths, radar: _core.Radar) -> None:
    """Warns (RuntimeWarning) where another radar than that of the trace hears faint paths that stand for others too well."""
    left_out = paths.frame.statistics.num_faint_paths
    if left_out == 0:
        return
    more = _heard_of(radar) / _heard_of(paths.radar)
    if more > MORE:
        warn_user(f"radar: hears echoes {10.0 * np.log10(more):.0f} dB further above the noise than the radar of the trace, by "
                  f"whose noise {at_least(left_out)} faint paths were left out: few paths make the weak cells here. Trace with "
                  "it")


def _heard_of(radar: _core.Radar) -> float:
    """How far echoes of one strength lie above what counts as faint."""
    return radar.transmit_power / faint_power_of("auto", radar)
