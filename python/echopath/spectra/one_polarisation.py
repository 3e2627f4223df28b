"""Arrays whose channels are of several polarisations, which are no one array."""
from __future__ import annotations

from ..base.process.callers import warn_user
from ..base.radar.antennas import mixes_polarisations


def warn_of_mixed_polarisations(radar, function: str) -> None:
    """Warns that beams add channels whose echoes differ in more than the phase of their places."""
    if mixes_polarisations(radar):
        warn_user(f"{function}: the channels of this radar have several pairs of polarisations, whose echoes differ in level and "
                  "phase, and its beams add them as if they had one: VV and HH of a dihedral cancel. Radars with antennas of one "
                  "pair each show them all; synthesize makes the signals of each from the paths of one trace")
