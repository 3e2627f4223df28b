"""Tracks as a value: a row for each track and frame."""
from __future__ import annotations

import dataclasses
import os
from typing import TYPE_CHECKING

import numpy as np

from ..arguments.checks import count
from ..base.classes.equality import has_same_fields
from ..base.classes.made_by import made_by
from ..base.text.counts import counted
from ..presentation.tables import make_table, write_csv

if TYPE_CHECKING:
    from ..base.classes.foreign_types import Axes, DataFrame

_UNITS = {"time": "s", "x": "m", "y": "m", "vx": "m/s", "vy": "m/s"}


@made_by("ep.track")
@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Tracks:
    """Where tracked objects were, N rows of a track and a frame, by track and time; made by `track`.

    track: i32 [N], number of the track from 0 on, by its first detection; frame: i32 [N], index; time: [N] s
    state: [N, 4], x, y in m, vx, vy in m/s, in the axes of the radar or, with a radar given, of the world
    covariance: [N, 4, 4] of the state, m^2, m^2/s, m^2/s^2
    is_detected: bool [N], whether a detection of that frame belongs to the track, which goes straight on otherwise
    object: [N] text, of the truth that it follows in that frame, each in one track at most; "" for none, or where no truth was
        given
    """

    track: np.ndarray
    frame: np.ndarray
    time: np.ndarray
    state: np.ndarray
    covariance: np.ndarray
    is_detected: np.ndarray
    object: np.ndarray

    @property
    def num_tracks(self) -> int:
        """How many tracks there are."""
        return len(np.unique(self.track))

    @property
    def num_switches(self) -> int:
        """How often an object of the truth goes on in another track than that which followed it before."""
        count = 0
        for name in np.unique(self.object[self.object != ""]):
            rows = np.flatnonzero(self.object == name)
            followed = self.track[rows[np.argsort(self.time[rows], kind="stable")]]
            count += int(np.count_nonzero(followed[1:] != followed[:-1]))
        return count

    def of_track(self, number: int) -> Tracks:
        """The rows of one track, ascending in time (s).

        number: of the track. Raises TypeError or ValueError for what is no whole number of at least 0, KeyError for one that is
            not there.
        """
        number = count(0)("number", number)
        chosen = np.flatnonzero(self.track == number)
        if not len(chosen):
            raise KeyError(f"number: must be that of one of {self.num_tracks} tracks, got {number}")
        return Tracks(**{field.name: getattr(self, field.name)[chosen] for field in dataclasses.fields(self)})

    def to_dataframe(self) -> DataFrame:
        """A pandas.DataFrame with a row for each track and frame.

        Columns: track, frame, time (s), x, y (m), vx, vy (m/s), is_detected, object; units in `attrs["units"]`. Needs pandas,
        raises ModuleNotFoundError without it.
        """
        return make_table(self._columns(), _UNITS)

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """Writes the same table, whole or not at all; names of columns end with the unit (time_s, vx_m_per_s).

        path: of the file. Raises ep.FileError.
        """
        write_csv(path, self._columns() | {"is_detected": self.is_detected.astype(int)}, _UNITS)

    def plot(self, *, ax: Axes | None = None, title: str = "") -> Axes:
        """Draws each track as a line from above, with its number and the object that it follows most.

        ax: Matplotlib axes to draw in, None: new ones; title: above it, "": that of axes with a title, else what is shown
        Returns the axes: y in m across, left positive, x in m up. Raises TypeError, ValueError for axes that hold a picture which
        is none from above.
        """
        from ..plots import draw_tracks

        return draw_tracks(self, ax=ax, title=title)

    def _columns(self) -> dict:
        states = dict(zip(("x", "y", "vx", "vy"), self.state.T))
        return {"track": self.track, "frame": self.frame, "time": self.time, **states, "is_detected": self.is_detected,
                "object": self.object}

    def __eq__(self, other) -> bool:
        return has_same_fields(self, other) if isinstance(other, Tracks) else NotImplemented

    __hash__ = None

    def __len__(self) -> int:
        return len(self.track)

    def __repr__(self) -> str:
        return f"Tracks({counted(self.num_tracks, 'track')}, {counted(len(self), 'row')})"
