"""Progress bars on a terminal."""
from __future__ import annotations

import shutil
import sys
from contextlib import contextmanager

MAX_WIDTH = 100  # columns


@contextmanager
def progress_bars(stream=None):
    """Yields a progress callable (stage, fraction) that draws one bar per stage, or None where `stream` is no terminal.

    stream: of the bars, default standard error. The bars are closed however the block ends.
    """
    stream = stream if stream is not None else sys.stderr
    if not stream.isatty():
        yield None
        return
    bars = _Bars(stream)
    try:
        yield bars
    finally:
        bars.close()


class _Bars:
    """One bar at a time: a new stage, or a fraction that falls, closes the old one."""

    def __init__(self, stream):
        self._stream = stream
        self._stage = None
        self._bar = None

    def __call__(self, stage: str, fraction: float) -> None:
        percent = 100.0 * min(max(fraction, 0.0), 1.0)
        if stage != self._stage or self._bar is None or percent < self._bar.n:
            self._begin(stage)
        self._bar.update(percent - self._bar.n)
        if fraction >= 1.0:
            self.close()

    def close(self) -> None:
        if self._bar is not None:
            self._bar.close()
        self._bar = self._stage = None

    def _begin(self, stage: str) -> None:
        from tqdm import tqdm

        self.close()
        self._stage = stage
        # Terminals without a size of their own would get no bar at all, hence ncols and nrows.
        width = min(shutil.get_terminal_size((MAX_WIDTH, 24)).columns, MAX_WIDTH)
        self._bar = tqdm(total=100.0, desc=stage, file=self._stream, leave=False, ncols=width, nrows=24,
                         bar_format="{desc:<12} {percentage:3.0f} %|{bar}| {elapsed} < {remaining}")
