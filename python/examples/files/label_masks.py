"""
Label masks for training
========================

Labels are written as images for programs: a PNG whose pixels are indices, and a JSON file that names them. Here they are
read back as a data loader would.
"""
import json
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from PIL import Image

import echopath as ep

scene = ep.Scene()
scene.add(ep.actors.pedestrian(speed=1.4), name="walker", position=(6, -0.5, 0), yaw=np.pi)
scene.add(ep.actors.wall(20, 4), name="wall", material=ep.Material.metal(mirror=True), position=(8, 2, 0))
chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=128, sampling_rate=10e6, num_chirps=128,
                          chirp_interval=200e-6)
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 1))], receivers=[ep.Antenna((0, 0.01, 1))], transmit_power=1.0)
paths = ep.trace(scene, radar, num_rays=40_000)
parts = {"arms": "T 'walker/arm_*'+ R", "legs": "T 'walker/leg_*'+ R", "body": "T 'walker'+ R", "by the wall": "T .* 'wall' .* R"}
folder = Path(tempfile.mkdtemp())
written = ep.save_label_images(ep.annotate(paths, parts, radar), folder)

# %%
# The part that dominates each cell, 0 where nothing stands out of the noise.
mask = np.asarray(Image.open(folder / "parts.png"))
legend = json.loads((folder / "parts.json").read_text())
columns, rows = (np.array(legend["axes"][axis]["values"]) for axis in ("columns", "rows"))
colours = np.ones((256, 3))
figure, axes = plt.subplots(figsize=(8, 4.5), layout="constrained")
for label in legend["labels"]:
    colours[label["index"]] = [int(label["colour"][k:k + 2], 16) / 255 for k in (1, 3, 5)]
    if np.any(mask == label["index"]):
        axes.plot([], [], "s", color=colours[label["index"]], label=f"{label['name']}: {np.sum(mask == label['index'])} cells")
axes.pcolormesh(columns, rows, colours[mask])
axes.set(xlabel="Range in m", ylabel="Radial velocity in m/s", xlim=(1, 12), ylim=(-4, 2),
         title="parts.png, as a data loader reads it")
axes.legend(loc="upper right")
plt.show()
