"""
A scene file
============

Whole experiments are text files: radar, objects, settings and parts. The command line runs them (``echopath run SCENE.toml
--out DIR``), and so does a script. Here one is written, loaded and run.
"""
import tempfile
from pathlib import Path

import echopath as ep
from echopath import plots

text = """
title = "A corner reflector beside a wall"

[radar]
transmit_power = 0.05
pattern = {kind = "cosine_power", exponent = 2.0}
transmitters = [{position = [0.0, 0.0, 1.0]}]
receivers = [{position = [0.0, 0.01, 1.0]}]

[radar.waveform]
start_frequency = 77e9
bandwidth = 1e9
num_samples = 256
sampling_rate = 20e6
num_chirps = 128
chirp_interval = 60e-6

[[objects]]
name = "ball"
actor = "sphere"
parameters = {radius = 0.3}
material = {conductor = true, scattering = 0.9}
smooth = true
position = [10.0, 0.0, 1.0]
motion = {kind = "linear", velocity = [-5.0, 0.0, 0.0]}

[[objects]]
name = "wall"
actor = "wall"
parameters = {length = 30.0, height = 4.0}
material = {base = "concrete", mirror = true}
position = [12.0, 3.0, 0.0]

[trace]
num_rays = 20_000

[parts]
"straight" = "T 'ball' R"
"by the wall" = "T .* 'wall' .* R"
"""
path = Path(tempfile.mkdtemp()) / "scene.toml"
path.write_text(text)

# %%
# The settings of the file are the keywords of ``simulate``.
file = ep.load_scene(path)
print(file.title)
frame = ep.simulate(file.scene, file.radar, parts=file.parts, guard=False, trace=file.trace, signal=file.signal)
figure = plots.plot_overview(frame.spectrum, {name: one for name, one in frame.part_spectra["parts"].items() if name != "other"},
                             title="All that is received", parts_title="Without noise, by part")
plots.show(figure)
