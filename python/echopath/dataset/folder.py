"""The folder of a dataset: one folder for each scene, with a record of what is done (layout: data/README.md)."""

import hashlib
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal, NamedTuple, get_args

from .. import _core
from ..arguments.checks import refused
from ..arguments.folder_kinds import folder_hint
from ..arguments.shown import shown
from ..base.storage.files import write_texts
from ..base.text.counts import counted
from ..scene_file.load import parse
from .template import Template

State = Literal["done", "failed", "to do"]

TEMPLATE, MANIFEST, RECORD, DRAWN = "dataset.toml", "manifest.json", "record.json", "drawn.json"
ORIGIN = "origin.json"  # where the template is that dataset.toml is a copy of
SCENES = "scenes"  # folder of the folders of scenes
_BLOCK = 1 << 20  # bytes that are hashed at a time


class SceneRecord(NamedTuple):
    """What a dataset has of a scene.

    state: "done", "failed" or "to do"; files: {name: SHA-256 in hexadecimal digits} of all files of a scene that is done
    reason: in words, why it failed
    """

    state: State
    files: dict[str, str] = {}
    reason: str = ""

    def __repr__(self) -> str:
        told = self.reason or (counted(len(self.files), "file") if self.files else "")
        return f"SceneRecord({self.state}{told and ': '}{told})"


def scene_name(scene: int) -> str:
    """The name of the folder of a scene, in that of the dataset."""
    return f"{SCENES}/{scene:06d}"


def scene_folder(folder: Path, scene: int) -> Path:
    """The folder of a scene."""
    return folder / scene_name(scene)


def read_record(folder: Path, scene: int) -> SceneRecord:
    """What is written of a scene; nothing, or nothing that can be read: to do."""
    try:
        return record_of((scene_folder(folder, scene) / RECORD).read_bytes())
    except OSError:
        return SceneRecord("to do")


def record_of(content: bytes) -> SceneRecord:
    """What the content of a record says; nothing that can be read: to do."""
    try:
        table = json.loads(content)
        state, files, reason = table["state"], table.get("files", {}), table.get("reason", "")
    except (ValueError, KeyError, TypeError, RecursionError):
        return SceneRecord("to do")
    is_sound = state in get_args(State) and isinstance(files, dict) and all(isinstance(digest, str) for digest in files.values())
    return SceneRecord(state, files, str(reason)) if is_sound else SceneRecord("to do")


def record_text(record: SceneRecord) -> str:
    """The content of the file of a record."""
    return json.dumps({name: value for name, value in record._asdict().items() if value}, indent=1) + "\n"


def write_record(folder: Path, scene: int, record: SceneRecord) -> None:
    """Writes the record of a scene, whole or not at all. Raises ep.FileError."""
    write_texts(scene_folder(folder, scene), {RECORD: record_text(record)})


def damaged_files(folder: Path, scene: int, record: SceneRecord) -> list[Path]:
    """The files of a scene that are there, but not as they were written; those that are missing too."""
    paths = {scene_folder(folder, scene) / name: digest for name, digest in record.files.items()}
    return [path for path, digest in paths.items() if checksum(path) != digest]


def checksum(path: Path) -> str:
    """SHA-256 of a file in hexadecimal digits, "" of one that cannot be read."""
    digest = hashlib.sha256()
    try:
        with path.open("rb") as file:
            while block := file.read(_BLOCK):
                digest.update(block)
    except (OSError, ValueError):  # ValueError: NUL in the name
        return ""
    return digest.hexdigest()


def read_or_nothing(path: Path) -> bytes:
    """The content of a file, nothing of one that cannot be read."""
    try:
        return path.read_bytes()
    except OSError:
        return b""


def prepare_folder(folder: Path, template: Template) -> None:
    """Makes the folder of a template, or makes sure that it is of this one; a template of more scenes takes it over.

    Raises ValueError naming `folder` where it is of another template, ep.FileError.
    """
    kept = folder / TEMPLATE
    theirs = parse(kept) if kept.exists() else None
    if theirs is None and any(folder.glob(f"{SCENES}/*")):
        raise without_template(str(folder))
    is_new = takes_over(theirs, template, str(folder))
    if is_new:
        write_texts(folder, {TEMPLATE: template.path.read_text(encoding="utf-8-sig")})
    if (is_new or not (folder / ORIGIN).exists()) and template.path.resolve() != kept.resolve():
        write_texts(folder, {ORIGIN: json.dumps({"template": absolute(template.path).as_posix()}) + "\n"})


