"""Frames of a sequence in one HDF5 file, which grows by a frame at a time (layout: data/README.md)."""
from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from ..arguments.checks import refused
from ..base.storage.files import flush, require_writable, written_whole
from ..frame.frame import Frame
from ..frame_file.changing import changing, mend_own, work_folder
from ..frame_file.container import SEQUENCE, our_file
from ..frame_file.h5 import copy_items, read_group, writing
from ..frame_file.opening import SUFFIXES, reading
from .contents import FRAMES, SETTINGS, Contents, read_contents, read_settings, what_differs, write_contents
from .folder import NAME, FolderStore
from .folder_lock import writing_to
from .keep import Keep, write_frame

_FRAME, _CONTENTS = "frame.h5", "contents.h5"  # in the work folder: written whole, then moved into the file


class FileStore:
    """A file that one process writes frames to, and from which any number read them; as FolderStore."""

    def __init__(self, path: Path):
        self.path = path

    @property
    def head(self) -> Path:
        """The file that says of which sequence the frames are."""
        return self.path

    def frame_path(self, place: int) -> Path:
        """The group of the frame at a place, named as if it lay below the file: readers of frame files take it."""
        return self.path / FRAMES / _name(place)

    def are_there(self, places: Iterable[int]) -> list[bool]:
        """Whether there is a frame at each of some places."""
        if not self.path.exists():
            return [False for _ in places]
        with our_file(self.path, SEQUENCE) as file:
            names = set(read_group(file, FRAMES))
        return [_name(place) in names for place in places]

    def is_there(self, place: int) -> bool:
        """Whether there is a frame at a place; takes no longer the more others there are."""
        if not self.path.exists():
            return False
        with our_file(self.path, SEQUENCE) as file:
            return _name(place) in read_group(file, FRAMES)

    def are_whole(self, places: Iterable[int]) -> list[bool]:
        """As `are_there`: a file that has lost its end cannot be opened at all."""
        return self.are_there(places)

    def contents(self) -> Contents:
        """Of which sequence it is. Raises ep.FileError."""
        return read_contents(self.path)

    @contextmanager
    def writing(self, contents: Contents, is_shared: bool) -> Iterator[None]:
        """Keeps others from writing to it during the block.

        Raises ValueError naming the argument for shards, where it holds another sequence or another process writes to it,
        ep.FileError.
        """
        if is_shared:
            raise refused(ValueError, "shard", "None for one file, which one process writes (a folder takes shards)",
                          str(self.path))
        work = work_folder(self.path)
        require_writable(work.parent, "path")
        with writing_to(work, False, lambda is_alone: None, of=self.path):
            try:
                flush(work.parent)  # a power cut must not take the folder with the journal away
                self._prepare(contents, work)
                yield
            finally:
                _remove_leftovers(work)
                with suppress(OSError):  # a journal that could not be carried out stays
                    work.rmdir()

    def write(self, frame: Frame, place: int, keep: Keep) -> None:
        """Writes the frame at a place, whole or not at all. Raises ep.FileError."""
        whole = work_folder(self.path) / _FRAME
        write_frame(frame, whole, keep)
        with changing(self.path, whole.stat().st_size) as target, reading(whole) as source:
            frames = target[FRAMES]
            if _name(place) in frames:  # damaged, or of another time
                del frames[_name(place)]
            copy_items(source, frames.create_group(_name(place)))
        whole.unlink()

    def _prepare(self, contents: Contents, work: Path) -> None:
        mend_own(self.path)
        _remove_leftovers(work)
        mine = work / _CONTENTS
        with written_whole(mine) as temporary, writing(temporary) as file:
            write_contents(file, contents)
            file.create_group(FRAMES)
        if not self.path.exists():
            mine.rename(os.path.realpath(self.path))  # a link stays one
            flush(work.parent)
            return
        if differs := what_differs(mine, self.path):
            raise refused(ValueError, "path", f"new, or of this sequence ({differs})", str(self.path))
        with our_file(mine, SEQUENCE) as ours, our_file(self.path, SEQUENCE) as there:
            grows = read_settings(ours) != read_settings(there)
        if grows:
            with changing(self.path, mine.stat().st_size) as file, reading(mine) as source:
                del file[SETTINGS]
                copy_items(source[SETTINGS], file.create_group(SETTINGS))


Store = FolderStore | FileStore


def store_of(path) -> Store:
    """Where a path keeps frames: one file where it ends in .h5 or .hdf5 and no folder has that name, else a folder.

    The file sequence.h5 of a folder stands for the folder.
    """
    path = Path(path)
    if path.name == NAME:
        return FolderStore(path.parent)
    return FileStore(path) if path.suffix.lower() in SUFFIXES and not path.is_dir() else FolderStore(path)


def _name(place: int) -> str:
    return f"{place:06d}"


def _remove_leftovers(work: Path) -> None:
    """Removes what a process that was killed had not finished, but for its journal."""
    for leftover in (*work.glob("*.h5"), *work.glob(".*")):
        leftover.unlink(missing_ok=True)
