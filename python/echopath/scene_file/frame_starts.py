"""Starts of the frames in time of a scene file, from a text file that it names, and of the first of them."""
from __future__ import annotations

import math
from pathlib import Path

from .. import _core
from ..base.storage.files import bytes_of
from ..base.storage.lines import refuse


def read_starts(path: Path) -> list[float]:
    """The numbers of a text file, one in a line, in s; lines that are empty or begin with # count for nothing.

    Raises ep.FileError naming the file, the line, the rule and the value.
    """
    try:
        lines = bytes_of(path).decode("utf-8-sig").splitlines()
    except UnicodeDecodeError as error:
        raise _core.FileError(f"{path}: is not UTF-8 text (byte {error.start})") from None
    starts = [_start(path, number, line) for number, line in enumerate(lines, 1) if line.strip() and not line.startswith("#")]
    if not starts:
        raise _core.FileError(f"{path}: must have the start of a frame in s in each line, has none")
    return starts


def first_start(trace, sequence) -> float:
    """When the first frame begins, in s. trace: table or settings; sequence: table of the frames in time, None: there is one."""
    return trace.start_time if sequence is None or sequence.times is None else float(sequence.times[0])


def _start(path: Path, number: int, line: str) -> float:
    try:
        value = float(line)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        refuse(path, number, f"must be the start of a frame in s, got '{line.strip()[:60]}'")
    return value
