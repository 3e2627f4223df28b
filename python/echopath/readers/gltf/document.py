"""The container of a glTF file: its JSON, its buffers, and how much memory it may ask for."""
from __future__ import annotations

import base64
import binascii
import json
import os
import posixpath
import urllib.parse
from collections.abc import Callable
from pathlib import Path
from typing import Any

from ... import _core
from .item import Item

MAGIC, JSON_CHUNK, BINARY_CHUNK = b"glTF", b"JSON", b"BIN\0"
MOST_BYTES = 2**28   # that any file may ask for; larger ones may ask for MOST_GROWTH times their size
MOST_GROWTH = 64


class Document:
    """A glTF file: `json`, an Item, its `buffers` and their bytes. What it says of itself is not trusted.

    path: of the file; note: takes a sentence about what was left out or mended
    """

    def __init__(self, path: Path, note: Callable[[str], None]):
        self.path, self.file, self.note = path, str(path), note
        content = _bytes_of(path, self.file)
        self.binary: bytes | None = None
        self.json = Item(self._parsed(content), self.file)
        if not isinstance(self.json.value, dict):
            self.json.must_be("a JSON object")
        _check_version(self.json["asset"])
        self.buffers = self.json["buffers"].objects()
        self._size = len(content)
        self._spent = 0
        self._buffers: dict[int, bytes] = {}

    def spend(self, num_bytes: int, item: Item) -> None:
        """Counts memory; raises FileError where a small file asks for much."""
        self._spent += num_bytes
        most = MOST_BYTES + MOST_GROWTH * self._size
        if self._spent > most:
            item.fail(f"needs more than {most >> 20} MiB of memory, too much for a file of {self._size} bytes")

    def buffer(self, index: int) -> bytes:
        """The bytes of a buffer, as many as it says."""
        if index not in self._buffers:
            item = self.buffers[index]
            length = item["byteLength"].whole(1, 2**53)
            content = self._content_of(item, index, length)
            if len(content) < length:
                item["byteLength"].fail(f"is {length}, but there are {len(content)} bytes")
            self._buffers[index] = content
        return self._buffers[index]

    def _content_of(self, item: Item, index: int, length: int) -> bytes:
        uri = item["uri"].text(None)
        if uri is None:
            if index != 0 or self.binary is None:
                item.fail("has no uri, and there is no binary chunk for it")
            return self.binary
        if uri[:5].lower() == "data:":
            return _decoded(uri, item["uri"])
        path = self._path_beside(uri, item["uri"])
        return _bytes_of(path, self.file, f"{item['uri'].place}: ", length)

    def _path_beside(self, uri: str, item: Item) -> Path:
        """Of a file in the folder of this one or below it, as its name says: links there may lead anywhere, as those of stores of
        large files do."""
        name = urllib.parse.unquote(uri)
        leads_out = posixpath.normpath(name).split("/")[0] in ("..", "")
        if leads_out or "\0" in name or urllib.parse.urlsplit(uri[:16]).scheme:
            item.must_be("the name of a file in the folder of this one")
        return self.path.parent / name

    def _parsed(self, content: bytes) -> Any:
        if content[:4] == MAGIC:
            content = self._unpacked(content)
        try:
            return json.loads(content.decode("utf-8-sig"), parse_constant=_refuse_constant)
        except UnicodeDecodeError as error:
            self._fail(f"is no glTF: its JSON is not UTF-8 text (byte {error.start})")
        except RecursionError:
            self._fail("has JSON that is nested too deeply")
        except ValueError as error:
            self._fail(f"is no glTF: begins with {bytes(content[:16])!r}; as JSON: {error}")

    def _unpacked(self, content: bytes) -> bytes:
        """The JSON of a GLB; keeps its binary chunk."""
        if len(content) < 12:
            self._fail("is cut off within its head")
        version, length = _number(content, 4), _number(content, 8)
        if version != 2:
            self._fail(f"is a GLB of version {version}; only version 2 is read")
        if length > len(content):
            self._fail(f"is cut off: should have {length} bytes, has {len(content)}")
        chunks = list(self._chunks(content[:length]))
        if not chunks or chunks[0][0] != JSON_CHUNK:
            self._fail("must begin with a chunk of JSON")
        if len(chunks) > 1 and chunks[1][0] == BINARY_CHUNK:
            self.binary = chunks[1][1]
        return chunks[0][1]

    def _chunks(self, content: bytes):
        at = 12
        while at + 8 <= len(content):
            size, kind = _number(content, at), content[at + 4:at + 8]
            if at + 8 + size > len(content):
                self._fail(f"is cut off: the chunk at byte {at} should have {size} bytes, has {len(content) - at - 8}")
            yield kind, content[at + 8:at + 8 + size]
            at += 8 + size

    def _fail(self, what: str):
        raise _core.FileError(f"{self.file}: {what}") from None


def _number(content: bytes, at: int) -> int:
    return int.from_bytes(content[at:at + 4], "little")


def _refuse_constant(word: str):
    raise ValueError(f"{word} is no number of JSON")


def _bytes_of(path: Path, file: str, place: str = "", most: int = -1) -> bytes:
    """The first bytes of a file, all of them without `most`."""
    if not os.path.isfile(path):  # of any name
        raise _core.FileError(f"{file}: {place}{path.name} is no file that is there")
    try:
        with path.open("rb") as stream:
            return stream.read(min(most, path.stat().st_size) if most >= 0 else -1)
    except (OSError, ValueError) as error:
        raise _core.FileError(f"{file}: {place}cannot be read ({getattr(error, 'strerror', None) or error})") from None


def _decoded(uri: str, item: Item) -> bytes:
    """The bytes of a data: URI."""
    head, comma, text = uri.partition(",")
    if not comma:
        item.fail("must be a data: URI with a comma before the data")
    try:
        if head.lower().endswith(";base64"):
            return base64.b64decode(urllib.parse.unquote(text), validate=True)
        return urllib.parse.unquote_to_bytes(text)
    except (binascii.Error, ValueError) as error:
        item.fail(f"holds no base64 ({error})")


def _check_version(asset: Item) -> None:
    for key in ("version", "minVersion"):
        version = asset[key].text("2.0" if key == "minVersion" else None)
        if version is None or version.partition(".")[0] != "2" or (key == "minVersion" and version != "2.0"):
            asset[key].fail(f"must be 2.0, is {version!r}"[:100] + "; only glTF 2.0 is read")
