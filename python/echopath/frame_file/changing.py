"""Changes of an HDF5 file that happen whole or not at all, at the cost of what changes rather than of the file.

New bytes go behind the end of the file, where nothing of what it holds refers to them. The few old ones that HDF5 changes,
such as its table of groups, are kept in memory, then written to a journal beside the file, and last into the file. A process
that is killed before the journal is there leaves the file as it was; one that is killed later leaves a journal that `mend`
carries out, whoever opens the file next.
"""
from __future__ import annotations

import errno
import fcntl
import io
import os
import time
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tokenize import TokenError

import numpy as np

from .. import _core
from ..base.process.interrupts import heed, interrupts_are_kept
from ..base.storage.files import flush, written_whole
from ..base.storage.locks import is_at, takes
from .h5 import LAYOUT, SPARE_BYTES
from .h5_items import library

PAGE = 4096               # bytes that are kept or written together
END_OF_FILE = 28          # place of the number in the superblock, 8 bytes, of versions 2 and 3 of HDF5's file format
PATIENCE, PAUSE = 60.0, 0.02  # s that a change waits for those who read the file, and between its tries


def work_folder(path) -> Path:
    """The folder beside a file that holds what changes it; it is gone when nobody is at work on the file.

    All links to a file share that of the file itself.
    """
    path = Path(os.path.realpath(path))
    return path.with_name(f".{path.name}-begun")


def _journal_of(path) -> Path:
    return work_folder(path) / "journal.npz"


def has_journal(path) -> bool:
    """Whether there are changes of a file that are not all in it."""
    return os.path.exists(_journal_of(path))


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
            end = end_in(handle)
            if end is None:
                raise OSError(errno.EINVAL, "not in the layout of HDF5 1.10 that this program writes")
            with _cut_back(path, handle, end):
                os.ftruncate(handle, end)  # behind which a process that was killed may have left something
                draft = _Draft(handle)
                os.posix_fallocate(handle, draft.size, num_bytes + num_bytes // 64 + SPARE_BYTES)
                with h5py.File(draft, "r+", libver=LAYOUT) as file:
                    yield file
                heed()
                os.ftruncate(handle, max(end, draft.size))  # what is old stays until the journal is there
                os.fsync(handle)
                _wait_for_readers(handle)  # before the journal: it must not stay where they do
                _write_journal(path, draft, handle)
            _carry_out(path, handle)
        finally:
            os.close(handle)


@contextmanager
def _cut_back(path, handle: int, end: int):
    """Takes away what a block that fails wrote behind the end of a file, so that a full disk does not stay full."""
    try:
        yield
    except BaseException:
        _journal_of(path).unlink(missing_ok=True)
        os.ftruncate(handle, end)
        raise


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

    Raises ep.FileError, whose text does not name the file, where it cannot be written.
    """
    if not has_journal(path):
        return
    try:
        work = os.open(work_folder(path), os.O_RDONLY)
        try:
            if takes(work, fcntl.LOCK_EX) and is_at(work, work_folder(path)):
                _mend(path)  # else one is at work, who keeps readers out while it changes what they read
        finally:
            os.close(work)
    except FileNotFoundError:  # another has done it meanwhile
        return
    except OSError as error:
        raise _core.FileError(f"has changes of a run that was killed, in {_journal_of(path)}, which cannot be carried out "
                              f"({error.strerror or error})") from None


def mend_own(path) -> None:
    """As `mend`, for the process that has the `work_folder` to itself. The errors name the file."""
    if has_journal(path):
        with _failures_of(path):
            _mend(path)


def _mend(path) -> None:
    try:
        handle = os.open(path, os.O_RDWR)
    except FileNotFoundError:
        return _drop_journal(path)
    try:
        _wait_for_readers(handle)
        if has_journal(path):
            _carry_out(path, handle)
    finally:
        os.close(handle)


def end_in(handle: int) -> int | None:
    """Where the file ends by what it says itself; None: it is of another layout."""
    return _end_of(os.pread(handle, END_OF_FILE + 8, 0))


def _end_of(head: bytes) -> int | None:
    """The end of a file by its first bytes."""
    is_known = head[:8] == b"\x89HDF\r\n\x1a\n" and head[8:9] in (b"\x02", b"\x03") and head[9:10] == b"\x08"
    starts_at_0, end = head[12:20] == bytes(8), head[END_OF_FILE:END_OF_FILE + 8]
    return int.from_bytes(end, "little") if is_known and starts_at_0 and len(end) == 8 else None


def _write_journal(path, draft: _Draft, handle: int) -> None:
    """Writes the pages that change, and of which file they are: its inode, size, and where it ends before and behind that.

    The device is not told: it may have another number when the system starts again.
    """
    numbers = sorted(draft.pages)
    pages = np.frombuffer(b"".join(draft.pages[number] for number in numbers), np.uint8).reshape(-1, PAGE)
    before = end_in(handle)
    ends = [before, _end_of(draft.pages[0]) if 0 in draft.pages else before]
    with written_whole(_journal_of(path)) as temporary:
        with open(temporary, "wb") as file:
            np.savez(file, number=np.array(numbers, np.int64), page=pages, size=np.int64(draft.size),
                     inode=np.uint64(os.fstat(handle).st_ino), ends=np.array(ends, np.int64))


def _read_journal(path) -> dict[str, np.ndarray]:
    try:
        with np.load(_journal_of(path)) as journal:
            return {name: journal[name] for name in ("number", "page", "size", "inode", "ends")}
    except (ValueError, KeyError, EOFError, SyntaxError, NotImplementedError, zipfile.BadZipFile, zlib.error, TokenError):
        raise OSError(errno.EINVAL, f"{_journal_of(path)} is damaged") from None


def _carry_out(path, handle: int) -> None:
    """Writes the pages of the journal into its file, which is locked; to do it twice does no harm.

    A journal of another file, in whose place this one was put, is dropped.
    """
    journal = _read_journal(path)
    if _is_of(journal, handle):
        for number, page in zip(journal["number"].tolist(), journal["page"]):
            os.pwrite(handle, page.tobytes(), number * PAGE)
        os.ftruncate(handle, int(journal["size"]))
        os.fsync(handle)
    _drop_journal(path)


def _is_of(journal: dict[str, np.ndarray], handle: int) -> bool:
    found, size, ends = os.fstat(handle), int(journal["size"]), journal["ends"].tolist()
    return found.st_ino == int(journal["inode"]) and found.st_size in (size, max(size, ends[0])) and end_in(handle) in ends


def _drop_journal(path) -> None:
    _journal_of(path).unlink()
    flush(work_folder(path))


def _wait_for_readers(handle: int) -> None:
    """Takes the lock that HDF5 takes, too: for itself, where its readers share it."""
    last_try = time.monotonic() + PATIENCE
    while not takes(handle, fcntl.LOCK_EX):
        if time.monotonic() > last_try:
            raise OSError(errno.EBUSY, "another program keeps it open")
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
