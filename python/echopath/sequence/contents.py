"""The file sequence.h5 of a folder: of which sequence the frames beside it are (layout: data/README.md)."""
from __future__ import annotations

import json
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .. import _core
from ..arguments.checks import refused
from ..arguments.shown import shown
from ..base.files import written_whole
from ..frame_file.container import our_file, write_head
from ..frame_file.h5 import blames_group, read_attribute, read_group, write_attribute, writing
from ..frame_file.radar import read_radar, write_radar
from ..frame_file.scene import read_scene, write_scene
from ..frame_file.scene.interferers import read_interferers, write_interferers
from ..scene.scene import Scene

KIND, NAME = "sequence", "sequence.h5"
_GROWS = "frames"  # the one setting in which two runs into one folder may differ


class Contents(NamedTuple):
    """scene, radar: of the frames; settings: {name: value}, as JSON has them."""

    scene: _core.Scene
    radar: _core.Radar
    settings: dict[str, Any]


def frame_path(folder: Path, place: int) -> Path:
    """The file of the frame at a place."""
    return folder / f"frame_{place:04d}.h5"


def write_contents(folder: Path, contents: Contents) -> None:
    """Writes the file, or makes sure that the one there tells of the same sequence.

    A sequence of more frames than the folder had takes the folder over. Raises ValueError naming the folder for another
    sequence, ep.FileError.
    """
    path = folder / NAME
    with written_whole(path) as temporary:
        with writing(temporary) as file:
            write_head(file, KIND)
            write_scene(file.create_group("scene"), contents.scene)
            write_radar(file.create_group("radar"), contents.radar)
            write_interferers(file, contents.scene)
            group = file.create_group("settings")
            for name, value in contents.settings.items():
                write_attribute(group, name, json.dumps(value, default=_plain))
        differs = _what_differs(temporary, path) if path.exists() else _frames_of_nothing(folder)
        if differs:
            raise refused(ValueError, "folder", f"new, or of this sequence ({differs})", str(folder))


def read_contents(folder: Path) -> Contents:
    """What `write_contents` wrote. Raises ep.FileError."""
    with our_file(folder / NAME, KIND) as file:
        scene = Scene(read_scene(read_group(file, "scene")), interferers=read_interferers(file))
        return Contents(scene, read_radar(read_group(file, "radar")), _read_settings(read_group(file, "settings")))


@blames_group
def _read_settings(group) -> dict[str, Any]:
    return {name: json.loads(read_attribute(group, name, str)) for name in group.attrs}


def _plain(value) -> Any:
    """What JSON does not know: arrays and NumPy's numbers, selections."""
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else str(value)


def _frames_of_nothing(folder: Path) -> str:
    found = next(folder.glob("frame_[0-9]*.h5"), None)
    return f"it has {found.name} and no {NAME}" if found else ""


def _what_differs(mine: Path, theirs: Path) -> str:
    """What two files of contents do not share, in words; "" where a run of the first may go on in the folder of the second."""
    try:
        with our_file(mine, KIND) as ours, our_file(theirs, KIND) as there:
            return _other_setting(ours, there) or _other_item(ours, there)
    except _core.FileError as error:
        return str(error)


def _other_setting(ours, theirs) -> str:
    mine, there = (_read_settings(read_group(file, "settings")) for file in (ours, theirs))
    for name in sorted(mine.keys() | there.keys()):
        grows = name == _GROWS and mine[name] >= there.get(name, 0)
        if mine.get(name) != there.get(name) and not grows:
            return f"{name} is {shown(there.get(name))} there and {shown(mine.get(name))} here"
    return ""


def _other_item(ours, theirs, name: str = "") -> str:
    """The first item or attribute that two groups do not share, names first."""
    for attribute in sorted(set(ours.attrs) | set(theirs.attrs)):
        if not np.array_equal(ours.attrs.get(attribute), theirs.attrs.get(attribute)):
            return f"{name} {attribute} differs".strip()
    for key in sorted((set(ours) | set(theirs)) - {"settings"}, key=lambda key: (key != "name", key)):
        place = f"{name}/{key}".lstrip("/")
        if key not in ours or key not in theirs:
            return f"{place} differs"
        if hasattr(ours[key], "keys"):
            if found := _other_item(ours[key], theirs[key], place):
                return found
        elif not np.array_equal(ours[key][()], theirs[key][()]):
            return f"{place} differs"
    return ""
