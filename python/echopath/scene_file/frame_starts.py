"""Starts of the frames in time of a scene file, from a text file that it names."""
from __future__ import annotations

import math
from pathlib import Path

from .. import _core

MAX_BYTES = 64 << 20  # of a file: 64 characters for each frame of the longest sequence


def read_starts(path: Path) -> list[float]:
    """The numbers of a text file, one in a line, in s; lines that are empty or begin with # count for nothing.

    Raises ep.FileError naming the file, the line, the rule and the value.
    """
    try:
        if path.stat().st_size > MAX_BYTES:
            raise _core.FileError(f"{path}: is larger than {MAX_BYTES} bytes")
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except UnicodeDecodeError as error:
        raise _core.FileError(f"{path}: is not UTF-8 text (byte {error.start})") from None
    except OSError as error:
        if isinstance(error, _core.FileError):
            raise
        raise _core.FileError(f"{path}: cannot be read ({error.strerror})") from None
    starts = [_start(path, number, line) for number, line in enumerate(lines, 1) if line.strip() and not line.startswith("#")]
    if not starts:
        raise _core.FileError(f"{path}: must have the start of a frame in s in each line, has none")
    return starts


def _start(path: Path, number: int, line: str) -> float:
    try:
        value = float(line)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise _core.FileError(f"{path}: line {number}: must be the start of a frame in s, got '{line.strip()[:60]}'")
    return value
