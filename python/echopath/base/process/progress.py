"""Progress bars: of the command line on a terminal, and of `progress=True` on a terminal or in a notebook."""
from __future__ import annotations

import shutil
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import TypeVar

Item = TypeVar("Item")

MAX_WIDTH = 100  # columns
DELAY = 0.2      # s: what takes less shows no bar, of which a frame has hundreds
_FORMAT = "{desc:<12} {percentage:3.0f} %|{bar}| {elapsed} < {remaining}"


def automatic_bars() -> Bars:
    """What stands for `progress=True` in any call: a bar for each stage by tqdm.auto, which a terminal and a notebook show."""
    from tqdm.auto import tqdm

    return Bars(lambda stage: tqdm(total=100.0, desc=stage, leave=False, delay=DELAY, bar_format=_FORMAT))


def with_progress(items: Iterable[Item], num_items: int, progress: Callable[[str, float], object] | bool | None,
                  stage: str = "frames") -> Iterator[Item]:
    """The items, after each of which a progress callable is told the stage and the share of those that were there; True: bars."""
    bars = automatic_bars() if progress is True else progress
    for done, item in enumerate(items, 1):
        if callable(bars):
            bars(stage, done / num_items)
        yield item


@contextmanager
def progress_bars():
    """Yields a progress callable (stage, fraction) that draws one bar per stage on standard error, or None where that is no
    terminal. The bars are closed however the block ends."""
    stream = sys.stderr
    if not stream.isatty():
        yield None
        return
    bars = Bars(lambda stage: _terminal_bar(stage, stream))
    try:
        yield bars
    finally:
        bars.close()


class Bars:
    """A progress callable that shows one bar at a time: a new stage, or a fraction that falls, closes the old one.

    begin: function (stage) that opens a bar of 100 steps
    """

    def __init__(self, begin):
        self._begin = begin
        self._stage = None
        self._bar = None

    def __call__(self, stage: str, fraction: float) -> None:
        percent = 100.0 * min(max(fraction, 0.0), 1.0)
        if stage != self._stage or self._bar is None or percent < self._bar.n:
            self.close()
            self._stage, self._bar = stage, self._begin(stage)
        self._bar.update(percent - self._bar.n)
        if fraction >= 1.0:
            self.close()

    def close(self) -> None:
        if self._bar is not None:
            self._bar.close()
        self._bar = self._stage = None


def _terminal_bar(stage: str, stream):
    from tqdm import tqdm

    # Terminals without a size of their own would get no bar at all, hence ncols and nrows.
    width = min(shutil.get_terminal_size((MAX_WIDTH, 24)).columns, MAX_WIDTH)
    return tqdm(total=100.0, desc=stage, file=stream, leave=False, ncols=width, nrows=24, bar_format=_FORMAT)
