"""Scenes and radars in pickles: the bytes of a file with the groups that a frame file has of them, one home of their state."""
from __future__ import annotations

import copyreg
import tempfile
from pathlib import Path

from .. import _core
from ..scene import Scene
from .h5 import reading, writing
from .radar import read_radar, write_radar
from .scene import read_scene, write_scene


def _packed(write, value) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        with writing(Path(folder) / "state.h5") as file:
            write(file, value)
        return (Path(folder) / "state.h5").read_bytes()


def _unpacked(read, state: bytes):
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "state.h5").write_bytes(state)
        with reading(Path(folder) / "state.h5") as file:
            return read(file)


def _scene_of(state: bytes):
    return _unpacked(read_scene, state)


def _radar_of(state: bytes):
    return _unpacked(read_radar, state)


def _reduced_scene(scene) -> tuple:
    return _scene_of, (_packed(write_scene, scene),)


def _reduced_radar(radar) -> tuple:
    return _radar_of, (_packed(write_radar, radar),)


for _kind in (_core.Scene, Scene):
    copyreg.pickle(_kind, _reduced_scene)
copyreg.pickle(_core.Radar, _reduced_radar)
