"""
An animated rig of a glTF file
==============================

An arm of two bones waves at the radar. Its file is written by hand here; rigs of Blender are read alike. The skin falls into
regions by the joint that moves them most: upper arm and forearm, each with the speed that the animation gives it.
"""
import json
import tempfile
from base64 import b64encode
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

bone, period = 0.35, 2.0                              # m, s
around, height = np.linspace(0, 2 * np.pi, 24, endpoint=False), np.linspace(0, 2 * bone, 29)
vertices = np.array([[0.05 * np.cos(a), y, 0.05 * np.sin(a)] for y in height for a in around])
corner = np.arange(28 * 24).reshape(28, 24)
right = np.roll(corner, -1, axis=1)
triangles = np.stack([corner, corner + 24, right, right, corner + 24, right + 24], axis=-1)
share = np.clip((vertices[:, 1] - 0.9 * bone) / (0.2 * bone), 0, 1)   # of the forearm, which takes over at the elbow
times = np.linspace(0, period, 33)
half = np.radians(30) * np.sin(2 * np.pi * times / period)            # of the angle of the elbow
bind = np.array([np.eye(4), np.eye(4) - bone * np.outer(np.eye(4)[3], np.eye(4)[1])])   # column by column
arrays = [("VEC3", "<f4", vertices), ("SCALAR", "<u2", triangles.ravel()), ("VEC4", "u1", [[0, 1, 0, 0]] * len(vertices)),
          ("VEC4", "<f4", np.stack([1 - share, share, 0 * share, 0 * share], axis=1)), ("SCALAR", "<f4", times),
          ("VEC4", "<f4", np.stack([np.sin(half), 0 * half, 0 * half, np.cos(half)], axis=1)), ("MAT4", "<f4", bind)]
blocks = [np.asarray(values).astype(kind).tobytes() for _, kind, values in arrays]
starts = np.cumsum([0, *map(len, blocks)]).tolist()

# %%
# The document: two joints, a mesh that both move, and an animation that turns the elbow to and fro.
document = {
    "asset": {"version": "2.0"}, "scenes": [{"nodes": [0, 1]}],
    "nodes": [{"name": "arm", "mesh": 0, "skin": 0}, {"name": "upper arm", "children": [2]},
              {"name": "forearm", "translation": [0, bone, 0]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 2, "WEIGHTS_0": 3}, "indices": 1}]}],
    "skins": [{"joints": [1, 2], "inverseBindMatrices": 6}],
    "animations": [{"name": "wave", "samplers": [{"input": 4, "output": 5}],
                    "channels": [{"sampler": 0, "target": {"node": 2, "path": "rotation"}}]}],
    "accessors": [{"bufferView": i, "componentType": {"u1": 5121, "<u2": 5123, "<f4": 5126}[kind], "count": len(values),
                   "type": shape} for i, (shape, kind, values) in enumerate(arrays)],
    "bufferViews": [{"buffer": 0, "byteOffset": starts[i], "byteLength": len(block)} for i, block in enumerate(blocks)],
    "buffers": [{"byteLength": starts[-1], "uri": "data:;base64," + b64encode(b"".join(blocks)).decode()}]}
with tempfile.TemporaryDirectory() as folder:
    (Path(folder) / "arm.gltf").write_text(json.dumps(document))
    arm = ep.load_model(Path(folder) / "arm.gltf", animation="wave", loop=True, materials={"": "skin"})

# %%
# Frames of 38 ms through two runs of the loop. The line is the speed of the hand by the animation alone.
scene = ep.Scene()
scene.add(arm, name="person", position=(3, 0, 0), smooth=True)
radar = ep.Radar(ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=64, sampling_rate=5e6, num_chirps=128,
                                  chirp_interval=3e-4),
                 transmitters=[ep.Antenna((0, 0, 0.4))], receivers=[ep.Antenna((0, 0, 0.4))])
frames, figure = np.arange(0, 2 * period, 0.08), plt.figure(figsize=(8, 6), layout="constrained")
records = [ep.trace(scene, radar, num_rays=10_000, max_bounces=1, start_time=start) for start in frames]
hand = lambda time: np.linalg.norm(scene.world_vertices(1, time)[-24:].mean(axis=0) - (0, 0, 0.4))
speed = [(hand(start + 0.0193) - hand(start + 0.0191)) / 2e-4 for start in frames]
for panel, name in zip(figure.subplots(2, 1, sharex=True), ("upper arm", "forearm"), strict=True):
    maps = [ep.range_doppler(ep.synthesize(paths.select(ep.hits(f"*/{name}")), radar), radar) for paths in records]
    level = 10 * np.log10([(np.abs(one.values[0, 0]) ** 2).sum(axis=1) + 1e-30 for one in maps]).T
    image = panel.pcolormesh(frames + 0.0192, maps[0].velocity, level - level.max(), vmin=-40, vmax=0)
    if name == "forearm":
        panel.plot(frames + 0.0192, speed, "w--", linewidth=1)
    panel.set(title=name.capitalize(), xlabel="Time in s", ylabel="Velocity in m/s", ylim=(-2, 2))
figure.colorbar(image, ax=figure.axes, label="Power over the largest of each panel in dB")
plt.show()
