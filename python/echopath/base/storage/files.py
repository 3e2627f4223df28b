"""Files that are written whole or not at all."""
from __future__ import annotations

import os
import secrets
import shutil
import tempfile
from contextlib import contextmanager, suppress
from pathlib import Path

from ... import _core
from ..process.interrupts import heed, interrupts_are_kept


def require_readable(path) -> None:
    """Raises ep.FileError for a device, and for a pipe that has a name, at which a reader may wait without end.

    A pipe that the shell makes has none, but a writer: `echopath run <(...)` reads it. What is not there is told by who reads.
    """
    if _is_device_or_pipe(path) and os.path.exists(os.path.realpath(path)):
        raise _core.FileError(f"{path}: is no regular file")


def bytes_of(path: Path) -> bytes:
    """The whole content of a file. Raises ep.FileError where it cannot be read, and as `require_readable`."""
    require_readable(path)
    try:
        return path.read_bytes()
    except OSError as error:
        raise _core.FileError(f"{path}: cannot be read ({error.strerror})") from None


def named_file(folder: Path, name: str) -> Path:
    """The file that a file in a folder names, relative to it: with backslashes, as programs of Windows write paths, also where
    folders are told apart by slashes alone."""
    as_named, with_slashes = folder / name, folder / name.replace("\\", "/")
    return with_slashes if os.path.exists(with_slashes) and not os.path.exists(as_named) else as_named


def _is_device_or_pipe(path) -> bool:
    return os.path.exists(path) and not os.path.isfile(path) and not os.path.isdir(path)


@contextmanager
def written_whole(path, suffix: str | None = None):
    """Yields the path of a temporary file beside `path` that takes its place when the block ends well. A link stays one: the file
    that it names is written.

    Whatever ends the block early, Ctrl-C too, the temporary file is removed and `path` is left as it was. Only what ends the
    process at once leaves it there.
    suffix: of the temporary file, None: that of `path`
    Raises ep.FileError when the folder or the file cannot be written, and where `path` is a device or a pipe, whose place no
    file may take.
    """
    with interrupts_are_kept():
        yield from _written(Path(path), suffix)


def _written(path: Path, suffix: str | None):
    if _is_device_or_pipe(path):  # nothing but folders refuses to be replaced
        raise _core.FileError(f"{path}: cannot be written (a device or a pipe, not a file)")
    ending = path.suffix if suffix is None else suffix
    place = Path(os.path.realpath(path)) if path.is_symlink() else path
    temporary = place.parent / f".{place.stem}-{secrets.token_hex(8)}{ending}"  # named before it is there: Ctrl-C may come
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
        temporary.touch(exist_ok=False)
        yield temporary
        heed()
        flush(temporary)
        os.replace(temporary, place)
        flush(place.parent)
    except OSError as error:
        where = "" if place == path else f"a link to {place}: "
        raise _core.FileError(f"{path}: cannot be written ({where}{error.strerror or error})") from None
    finally:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)


@contextmanager
def folder_written_whole(path):
    """Yields the path of a new folder beside `path` that takes its name when the block ends well; until then `path` is not there.

    Whatever ends the block early, the new folder is removed; one that a process left which was ended at once is removed by the
    next for the same `path`. Two processes must not write the same one at a time.
    Raises ep.FileError when folders cannot be written.
    """
    path = Path(path)
    begun = path.with_name(f".{path.name}-begun")
    try:
        if begun.exists():
            shutil.rmtree(begun)
        begun.mkdir(parents=True)
        yield begun
        os.replace(begun, path)
        flush(path.parent)
    except _core.FileError:  # of a file in it, or of one that is read
        raise
    except OSError as error:
        raise _core.FileError(f"{path}: cannot be written ({error.strerror or error})") from None
    finally:
        shutil.rmtree(begun, ignore_errors=True)


def require_writable(folder, argument: str) -> None:
    """Raises ep.FileError naming `argument` unless files can be written into `folder`: before long work whose end they are.

    folder: need not exist yet. It is tried in a folder of its own within the nearest one that exists, which is removed again,
    so that processes that begin at once do not take theirs away from each other.
    """
    folder = Path(folder).absolute()
    there = next(one for one in (folder, *folder.parents) if os.path.lexists(one))
    try:
        if there == folder:
            tempfile.TemporaryFile(dir=folder).close()
            return
        with tempfile.TemporaryDirectory(dir=there) as trial:
            (Path(trial) / folder.relative_to(there)).mkdir(parents=True)
    except (OSError, ValueError) as error:  # ValueError: NUL in the name
        reason = getattr(error, "strerror", None) or error
        raise _core.FileError(f"{argument}: must be a folder that can be written, got {str(folder)!r} ({reason})") from None


def write_texts(folder, texts: dict) -> None:
    """Writes files {name: text} into `folder`, each whole or not at all. Raises ep.FileError."""
    for name, text in texts.items():
        with written_whole(Path(folder) / name) as temporary:
            temporary.write_text(text, encoding="utf-8")


def file_state(path) -> tuple | None:
    """What tells contents of a file from those before: (time of the last change in ns, bytes, inode); None where there is none.

    path: name or number of an open file
    """
    try:
        found = os.stat(path)
    except (OSError, TypeError):
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino


def flush(path) -> None:
    """Down to the disk, so that a power cut after the replacement cannot leave an empty file."""
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
