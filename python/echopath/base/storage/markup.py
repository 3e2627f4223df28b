"""Files in XML, read element by element."""
from __future__ import annotations

import gzip
import zlib
from collections.abc import Mapping
from pathlib import Path
from xml.parsers import expat

from ... import _core
from .lines import MAX_BYTES, refuse

MAX_DEPTH = 64          # of nested elements
PACKED = ".gz"          # suffix behind that of the file, as SUMO writes large ones


def attribute(path: Path, line: int, tag: str, attributes: Mapping[str, str], name: str) -> str:
    """That of a name, which must be there. Raises FileError."""
    if name not in attributes:
        refuse(path, line, f"<{tag}>: {name} is missing")
    return attributes[name]


class _Bounded:
    """A file for a parser, no longer than MAX_BYTES once it is unpacked. Raises FileError."""

    def __init__(self, path: Path, file):
        self._path, self._file, self._read = path, file, 0

    def read(self, size: int) -> bytes:
        content = self._file.read(size)
        self._read += len(content)
        if self._read > MAX_BYTES:
            raise _core.FileError(f"{self._path}: is larger than {MAX_BYTES} bytes")
        return content


def parse(path: Path, begin, end=None, text=None, comment=None) -> None:
    """Calls begin(tag, attributes, line), end(tag, line), text(words) and comment(words, line) for the content of an XML file
    without entities. Raises FileError naming the file, and the line."""
    parser = expat.ParserCreate()
    depth = [0]

    def on_begin(tag, attributes):
        depth[0] += 1
        if depth[0] > MAX_DEPTH:
            refuse(path, parser.CurrentLineNumber, f"more than {MAX_DEPTH} elements within each other")
        begin(tag, attributes, parser.CurrentLineNumber)

    def on_end(tag):
        depth[0] -= 1
        if end:
            end(tag, parser.CurrentLineNumber)

    def refuse_types(*_):
        refuse(path, parser.CurrentLineNumber, "a document type, which may expand without end, is refused")

    parser.StartElementHandler, parser.EndElementHandler = on_begin, on_end
    parser.StartDoctypeDeclHandler = refuse_types
    if comment:
        parser.CommentHandler = lambda words: comment(words, parser.CurrentLineNumber)
    if text:
        parser.CharacterDataHandler = text
    try:
        if path.stat().st_size > MAX_BYTES:
            raise _core.FileError(f"{path}: is larger than {MAX_BYTES} bytes")
        with gzip.open(path) if path.suffix.lower() == PACKED else open(path, "rb") as file:
            parser.ParseFile(_Bounded(path, file))
    except expat.ExpatError as error:
        reason = expat.errors.messages[error.code] if error.code in expat.errors.messages else str(error)
        raise _core.FileError(f"{path}, line {error.lineno}: is no XML ({reason})") from None
    except (OSError, EOFError, zlib.error) as error:
        if isinstance(error, _core.FileError):
            raise
        raise _core.FileError(f"{path}: cannot be read ({getattr(error, 'strerror', None) or error})") from None
    except (LookupError, ValueError) as error:  # an encoding that is not known
        raise _core.FileError(f"{path}: is no XML ({error})") from None
