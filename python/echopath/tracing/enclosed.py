"""Remarks on radars that stand in a body."""
from __future__ import annotations

from .. import _core
from ..base.callers import warn_user


def warn_of_enclosed_antennas(scene: _core.Scene, radar: _core.Radar, time: float) -> None:
    """Warns (RuntimeWarning) of a closed body around the radar that hides the rest of the scene.

    time: s; one outside of the motions is not for this to tell of
    """
    try:
        found = _core.enclosures(scene, radar, time)
    except ValueError:
        return
    if found:
        node, of_receivers = found[0]
        warn_user(f"radar: its first {'receiver' if of_receivers else 'transmitter'} stands inside of "
                  f"'{scene._node(node).name}', which is closed: what is outside of it is not seen")
