"""Remarks on scenes whose lengths look like those of other units."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..base.callers import warn_user

LARGE = 1000.0     # m, all sides of an object that no scene has
LONG = 250.0       # m, all sides of a closed body: mountains are as high, but open below
SMALL = 0.5        # wavelengths, the longest side of an object


def warn_of_sizes(scene: _core.Scene, wavelength: float, time: float) -> None:
    """Warns (RuntimeWarning) of an empty scene, and of objects that look as if their lengths were not in m.

    wavelength: m; time: s, at which the scene is looked at; one outside of its motions is not for this to tell of
    """
    try:
        nodes, sides, closed = _core.object_sizes(scene, time)
    except ValueError:
        return
    remark = _remark(scene, nodes, sides, closed, wavelength)
    if remark:
        warn_user(remark)


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
