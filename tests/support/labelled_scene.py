"""A scene file whose frames have labels."""
from __future__ import annotations

from support.files.scene_text import WAVEFORM, moving_plate

SCENE = """
title = "a person behind a van, beside a wall"
""" + WAVEFORM + """\
[radar]
transmit_power = 10.0
[[radar.transmitters]]
position = [0.0, 0.0, 1.0]
[[radar.receivers]]
position = [0.0, 0.01, 1.0]
[[radar.receivers]]
position = [0.0, 0.012, 1.0]
""" + moving_plate("van", 2.0, 2.0, 6.0, -2.0) + moving_plate("person", 0.3, 1.0, 8.0, -1.0) + """
[[objects]]
name = "wall"
actor = "wall"
parameters = {length = 30.0, height = 6.0}
position = [10.0, 4.0, 0.0]
material = {base = "concrete", mirror = true}
[trace]
num_rays = 3000
batches = 2
[parts.by]
"the van" = "T 'van' R"
"over the wall" = "T .* 'wall' .* R"
[parts.power]
strong = "power > 1e-14"
"""
DETECTIONS = "[detections]\nmethod = 'os'\nfalse_alarm_rate = 1e-3\ntraining_velocity = 0\n"
LABELS = "[labels]\nobjects = {truck = 'van', person = ['person', 'pers*']}\nerrors = true\nnoise_margin_db = 6.0\n"
