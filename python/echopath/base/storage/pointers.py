"""Files that stand for others."""
from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ... import _core
from .files import require_readable

LFS = b"version https://git-lfs"


@contextmanager
def pointers_are_told(path: str | os.PathLike[str]) -> Iterator[None]:
    """Says of a file that cannot be read that it is a pointer, where it is one: what is wrong with its content tells nothing.

    Raises ep.FileError before, for what is no file (`require_readable`).
    """
    require_readable(path)
    try:
        yield
    except _core.FileError:
        if _begins_as_pointer(Path(os.fsdecode(path))):
            raise _core.FileError(f"{path}: is a pointer of Git LFS, not the file itself (git lfs pull brings it)") from None
        raise


def _begins_as_pointer(path: Path) -> bool:
    try:
        if not path.is_file():  # a pipe would be waited for
            return False
        with path.open("rb") as file:
            return file.read(len(LFS)) == LFS
    except (OSError, ValueError):
        return False
