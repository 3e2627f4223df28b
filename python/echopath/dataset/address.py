"""Folders of datasets at addresses of fsspec, such as s3://bucket/folder: the same files as in a folder."""
from __future__ import annotations

import hashlib
import re
import tempfile
import uuid
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from .. import _core
from ..arguments.checks import refused
from ..base.process.libraries import needed_module
from ..scene_file.load import parse
from .folder import (
    MANIFEST,
    RECORD,
    SCENES,
    TEMPLATE,
    SceneRecord,
    manifest_text,
    record_of,
    record_text,
    scene_name,
    takes_over,
    without_template,
)
from .template import Template

_TRIES = 3                                     # of moving a file
_LEFT = re.compile(r"\..+-[0-9a-f]{32}")       # name of a file that is about to be moved


def is_address(folder: str) -> bool:
    """Whether a folder is an address, such as s3://bucket/folder or file:///disk/folder."""
    return "://" in folder


class Address:
    """The folder of a dataset at an address. Raises ModuleNotFoundError without fsspec, ValueError naming `folder` for one of an
    unknown kind."""

    def __init__(self, address: str):
        try:
            self._files, self._root = needed_module("fsspec.core", "an address as folder", extra="cluster").url_to_fs(address)
        except (ValueError, ImportError) as error:
            if isinstance(error, ModuleNotFoundError) and error.name == "fsspec":
                raise
            raise refused(ValueError, "folder", f"a folder, or an address that fsspec knows ({error})", address) from None
        self.address = address

    def put(self, name: str, content: bytes) -> None:
        """Writes a file under another name and moves it, so that one cut short is never read. Raises ep.FileError."""
        path = f"{self._root}/{name}"
        folder, _, last = path.rpartition("/")
        temporary = f"{folder}/.{last}-{uuid.uuid4().hex}"
        with self._told(name, "written"):
            self._files.makedirs(folder, exist_ok=True)
            for left in reversed(range(_TRIES)):
                self._files.pipe_file(temporary, content)
                try:
                    self._files.mv(temporary, path)
                    return
                except FileNotFoundError:  # another call took it for one that was left
                    if not left:
                        raise

    def get(self, name: str) -> bytes:
        """The content of a file, nothing where it is not there. Raises ep.FileError where that cannot be told."""
        with self._told(name, "read"):
            try:
                content: bytes = self._files.cat_file(f"{self._root}/{name}")
                return content
            except FileNotFoundError:
                return b""

    def tidy(self, scene: int) -> None:
        """Removes the files of a scene that a call which was killed was about to move. Raises ep.FileError."""
        name = scene_name(scene)
        for path in self._listed(name):
            if _LEFT.fullmatch(path.rpartition("/")[2]):
                with self._told(name, "written"), suppress(FileNotFoundError):
                    self._files.rm_file(path)

    def record(self, scene: int) -> SceneRecord:
        """What is written of a scene; to do where a file of it is not as it was written."""
        record = record_of(self.get(f"{scene_name(scene)}/{RECORD}"))
        for name, digest in record.files.items():
            if hashlib.sha256(self.get(f"{scene_name(scene)}/{name}")).hexdigest() != digest:
                return SceneRecord("to do")
        if record.state == "done":
            self.tidy(scene)
        return record

    def prepare(self, template: Template) -> None:
        """As `prepare_folder`. Raises as it."""
        theirs = self._table()
        if theirs is None and self._has_scenes():
            raise without_template(self.address)
        if takes_over(theirs, template, self.address):
            self.put(TEMPLATE, template.path.read_text(encoding="utf-8-sig").encode())

    def forget(self, scenes: list[int]) -> None:
        """Makes scenes that failed to do again."""
        for scene in scenes:
            self.put(f"{scene_name(scene)}/{RECORD}", record_text(SceneRecord("to do")).encode())

    def write_manifest(self, template: Template) -> None:
        """As the function of that name does in a folder."""
        self.put(MANIFEST, manifest_text(template, lambda scene: record_of(self.get(f"{scene_name(scene)}/{RECORD}"))).encode())

    def _has_scenes(self) -> bool:
        path = f"{self._root}/{SCENES}"
        return any(one.rstrip("/") != path for one in self._listed(SCENES))

    def _listed(self, name: str) -> list[str]:
        """The paths in a folder, none where it is not there. Raises ep.FileError."""
        with self._told(name, "read"):
            try:
                self._files.invalidate_cache()  # others write there, too
                return [str(one) for one in self._files.ls(f"{self._root}/{name}", detail=False)]
            except FileNotFoundError:
                return []

    @contextmanager
    def _told(self, name: str, done: str) -> Iterator[None]:
        """Raises ep.FileError naming a file where the block raises what libraries of addresses raise: anything."""
        try:
            yield
        except Exception as error:
            raise _core.FileError(f"{self.address}/{name}: cannot be {done} ({error})") from None

    def _table(self) -> dict[str, Any] | None:
        if not (content := self.get(TEMPLATE)):
            return None
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / TEMPLATE
            path.write_bytes(content)
            return dict(parse(path))
