"""Scene files of a radar and what is tested."""
from __future__ import annotations

import re

import pytest

import echopath as ep
from support.files.scene_text import WAVEFORM

RADAR = WAVEFORM + """\
[[radar.transmitters]]
position = [0.0, 0.0, 1.0]
[[radar.receivers]]
position = [0.0, 0.01, 1.0]
"""
QUAD = "v 0 0 0\nv 1000 0 0\nv 1000 500 0\nv 0 500 0\nf 1 2 3 4\n"


def mesh_object(text: str) -> str:
    return f'[[objects]]\nname = "quad"\nmesh = "quad.obj"\n{text}\n'


def fault_of(path) -> str:
    with pytest.raises(ValueError) as fault:
        ep.load_scene(path)
    return str(fault.value)


def without_line(fault: str) -> str:
    """What is said of a scene file, without the line in it."""
    return re.sub(r": line \d+: ", ": ", fault, count=1)
