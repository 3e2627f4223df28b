"""Of which sequence frames are, in an HDF5 file beside or about them (layout: data/README.md)."""
from __future__ import annotations

import json
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .. import _core
from ..arguments.shown import shown
from ..frame_file.container import SEQUENCE, our_file, write_head
from ..frame_file.h5 import blames_group, read_attribute, read_group
from ..frame_file.radar import read_radar, write_radar
from ..frame_file.scene import read_scene, write_scene
from ..frame_file.scene.interferers import read_interferers, write_interferers
from ..frame_file.settings import write_setting
from ..scene.scene import Scene

FRAMES = "frames"           # group of the frames in a file of all
_GROWS = "frames"           # the one setting in which two runs into one place may differ
_APART = {"settings", FRAMES}  # items that are compared in another way, or not at all


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
    write_settings(file.create_group("settings"), contents.settings)


def write_settings(group, settings: dict[str, Any]) -> None:
    """Writes settings in place of those that a group has."""
    for name, value in settings.items():
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
    return _read_settings(read_group(file, "settings"))


@blames_group
def _read_settings(group) -> dict[str, Any]:
    return {name: json.loads(read_attribute(group, name, str)) for name in group.attrs}


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
        grows = name == _GROWS and mine[name] >= there.get(name, 0)
        if mine.get(name) != there.get(name) and not grows:
            return f"{name} is {shown(there.get(name))} there and {shown(mine.get(name))} here"
    return ""


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
