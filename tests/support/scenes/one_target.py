"""A scene of one object, and a radar in the words of a scene file."""
from __future__ import annotations

import echopath as ep
from support.files.scene_text import WAVEFORM

RADAR_FILE = WAVEFORM + """\
[[radar.transmitters]]
position = [0.0, 0.0, 0.0]
[[radar.receivers]]
position = [0.0, 0.0, 0.0]
"""


def scene_with(content, **keywords):
    """Its object is "target"; keywords: of Scene.add."""
    scene = ep.Scene()
    scene.add(content, name="target", **keywords)
    return scene
