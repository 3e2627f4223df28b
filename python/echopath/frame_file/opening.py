"""HDF5 files that are opened to be read, while others may be changing them."""
from __future__ import annotations

import os
import time
from contextlib import contextmanager
from pathlib import Path
from shlex import quote

from .. import _core
from ..base.process.interrupts import interrupts_are_kept
from ..base.storage.files import require_readable
from .changing import end_in, has_journal, mend
from .h5 import FAULTS, first_line, read_group
from .h5_items import library

SUFFIXES = (".h5", ".hdf5")
PATIENCE, PAUSE = 5.0, 0.005  # s that a reader waits for who changes the file, which takes milliseconds, and between its tries


def file_and_group(path) -> tuple[Path, str]:
    """The file of a path and what of it is meant: a group is named as if it lay below the file, drive.h5/frames/000012."""
    path = Path(path)
    if not path.exists():
        for file in path.parents:
            if file.is_file():
                return file, path.relative_to(file).as_posix()
    return path, ""


def is_cut_off(path: Path) -> bool:
    """Whether a file of ours has lost its end, as on a disk that was full or pulled out: by what its head says of its length.

    A look at its first bytes, for thousands of files in a second; what else may be damaged is found by who reads the file.
    """
    with open(path, "rb") as file:
        end = end_in(file.fileno())
        return end is None or os.fstat(file.fileno()).st_size < end


@contextmanager
def reading(path):
    """Opens an HDF5 file, or a group of one (`file_and_group`), which is what it yields.

    Whatever is wrong with it becomes an ep.FileError that names the file and the reason.
    """
    place, group = file_and_group(path)
    require_readable(place)
    try:
        with interrupts_are_kept(), _opened(place) as file:
            yield read_group(file, group) if group else file
    except _core.FileError as error:
        raise _core.FileError(f"{path}: {error}") from error
    except FileNotFoundError:
        raise _core.FileError(f"{path}: no such file") from None
    except FAULTS as error:
        if Path(path).suffix.lower() == ".toml":
            raise _core.FileError(f"{path}: a scene file, where a frame file (.h5) is asked for; `echopath run "
                                  f"{quote(str(path))} --out DIR` makes DIR/frame.h5 of it") from None
        if place.is_file() and place.suffix.lower() not in SUFFIXES:
            from ..readers.load import READERS

            way = (f"; `echopath scene {quote(str(path))} --out SCENE.toml` makes a scene file of a model, and `echopath run "
                   "SCENE.toml --out DIR` the frame of that" if place.suffix.lower() in READERS else "")
            raise _core.FileError(f"{path}: not a frame file (.h5){way}") from None
        if place.is_dir():
            raise _core.FileError(f"{path}: a folder, where a frame file (.h5) is asked for, as those in it may be") from None
        raise _core.FileError(f"{path}: damaged or not an HDF5 file ({first_line(error)})") from error


def _opened(path):
    """The file, as soon as nobody changes it, with all of a change that a process was killed in.

    A journal is written by who has locked the file: one that is not there when the file is open does not come.
    """
    h5py, last_try = library(), time.monotonic() + PATIENCE
    while True:
        mend(path)
        try:
            file = h5py.File(path, "r")
            if not has_journal(path):
                return file
            file.close()
            raise BlockingIOError("another program is changing it")
        except BlockingIOError:
            if time.monotonic() > last_try:
                raise
            time.sleep(PAUSE)
