"""What lies beyond the scale of a picture stands at its end with a triangle that points on."""
from __future__ import annotations

import numpy as np

WORDS = "beyond the scale"
_UP_AND_DOWN, _ASIDE = ("v", "^"), ("<", ">")


def within(axes, places, values, limits: tuple[float, float], colour, *, across: bool = False):
    """Values [N] held to `limits`, each that lay beyond them marked in the axes; returns them.

    places: [N], along the other axis; across: the values run along x, else along y
    """
    places, values = np.asarray(places, float), np.asarray(values, float)
    for end, is_beyond, marker in zip(limits, (values < limits[0], values > limits[1]), _ASIDE if across else _UP_AND_DOWN):
        if is_beyond.any():
            at, ends = places[is_beyond], np.full(np.count_nonzero(is_beyond), end)
            axes.plot(*((ends, at) if across else (at, ends)), marker, color=colour, markersize=6, clip_on=False, zorder=6)
    return np.clip(values, *limits)


def handle(across: bool = False):
    """What a legend says of the marks: a handle for Matplotlib."""
    from matplotlib.lines import Line2D

    return Line2D([], [], marker=(_ASIDE if across else _UP_AND_DOWN)[0], linestyle="none", color="0.3", label=WORDS)
