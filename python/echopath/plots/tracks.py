"""Tracks as seen from above."""
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .names import write_names
from .style import CURVE_COLOURS, X_LABEL, Y_LABEL, axes_or_new, require_drawable, to_one_scale

if TYPE_CHECKING:
    from ..base.classes.foreign_types import Axes
    from ..tracks import Tracks

SIZE = 6.0, 5.2  # inches
LINES = ("-", "--", ":", "-.")  # for more tracks than there are colours
ROWS, COLUMNS = 22, 2           # of the legend at most, which names tracks of objects
COLUMN_WIDTH = 1.5              # inches, of names
TITLE = "Tracks from above"
WITHOUT_LABEL, WITHOUT_COLOUR = "without a detection", "0.3"


def draw_tracks(tracks: Tracks, *, ax: Axes | None = None, title: str = "") -> Axes:
    """Tracks as lines from above, crosses where they went on without a detection, in given axes or new ones (None).

    The legend has the tracks that follow objects, or where none does all of them: the first ROWS times COLUMNS, and how many
    more. Tracks have their numbers at their ends, those that the legend is of first; of many, some may find no room.
    tracks: Tracks; title: above the axes, "": that of axes with a title, else TITLE
    Returns the axes: y in m across, left positive, x in m up. Raises TypeError naming `tracks` or `ax`.
    """
    require_drawable("tracks", "Tracks, as ep.track makes them", tracks, "track", "state")
    numbers = np.unique(tracks.track)
    named = np.unique(tracks.track[tracks.object != ""]) if np.any(tracks.object != "") else numbers
    listed, more = named[:ROWS * COLUMNS].tolist(), max(len(named) - ROWS * COLUMNS, 0)
    columns = max(-(-len(listed) // ROWS), 1)
    with axes_or_new(ax, SIZE[0] + COLUMN_WIDTH * (columns - 1), SIZE[1], (Y_LABEL, X_LABEL)) as ax:
        for place, number in enumerate(numbers):
            one, colour = tracks.of_track(number), CURVE_COLOURS[place % len(CURVE_COLOURS)]
            line = LINES[place // len(CURVE_COLOURS) % len(LINES)]
            x, y = one.state[:, :2].T
            ax.plot(y, x, line, color=colour, marker=".", markersize=3, label=_name(one, number) if number in listed else None)
            ax.plot(y[~one.is_detected], x[~one.is_detected], "x", color=colour, markersize=5)
        ax.set(xlabel=Y_LABEL, ylabel=X_LABEL, title=title or ax.get_title() or TITLE)
        to_one_scale(ax)
        in_turn = [*named, *np.setdiff1d(numbers, named)]
        write_names(ax, [(str(number), tracks.of_track(number).state[-1, 1::-1]) for number in in_turn])
        if listed and not np.all(tracks.is_detected):
            ax.plot([], [], "x", color=WITHOUT_COLOUR, markersize=5, label=WITHOUT_LABEL)
        if more:
            ax.plot([], [], " ", label=f"and {more} more")
        if listed:
            ax.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), ncols=columns, frameon=False)
    return ax


def _name(one, number: int) -> str:
    names, counts = np.unique(one.object[one.object != ""], return_counts=True)
    return f"{number}: {names[counts.argmax()]}" if len(names) else f"{number}"
