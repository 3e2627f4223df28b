"""What frames in a row have in common, whether they are simulated or read: places, slices, times."""
from __future__ import annotations

import operator
import os
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any, Generic, SupportsIndex, TypeVar, overload

import numpy as np
from numpy.typing import NDArray

from ..arguments.checks import Progress, anything, checked, count, optional, path as path_rule, real, refused, text
from ..base.process.progress import with_progress
from .starts import Starts, pace_words

if TYPE_CHECKING:
    from ..base.classes.foreign_types import Figure

Item = TypeVar("Item")
Self = TypeVar("Self", bound="Row[Any]")


class Row(Generic[Item]):
    """Frames by their places 0 to K - 1; each is made when it is asked for, and none is kept.

    A class has `_numbers` (a range: the number of the frame at each place), `_starts` (of the frames, by number) and `_item`.
    """

    _numbers: range
    _starts: Starts

    def _item(self, place: int) -> Item:
        """What stands at a place."""
        raise NotImplementedError

    def _with_numbers(self: Self, places: slice) -> Self:
        made = object.__new__(type(self))
        made.__dict__ = self.__dict__ | {"_numbers": self._numbers[places]}
        return made

    @property
    def times(self) -> NDArray[np.float64]:
        """Starts of the frames, [K] in s."""
        return np.array([self._time_of(number) for number in self._numbers], np.float64)

    @property
    def interval(self) -> float | None:
        """From the start of one frame to that of the next in s, negative for a slice in reverse; None where `times` were
        given."""
        return None if self._starts.interval is None else self._starts.interval * self._numbers.step

    def _time_of(self, number: int) -> float:
        return self._starts.of(number)

    def __len__(self) -> int:
        return len(self._numbers)

    @overload
    def __getitem__(self, place: SupportsIndex) -> Item: ...

    @overload
    def __getitem__(self: Self, place: slice) -> Self: ...

    def __getitem__(self, place):
        """The frame at a place, from the end for a negative one; a slice gives the sequence of its frames."""
        if isinstance(place, slice):
            return self._with_numbers(place)
        return self._item(_place_in(place, len(self)))

    def __iter__(self) -> Iterator[Item]:
        return self._items(range(len(self)))

    def __reversed__(self) -> Iterator[Item]:
        return self._items(reversed(range(len(self))))

    @checked(self=anything)
    def frames(self, *, progress: Progress = None) -> Iterator[Item]:
        """The frames one after the other, as `for frame in sequence` has them, with progress.

        progress: callable (stage, fraction of the frames), True for bars with the time left in s, or None
        """
        return with_progress(self, len(self), progress)

    @checked(self=anything, num_frames=count(1, 16), vmin=anything, vmax=anything, title=text)
    def plot(self, *, num_frames: int = 4, vmin: float | None = None, vmax: float | None = None, title: str = "",
             progress: Progress = None) -> Figure:
        """Draws all frames at a glance: some of their maps in a row, below them range and radial velocity over time.

        Range over time is that of what moves, where something does: to a radar that stands, what has a velocity, and to one that
        moves, what moves in the world; there a dashed line marks the velocity of what stands straight ahead.

        num_frames: maps in the row, 1 to 16, evenly over time; title: above all
        vmin, vmax: ends of the colour scale in dBm, None: from the noise, or 70 dB below the peak, to the peak
        progress: callable (stage, fraction of the frames), True for bars, or None
        Returns a Matplotlib figure: range in m, velocity in m/s (receding positive), time in s, and in each cell over time the
        strongest of the other axis. Memory: 2 bytes for each cell of each frame, beside what one frame takes. Raises TypeError
        or ValueError naming the argument, ValueError without frames or maps.
        """
        from ..plots import plot_drive
        from .pictures import drive_of

        return plot_drive(drive_of(self, progress), num_frames=num_frames, vmin=vmin, vmax=vmax, title=title)

    @checked(self=anything, path=path_rule, frames_per_second=optional(real(0.1, 100.0, "1/s")), vmin=anything,
             vmax=anything, title=text)
    def film(self, path: str | os.PathLike[str], *, frames_per_second: float | None = None, vmin: float | None = None,
             vmax: float | None = None, title: str = "", progress: Progress = None) -> None:
        """Writes a film of the range-Doppler maps, whole or not at all, with the time in s above each.

        path: of the film, .gif or .mp4 (which needs imageio-ffmpeg); frames_per_second: 0.1 to 100, None: in real time, 25 at
            most, and frames of uneven times by the median of what lies between their starts
        vmin, vmax (dBm), progress: as of `plot`; title: before the time
        Memory: as of `plot`, and the pictures of a GIF, .5 MB each. Raises what `plot` raises, ValueError for another kind of
        file, ModuleNotFoundError without imageio-ffmpeg, ep.FileError.
        """
        from ..base.storage.film import require_kind
        from .pictures import drive_of, write_film_of

        require_kind(path)
        write_film_of(drive_of(self, progress), path, frames_per_second=frames_per_second, vmin=vmin, vmax=vmax, title=title)

    def _maps(self) -> tuple[int, Iterator[tuple], dict]:
        """How many frames are there, (start in s, level [V, R] in dBm, velocity [V], range [R]) of each, and the window and
        zero_pad of their maps."""
        raise NotImplementedError

    def _items(self, places: Iterable[int]) -> Iterator[Item]:
        """What stands at some places, one after the other; warnings name the line that takes it."""
        for place in places:
            yield self._item(place)

    def _span(self) -> str:
        if not len(self):
            return "none"
        first, last = (self._time_of(self._numbers[place]) for place in (0, -1))
        return f"from {first:.6g} to {last:.6g} s"

    def _pace(self) -> str:
        """How the frames follow each other, in words."""
        return pace_words(self.times, self.interval)


def _place_in(place, count: int) -> int:
    """A place from 0 on. Raises TypeError for what is no whole number, IndexError for one that is not there."""
    if isinstance(place, (bool, np.bool_)):
        raise refused(TypeError, "frame", "a whole number or a slice", place)
    try:
        found = operator.index(place)
    except TypeError:
        raise refused(TypeError, "frame", "a whole number or a slice", place) from None
    if not -count <= found < count:
        raise refused(IndexError, "frame", f"from {-count} to {count - 1}, places of {count} frames" if count else
                      "of a sequence that has any", place)
    return found % count
