"""Frames of a sequence in a folder, a file each, and beside them sequence.h5."""
from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import AbstractContextManager
from pathlib import Path
from tempfile import TemporaryDirectory

from .. import _core
from ..arguments.checks import refused
from ..arguments.folder_kinds import folder_hint
from ..base.storage.files import require_writable, written_whole
from ..frame.frame import Frame
from ..frame_file.h5 import writing
from ..frame_file.opening import is_cut_off
from .contents import Contents, read_contents, what_differs, write_contents
from .folder_lock import writing_to
from .keep import Keep, write_frame

NAME = "sequence.h5"


def frame_path(folder: Path, place: int) -> Path:
    """The file of the frame at a place."""
    return folder / f"frame_{place:04d}.h5"


def differs_from(contents: Contents, kept: bytes) -> str:
    """What a sequence and the one of a file sequence.h5 of this content do not share, in words; "" where they are the same."""
    with TemporaryDirectory(prefix="echopath-") as folder:
        mine, theirs = Path(folder) / NAME, Path(folder) / f"kept_{NAME}"
        theirs.write_bytes(kept)
        with writing(mine) as file:
            write_contents(file, contents)
        return what_differs(mine, theirs)


class FolderStore:
    """A folder that frames are written to, by one process or by several that make shards of them, and read from."""

    def __init__(self, path: Path):
        self.path = path

    @property
    def head(self) -> Path:
        """The file that says of which sequence the frames are."""
        return self.path / NAME

    def frame_path(self, place: int) -> Path:
        """The file of the frame at a place."""
        return frame_path(self.path, place)

    def are_there(self, places: Iterable[int]) -> list[bool]:
        """Whether there is a frame at each of some places."""
        return [self.is_there(place) for place in places]

    def is_there(self, place: int) -> bool:
        """Whether there is a frame at a place."""
        return self.frame_path(place).exists()

    def are_whole(self, places: Iterable[int]) -> list[bool]:
        """Whether there is a frame at each of some places whose file is as long as it was written."""
        return [path.is_file() and not is_cut_off(path) for path in map(self.frame_path, places)]

    def contents(self) -> Contents:
        """Of which sequence it is. Raises ep.FileError."""
        if self.path.is_file():
            raise _core.FileError(f"{self.path}: must be a folder of frames, or one file of them (.h5), got another file")
        if self.path.is_dir() and not self.head.exists():
            raise _core.FileError(f"{self.head}: no such file{folder_hint(self.path)}")
        return read_contents(self.head)

    def writing(self, contents: Contents, is_shared: bool) -> AbstractContextManager[None]:
        """Keeps others from writing to it during the block, but for shards where it is shared.

        Raises ValueError naming the path where it holds another sequence or another process writes to it, ep.FileError.
        """
        require_writable(self.path, "path")
        self.path.mkdir(parents=True, exist_ok=True)
        return writing_to(self.path, is_shared, self._preparing(contents))

    def write(self, frame: Frame, place: int, keep: Keep) -> None:
        """Writes the frame at a place, whole or not at all. Raises ep.FileError."""
        write_frame(frame, self.frame_path(place), keep)

    def _preparing(self, contents: Contents) -> Callable[[bool], None]:
        def prepare(is_alone: bool) -> None:
            self._write_contents(contents)
            if is_alone:
                self._remove_leftovers()

        return prepare

    def _write_contents(self, contents: Contents) -> None:
        """A sequence of more frames than the folder had takes the folder over."""
        path = self.head
        with written_whole(path) as temporary:
            with writing(temporary) as file:
                write_contents(file, contents)
            differs = what_differs(temporary, path) if path.exists() else self._frames_of_nothing()
            if differs:
                raise refused(ValueError, "path", f"new, or of this sequence ({differs})", str(self.path))

    def _frames_of_nothing(self) -> str:
        found = next(self.path.glob("frame_[0-9]*.h5"), None)
        return f"it has {found.name} and no {NAME}" if found else ""

    def _remove_leftovers(self) -> None:
        """Removes the temporary files of a process that was killed."""
        for name in (".frame_*-*.h5", ".sequence-*.h5"):
            for leftover in self.path.glob(name):
                leftover.unlink(missing_ok=True)
