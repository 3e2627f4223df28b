"""Changes of an HDF5 file that happen whole or not at all, at the cost of what changes rather than of the file.

New bytes go behind the end of the file, where nothing of what it holds refers to them. The few old ones that HDF5 changes,
such as its table of groups, are kept in memory, then written to a journal beside the file, and last into the file. A process
that is killed before the journal is there leaves the file as it was; one that is killed later leaves a journal that `mend`
carries out.
"""
from __future__ import annotations

import fcntl
import io
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from .. import _core
from ..base.files import flush, written_whole
from ..base.interrupts import heed, interrupts_are_kept
from .h5 import LAYOUT, SPARE_BYTES
from .h5_items import library

PAGE = 4096               # bytes that are kept or written together
END_OF_FILE = 28          # place of the number in the superblock, 8 bytes, of versions 2 and 3 of HDF5's file format
PATIENCE, PAUSE = 60.0, 0.02  # s that a change waits for those who read the file, and between its tries


def work_folder(path) -> Path:
    """The folder beside a file that holds what changes it; it is gone when nobody is at work on the file."""
    path = Path(path)
    return path.with_name(f".{path.name}-begun")


def _journal_of(path) -> Path:
    return work_folder(path) / "journal.npz"


@contextmanager
def changing(path, num_bytes: int = 0) -> Iterator:
    """An HDF5 file open for changes, which it has all of when the block ends well, and else none.

    One process at a time may do that, which has the folder `work_folder(path)` to itself. Who has the file open meanwhile is
    waited for.
    num_bytes: that are about to be written, for which there must be space
    Raises ep.FileError where the disk is full, or where another program keeps the file open.
    """
    h5py = library()
    mend_own(path)
    with interrupts_are_kept(), _failures_of(path):
        handle = os.open(path, os.O_RDWR)
        try:
            os.ftruncate(handle, _end_in(handle))  # behind which a process that was killed may have left something
            draft = _Draft(handle)
            os.posix_fallocate(handle, draft.size, num_bytes + num_bytes // 64 + SPARE_BYTES)
            with h5py.File(draft, "r+", libver=LAYOUT) as file:
                yield file
            heed()
            os.fsync(handle)
            _write_journal(path, draft)
            _carry_out(path, handle)
        finally:
            os.close(handle)


@contextmanager
def _failures_of(path):
    try:
        yield
    except _core.FileError:
        raise
    except OSError as error:
        raise _core.FileError(f"{path}: cannot be changed ({error.strerror or error})") from None


def mend(path) -> None:
    """Carries out what a process that was killed wrote into a journal; does nothing where one is still at work.

    Raises ep.FileError where the file cannot be written.
    """
    if not _journal_of(path).exists():
        return
    with _failures_of(path):
        work = os.open(work_folder(path), os.O_RDONLY)
        try:
            fcntl.flock(work, fcntl.LOCK_EX | fcntl.LOCK_NB)
            mend_own(path)
        except BlockingIOError:  # at work; it keeps readers out while it changes what they read
            return
        finally:
            os.close(work)


def mend_own(path) -> None:
    """As `mend`, for the process that has the `work_folder` to itself."""
    if not _journal_of(path).exists():
        return
    with _failures_of(path):
        handle = os.open(path, os.O_RDWR)
        try:
            _carry_out(path, handle)
        finally:
            os.close(handle)


def _end_in(handle: int) -> int:
    """Where the file ends by what it says itself."""
    return int.from_bytes(os.pread(handle, 8, END_OF_FILE), "little")


def _write_journal(path, draft: _Draft) -> None:
    numbers = sorted(draft.pages)
    pages = np.frombuffer(b"".join(draft.pages[number] for number in numbers), np.uint8).reshape(-1, PAGE)
    with written_whole(_journal_of(path)) as temporary:
        with open(temporary, "wb") as file:
            np.savez(file, number=np.array(numbers, np.int64), page=pages, size=np.int64(draft.size))


def _carry_out(path, handle: int) -> None:
    """Writes the pages of the journal into the file; to do it twice does no harm."""
    with np.load(_journal_of(path)) as journal:
        _wait_for_readers(path, handle)
        for number, page in zip(journal["number"].tolist(), journal["page"]):
            os.pwrite(handle, page.tobytes(), number * PAGE)
        os.ftruncate(handle, int(journal["size"]))
    os.fsync(handle)
    _journal_of(path).unlink()
    flush(work_folder(path))
    fcntl.flock(handle, fcntl.LOCK_UN)


def _wait_for_readers(path, handle: int) -> None:
    """Takes the lock that HDF5 takes, too: for itself, where its readers share it."""
    last_try = time.monotonic() + PATIENCE
    while True:
        try:
            return fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            if time.monotonic() > last_try:
                raise _core.FileError(f"{path}: cannot be changed, another program keeps it open") from None
            heed()
            time.sleep(PAUSE)


class _Draft(io.RawIOBase):
    """A file as it will be, for h5py. What is written behind its end is written; what changes before it is kept in `pages`.

    pages: {number: bytearray of PAGE bytes}; size: bytes of the file as it will be
    """

    def __init__(self, handle: int):
        self.size, self.pages = os.fstat(handle).st_size, {}
        self._handle, self._at, self._fence = handle, 0, -(-self.size // PAGE) * PAGE

    def readable(self) -> bool:
        return True

    def writable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        self._at = offset + {os.SEEK_SET: 0, os.SEEK_CUR: self._at, os.SEEK_END: self.size}[whence]
        return self._at

    def tell(self) -> int:
        return self._at

    def truncate(self, size: int | None = None) -> int:
        self.size = self._at if size is None else size
        return self.size

    def readinto(self, buffer) -> int:
        view = memoryview(buffer).cast("B")
        begin, end = self._at, self._at + len(view)
        held = os.pread(self._handle, len(view), begin)
        view[:len(held)], view[len(held):] = held, bytes(len(view) - len(held))
        for number in self._pages_between(begin, end):
            if number in self.pages:
                low, high = max(begin, number * PAGE), min(end, (number + 1) * PAGE)
                view[low - begin:high - begin] = self.pages[number][low - number * PAGE:high - number * PAGE]
        self._at = end
        return len(view)

    def write(self, data) -> int:
        view = memoryview(data).cast("B")
        begin, end = self._at, self._at + len(view)
        for number in self._pages_between(begin, end):
            low, high = max(begin, number * PAGE), min(end, (number + 1) * PAGE)
            self._page(number)[low - number * PAGE:high - number * PAGE] = view[low - begin:high - begin]
        at = max(begin, self._fence)
        while at < end:
            at += os.pwrite(self._handle, view[at - begin:], at)
        self._at, self.size = end, max(self.size, end)
        return len(view)

    def _pages_between(self, begin: int, end: int) -> range:
        """The numbers of the old pages that bytes lie in."""
        return range(begin // PAGE, -(-min(end, self._fence) // PAGE)) if begin < self._fence else range(0)

    def _page(self, number: int) -> bytearray:
        if number not in self.pages:
            held = os.pread(self._handle, PAGE, number * PAGE)
            self.pages[number] = bytearray(held) + bytes(PAGE - len(held))
        return self.pages[number]
