"""Tracks as seen from above."""
from __future__ import annotations

import numpy as np

from .style import CURVE_COLOURS, axes_or_new

SIZE = 6.0, 5.2  # inches
LINES = ("-", "--", ":", "-.")  # for more tracks than there are colours
X_LABEL, Y_LABEL = "x in m (ahead)", "y in m (left: +)"


def draw_tracks(tracks, *, ax=None, title=""):
    """Tracks as lines from above, crosses where they went on without a detection, in given axes or new ones (None).

    tracks: Tracks; title: above the axes
    Returns the axes: y in m across, left positive, x in m up. Raises TypeError naming `ax`.
    """
    with axes_or_new(ax, *SIZE) as ax:
        for place, number in enumerate(np.unique(tracks.track)):
            one, colour = tracks.of_track(number), CURVE_COLOURS[place % len(CURVE_COLOURS)]
            line = LINES[place // len(CURVE_COLOURS) % len(LINES)]
            x, y = one.state[:, :2].T
            ax.plot(y, x, line, color=colour, marker=".", markersize=3, label=_name(one, number))
            ax.plot(y[~one.is_detected], x[~one.is_detected], "x", color=colour, markersize=5)
            ax.annotate(str(number), (y[-1], x[-1]), xytext=(4, 4), textcoords="offset points", color="0.1")
        ax.set(xlabel=Y_LABEL, ylabel=X_LABEL, title=title, aspect="equal")
        ax.set_xlim(*sorted(ax.get_xlim(), reverse=True))
        if tracks.num_tracks:
            ax.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
    return ax


def _name(one, number: int) -> str:
    names, counts = np.unique(one.object[one.object != ""], return_counts=True)
    return f"{number}: {names[counts.argmax()]}" if len(names) else f"{number}"
