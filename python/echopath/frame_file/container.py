"""HDF5 files of ours: written whole or not at all, with a format and a version that are checked when they are read."""
from __future__ import annotations

from contextlib import contextmanager
from pathlib import Path

from .. import _core
from ..arguments.folder_kinds import folder_hint
from ..base.storage.files import written_whole
from .h5 import read_attribute, write_attribute, writing
from .opening import reading

SCHEMA_VERSION = 4  # grows when a reader of the old layout would misread the new one
KINDS = FRAME, SEQUENCE = "frame", "sequence"
_OTHER_KIND = {FRAME: "is a single frame, not a sequence: ep.load_frame reads it",
               SEQUENCE: "is a sequence, not a single frame: ep.load_sequence reads its frames"}
OLD_LAYOUT = "; files before version 4 have no check sums on texts, settings and small arrays: simulate again"
NEW_LAYOUT = "; a later release of echopath wrote it, and reads it"


@contextmanager
def new_file(path):
    """A new HDF5 file of a frame that takes its place when the block ends well."""
    with written_whole(path) as temporary, writing(temporary) as file:
        write_head(file, FRAME)
        yield file


def write_head(file, kind: str) -> None:
    """Writes what tells our files apart: their kind, one of KINDS, version and program."""
    write_attribute(file, "format", f"echopath {kind}")
    write_attribute(file, "schema_version", SCHEMA_VERSION)
    write_attribute(file, "software_version", _core.__version__)


@contextmanager
def our_file(path, kind: str = FRAME):
    """A file of a kind open for reading, its format and version checked."""
    with reading(path) as file:
        if "format" not in file.attrs or "schema_version" not in file.attrs:
            raise _core.FileError(f"is an HDF5 file, but no {kind} file of echopath")
        version = read_attribute(file, "schema_version", int)
        if version != SCHEMA_VERSION:
            raise _core.FileError(f"has schema version {version}, this program reads {SCHEMA_VERSION}"
                                  f"{OLD_LAYOUT if version < SCHEMA_VERSION else NEW_LAYOUT}")
        found = read_attribute(file, "format", str).removeprefix("echopath ")
        if found != kind:
            beside = folder_hint(Path(path).parent) if found == FRAME else ""
            raise _core.FileError(_OTHER_KIND.get(found, f"is an HDF5 file, but no {kind} file of echopath")
                                  + (f"; '{path}/frames/000000' is its first frame" if "frames" in file else "")
                                  + beside)
        yield file


def kind_of(path) -> str | None:
    """Which kind of file of ours a file is, or a group in it; None: none that can be read."""
    for kind in KINDS:
        try:
            with our_file(path, kind):
                return kind
        except _core.FileError:
            continue
    return None


def has_paths(path) -> bool:
    """Whether a frame file holds the paths of its frame, as small files of a sequence do not. Raises ep.FileError."""
    with our_file(path) as file:
        return _has_paths(file)


def has_maps(path) -> bool:
    """Whether a file without paths is the frame of a sequence; else it holds labels alone. Raises ep.FileError."""
    with our_file(path) as file:
        return "maps" in file


def _has_paths(file) -> bool:
    return "record" in file or file.keys().isdisjoint(("maps", "labels"))


@contextmanager
def file_with_paths(path):
    """A frame file open for reading that holds the paths of its frame. Raises ep.FileError for others."""
    with our_file(path) as file:
        if not _has_paths(file):
            raise _core.FileError("holds no paths, only maps or labels of a frame: ep.load_labels reads its labels, "
                                  "ep.load_sequence all frames of its run")
        yield file