def absolute(path: Path) -> Path:
    """Of a template, from wherever it is seen; a link stays one, since files that a template names are beside that."""
    return path.parent.resolve() / path.name


def _folder_of_files(folder: Path) -> Path:
    """Where the template of a dataset was when it was made, and with it the files that it names; the dataset's own without it."""
    try:
        origin = Path(json.loads(read_or_nothing(folder / ORIGIN))["template"]).parent
    except (ValueError, KeyError, TypeError):
        return folder
    return origin if origin.is_dir() else folder


def without_template(folder: str) -> Exception:
    """The ValueError of a folder that has scenes, and nobody knows of which template."""
    return refused(ValueError, "folder", f"new, or of this template (it has scenes and no {TEMPLATE})", folder)


def takes_over(theirs: dict[str, Any] | None, template: Template, folder: str) -> bool:
    """Whether a template is to be written to a folder: there is none, or one with fewer scenes. theirs: table of what is there

    Raises ValueError naming `folder` where it is of another template.
    """
    if theirs is None:
        return True
    if differing := _what_differs(theirs, template.table):
        raise refused(ValueError, "folder", f"new, or of this template ({differing})", folder)
    return bool(theirs.get("dataset", {}).get("scenes") != template.settings.scenes)


def write_manifest(folder: Path, template: Template) -> None:
    """Writes manifest.json: what is done, with checksums, what failed and why, what is to do."""
    write_texts(folder, {MANIFEST: manifest_text(template, lambda scene: read_record(folder, scene))})


def manifest_text(template: Template, record_at: Callable[[int], SceneRecord]) -> str:
    """The content of manifest.json; record_at: what is written of a scene by its number."""
    counts: dict[str, int] = {"done": 0, "failed": 0, "to do": 0}
    scenes: dict[str, Any] = {}
    for scene in range(template.settings.scenes):
        record = record_at(scene)
        counts[record.state] += 1
        entry = {name: value for name, value in record._asdict().items() if value}
        scenes[f"{scene:06d}"] = {"split": template.split_of(scene)} | entry
    return json.dumps({"count": counts, "scenes": scenes}, indent=1) + "\n"


def open_template(folder: Path) -> Template:
    """The template of a dataset. Raises ep.FileError naming the folder where there is none."""
    path = folder / TEMPLATE
    if not path.exists():
        lacks = f"it has no {TEMPLATE}{folder_hint(folder)}" if folder.exists() else "there is no such folder"
        raise _core.FileError(f"{folder}: is no dataset, {lacks}")
    return Template(path, _folder_of_files(folder))


def _what_differs(theirs: dict[str, Any], ours: dict[str, Any]) -> str:
    """What two templates do not share, in words; "" where the second is the first with as many scenes or more."""
    mine, there = dict(ours), dict(theirs)
    own, other = dict(mine.pop("dataset", {})), dict(there.pop("dataset", {}))
    scenes, before = own.pop("scenes", 0), other.pop("scenes", 0)
    if scenes < before:
        return f"it has {counted(before, 'scene')}"
    for name in sorted(mine.keys() | there.keys()):
        if difference := _first_difference(name, there.get(name), mine.get(name)):
            return difference
    return _first_difference("dataset", other, own)


def _first_difference(path: str, theirs: Any, ours: Any) -> str:
    """The first dotted path at which two values differ and what is there, in words; "" where they are alike."""
    if theirs == ours:
        return ""
    if isinstance(theirs, dict) and isinstance(ours, dict):
        pairs = [(f"{path}.{name}", theirs.get(name), ours.get(name)) for name in sorted(theirs.keys() | ours.keys())]
    elif isinstance(theirs, list) and isinstance(ours, list) and len(theirs) == len(ours):
        pairs = [(_entry(path, number, one), one, our) for number, (one, our) in enumerate(zip(theirs, ours))]
    elif theirs is None:
        return f"{path} is not given there"
    elif _is_tables(theirs):
        return f"{path} has {counted(len(theirs), 'table')} there"
    else:
        return f"{path} is {shown(theirs)} there"
    return next(words for pair in pairs if (words := _first_difference(*pair)))


def _entry(path: str, number: int, value: Any) -> str:
    """Path of an entry of a list: by its name where it has one, as that of what is drawn."""
    name = value.get("name") if isinstance(value, dict) else None
    return f"{path}.{name}" if isinstance(name, str) else f"{path}[{number}]"


def _is_tables(value: Any) -> bool:
    return isinstance(value, list) and any(isinstance(one, dict) for one in value)
