"""What frames in a row have in common, whether they are simulated or read: places, slices, times."""
from __future__ import annotations

import operator
from collections.abc import Iterable, Iterator
from typing import Any, Generic, SupportsIndex, TypeVar, overload

import numpy as np
from numpy.typing import NDArray

from ..arguments.checks import refused
from .record import start_time_of

Item = TypeVar("Item")
Self = TypeVar("Self", bound="Row[Any]")


class Row(Generic[Item]):
    """Frames by their places 0 to K - 1; each is made when it is asked for, and none is kept.

    A class has `_numbers` (a range: the number of the frame at each place), `_start_time` (s, of number 0), `_interval` (s, from
    number to number) and `_item`.
    """

    _numbers: range
    _start_time: float
    _interval: float

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
    def interval(self) -> float:
        """From the start of one frame to that of the next in s; negative for a slice in reverse."""
        return self._interval * self._numbers.step

    def _time_of(self, number: int) -> float:
        return start_time_of(self._start_time, self._interval, number)

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

    def _items(self, places: Iterable[int]) -> Iterator[Item]:
        """What stands at some places, one after the other; warnings name the line that takes it."""
        for place in places:
            yield self._item(place)

    def _span(self) -> str:
        times = self.times
        return f"from {times[0]:.6g} to {times[-1]:.6g} s" if len(times) else "none"


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
