"""Remarks on scenes whose lengths look like those of other units, and on radars that stand in a body."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..base.process.callers import warn_user

LARGE = 1000.0     # m, all sides of an object that no scene has
LONG = 250.0       # m, all sides of a closed body: mountains are as high, but open below
SMALL = 0.5        # wavelengths, the longest side of an object


def warn_of_bodies(scene: _core.Scene, radar: _core.Radar, time: float) -> None:
    """Warns (RuntimeWarning) of an empty scene, of objects that look as if their lengths were not in m, and of a closed body
    around the radar that hides the rest of the scene.

    time: s, at which the scene is looked at; one outside of its motions is not for this to tell of
    """
    try:
        nodes, sides, closed, around = _core.look_at_bodies(scene, radar, time)
    except ValueError:
        return
    remark = _remark(scene, nodes, sides, closed, _core.speed_of_light / radar.waveform.start_frequency)
    if remark:
        warn_user(remark)
    if around:
        node, of_receivers = around[0]
        warn_user(f"radar: its first {'receiver' if of_receivers else 'transmitter'} stands inside of "
                  f"'{scene._node(node).name}', which is closed: what is outside of it is not seen")


def _remark(scene, nodes, sides, closed, wavelength: float) -> str:
    """About the first object whose size is strange, "" for none.

    nodes [N]; sides [N, 2] in m, shortest and longest; closed [N]; wavelength: m
    """
    if len(nodes) == 0:
        return "scene: has no mesh that takes part: no ray hits"
    shortest, longest = sides.T
    large = (shortest > LARGE) | ((longest > LARGE) & (shortest > LONG) & closed)
    strange = np.flatnonzero(large | (longest < SMALL * wavelength))
    if len(strange) == 0:
        return ""
    first = strange[0]
    name = scene._node(nodes[first]).name
    if large[first]:
        return (f"scene: '{name}' is {longest[first]:,.0f} m long and {shortest[first]:,.0f} m thick; is it in mm? "
                "load_mesh(path, unit=0.001) reads such files")
    return (f"scene: '{name}' is {longest[first]:.3g} m large, less than half a wavelength ({wavelength:.3g} m), where ray "
            "optics ends; is it in m?")
