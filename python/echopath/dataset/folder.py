"""The folder of a dataset: one folder for each scene, with a record of what is done (layout: data/README.md)."""
from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any, Literal, NamedTuple

from .. import _core
from ..checks import refused
from ..files import write_texts
from ..scene_file.load import parse
from ..shown import shown
from .template import Template

State = Literal["done", "failed", "to do"]

TEMPLATE, MANIFEST, RECORD, DRAWN = "dataset.toml", "manifest.json", "record.json", "drawn.json"
_BLOCK = 1 << 20  # bytes that are hashed at a time


class SceneRecord(NamedTuple):
    """What a dataset has of a scene.

    state: "done", "failed" or "to do"; files: {name: SHA-256 in hexadecimal digits} of all files of a scene that is done
    reason: in words, why it failed
    """

    state: State
    files: dict[str, str] = {}
    reason: str = ""


def scene_folder(folder: Path, scene: int) -> Path:
    """The folder of a scene."""
    return folder / "scenes" / f"{scene:06d}"


def read_record(folder: Path, scene: int) -> SceneRecord:
    """What is written of a scene; nothing, or nothing that can be read: to do."""
    try:
        table = json.loads((scene_folder(folder, scene) / RECORD).read_bytes())
        return SceneRecord(table["state"], dict(table.get("files", {})), str(table.get("reason", "")))
    except (OSError, ValueError, KeyError, TypeError):
        return SceneRecord("to do")


def write_record(folder: Path, scene: int, record: SceneRecord) -> None:
    """Writes the record of a scene, whole or not at all. Raises ep.FileError."""
    kept = {name: value for name, value in record._asdict().items() if value}
    write_texts(scene_folder(folder, scene), {RECORD: json.dumps(kept, indent=1) + "\n"})


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
    except OSError:
        return ""
    return digest.hexdigest()


def prepare_folder(folder: Path, template: Template) -> None:
    """Makes the folder of a template, or makes sure that it is of this one; a template of more scenes takes it over.

    Raises ValueError naming `folder` where it is of another template, ep.FileError.
    """
    kept = folder / TEMPLATE
    if kept.exists():
        theirs = parse(kept)
        if differing := _what_differs(theirs, template.table):
            raise refused(ValueError, "folder", f"new, or of this template ({differing})", str(folder))
        if theirs.get("dataset", {}).get("scenes") == template.settings.scenes:
            return
    elif any(folder.glob("scenes/*")):
        raise refused(ValueError, "folder", f"new, or of this template (it has scenes and no {TEMPLATE})", str(folder))
    write_texts(folder, {TEMPLATE: template.path.read_text(encoding="utf-8-sig")})


def write_manifest(folder: Path, template: Template) -> dict[str, int]:
    """Writes manifest.json: what is done, with checksums, what failed and why, what is to do. Returns {state: scenes}."""
    counts: dict[str, int] = {"done": 0, "failed": 0, "to do": 0}
    scenes: dict[str, Any] = {}
    for scene in range(template.settings.scenes):
        record = read_record(folder, scene)
        counts[record.state] += 1
        entry = {name: value for name, value in record._asdict().items() if value}
        scenes[f"{scene:06d}"] = {"split": template.split_of(scene)} | entry
    write_texts(folder, {MANIFEST: json.dumps({"count": counts, "scenes": scenes}, indent=1) + "\n"})
    return counts


def open_template(folder: Path) -> Template:
    """The template of a dataset. Raises ep.FileError naming the folder where there is none."""
    path = folder / TEMPLATE
    if not path.exists():
        raise _core.FileError(f"{folder}: is no dataset, it has no {TEMPLATE}")
    return Template(path)


def _what_differs(theirs: dict[str, Any], ours: dict[str, Any]) -> str:
    """What two templates do not share, in words; "" where the second is the first with as many scenes or more."""
    mine, there = dict(ours), dict(theirs)
    own, other = dict(mine.pop("dataset", {})), dict(there.pop("dataset", {}))
    scenes, before = own.pop("scenes", 0), other.pop("scenes", 0)
    if scenes < before:
        return f"it has {before} scenes"
    for name in sorted(mine.keys() | there.keys()):
        if mine.get(name) != there.get(name):
            return f"[{name}] differs"
    for name in sorted(own.keys() | other.keys()):
        if own.get(name) != other.get(name):
            return f"dataset.{name} is {shown(other.get(name))} there"
    return ""
