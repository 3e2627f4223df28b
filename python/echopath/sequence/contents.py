"""Of which sequence frames are, in an HDF5 file beside or about them (layout: data/README.md)."""
from __future__ import annotations

import json
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .. import _core
from ..arguments.shown import shown
from ..frame_file.container import SEQUENCE, our_file, write_head
from ..frame_file.h5 import blames_group, read_array, read_attribute, read_group, write_array
from ..frame_file.radar import read_radar, write_radar
from ..frame_file.scene import read_scene, write_scene
from ..frame_file.scene.interferers import read_interferers, write_interferers
from ..frame_file.settings import write_setting
from ..scene.scene import Scene

SETTINGS = "settings"       # group of those of a sequence
FRAMES = "frames"           # group of the frames in a file of all
TIMES = "times"             # the setting of the starts that were given, in s: a dataset, as there may be a million
_GROWS = {"frames", TIMES}  # the settings in which two runs into one place may differ: the later one has more of the same
_APART = {SETTINGS, FRAMES}  # items that are compared in another way, or not at all


class Contents(NamedTuple):
    """scene, radar: of the frames; settings: {name: value}, as JSON has them."""

    scene: _core.Scene
    radar: _core.Radar
    settings: dict[str, Any]


def write_contents(file, contents: Contents) -> None:
    """Writes them to a new file."""
    write_head(file, SEQUENCE)
    write_scene(file.create_group("scene"), contents.scene)
    write_radar(file.create_group("radar"), contents.radar)
    write_interferers(file, contents.scene)
    _write_settings(file.create_group(SETTINGS), contents.settings)


def _write_settings(group, settings: dict[str, Any]) -> None:
    for name, value in settings.items():
        if name == TIMES and value is not None:
            write_array(group, TIMES, np.array(value, np.float64))
        else:
            write_setting(group, name, value)


def read_contents(path) -> Contents:
    """What `write_contents` wrote to a file. Raises ep.FileError."""
    with our_file(path, SEQUENCE) as file:
        scene = Scene(read_scene(read_group(file, "scene")), interferers=read_interferers(file))
        return Contents(scene, read_radar(read_group(file, "radar")), read_settings(file))


def settings_of(path) -> dict[str, Any]:
    """The settings alone that `write_contents` wrote to a file, without its scene. Raises ep.FileError."""
    with our_file(path, SEQUENCE) as file:
        return read_settings(file)


def read_settings(file) -> dict[str, Any]:
    """{keyword: value} of a file of contents."""
    return _read_settings(read_group(file, SETTINGS))


@blames_group
def _read_settings(group) -> dict[str, Any]:
    settings = {name: json.loads(read_attribute(group, name, str)) for name in group.attrs}
    return settings | {TIMES: read_array(group, TIMES, np.float64, (None,)).tolist()} if TIMES in group else settings


def what_differs(mine: Path, theirs: Path) -> str:
    """What two files of contents do not share, in words; "" where a run of the first may go on in the place of the second."""
    with our_file(mine, SEQUENCE) as ours:
        try:  # within: what is wrong with theirs is nothing of mine
            with our_file(theirs, SEQUENCE) as there:
                return _other_setting(ours, there) or _other_item(ours, there)
        except _core.FileError as error:
            return f"{error}; move what is there away, or give another path"


def _other_setting(ours, theirs) -> str:
    mine, there = read_settings(ours), read_settings(theirs)
    for name in sorted(mine.keys() | there.keys()):
        here, before = mine.get(name), there.get(name)
        if here != before and not (name in _GROWS and _goes_on(here, before)):
            return f"{name} is {shown(before)} there and {shown(here)} here"
    return ""


def _goes_on(here, before) -> bool:
    """Whether a setting has more of the same: a larger number, or further times."""
    if isinstance(here, list) and isinstance(before, list):
        return here[:len(before)] == before
    return isinstance(here, int) and isinstance(before, int) and here >= before


def _other_item(ours, theirs, name: str = "") -> str:
    """The first item or attribute that two groups do not share, names first."""
    for attribute in sorted(set(ours.attrs) | set(theirs.attrs)):
        if not np.array_equal(ours.attrs.get(attribute), theirs.attrs.get(attribute)):
            return f"{name} {attribute} differs".strip()
    for key in sorted((set(ours) | set(theirs)) - _APART, key=lambda key: (key != "name", key)):
        place = f"{name}/{key}".lstrip("/")
        if key not in ours or key not in theirs:
            return f"{place} differs"
        if hasattr(ours[key], "keys"):
            if found := _other_item(ours[key], theirs[key], place):
                return found
        elif not np.array_equal(ours[key][()], theirs[key][()]):
            return f"{place} differs"
    return ""
