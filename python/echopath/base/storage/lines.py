"""Files of lines: how long they may be, and how a fault in a line is told."""
from __future__ import annotations

from pathlib import Path
from typing import NoReturn

from ... import _core

MAX_BYTES = 2**31


def refuse(path: Path, line: int, what: str) -> NoReturn:
    """Raises FileError naming the file and the line."""
    raise _core.FileError(f"{path}, line {line}: {what}")
