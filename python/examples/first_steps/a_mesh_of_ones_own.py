"""
A mesh of one's own
===================

Meshes are plain arrays: corners in metres, and triangles as indices of corners. Here a wedge is made by hand, written as an
OBJ file, read back, and driven past the radar.
"""
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

# %%
# Six corners, eight triangles: a wedge of a car's size, whose slanted front looks back along -x.
vertices = np.array([[0, -0.9, 0], [0, 0.9, 0], [4, -0.9, 0], [4, 0.9, 0], [1.5, -0.9, 1.4], [1.5, 0.9, 1.4]])
triangles = np.array([[0, 4, 5], [0, 5, 1], [4, 2, 3], [4, 3, 5], [0, 1, 3], [0, 3, 2], [0, 2, 4], [1, 5, 3]])
wedge = ep.Mesh(vertices, triangles)

path = Path(tempfile.mkdtemp()) / "wedge.obj"
path.write_text("\n".join([*(f"v {x} {y} {z}" for x, y, z in vertices), *(f"f {a} {b} {c}" for a, b, c in triangles + 1)]))
same = ep.load_mesh(path)
print(wedge, "from the file:", same)

# %%
# A motion carries it: 12 m/s along x, away from the radar.
scene = ep.Scene()
scene.add(same, name="wedge", material=ep.Material(conductor=True, scattering=0.5), position=(15, 2, 0),
          motion=ep.LinearMotion(velocity=(12, 0, 0)))
chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=500e6, num_samples=256, sampling_rate=20e6, num_chirps=128,
                          chirp_interval=40e-6)
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 0.5))], receivers=[ep.Antenna((0, 0.01, 0.5))], transmit_power=1.0)
spectrum = ep.simulate(scene, radar, num_rays=20_000, guard=False).spectrum

# %%
# The front recedes with the cosine of the direction in which the radar sees it.
level = 10 * np.log10(np.abs(spectrum.values[0, 0]) ** 2) + 30
figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
left.triplot(vertices[:, 0] + 15, vertices[:, 2], triangles, color="0.4")
left.set(xlabel="Distance ahead in m", ylabel="Height in m", title="The wedge from its side", aspect="equal")
image = right.pcolormesh(spectrum.range, spectrum.velocity, level, vmin=level.max() - 25, vmax=level.max(), cmap="inferno")
right.axhline(12 * 15 / np.hypot(15, 2), color="white", linestyle=":", label="12 m/s times 15 m / 15.1 m")
right.set(xlabel="Range in m", ylabel="Radial velocity in m/s", xlim=(10, 25), ylim=(8, 16), title="Its echo")
right.legend(loc="lower right", facecolor="0.3", labelcolor="white")
figure.colorbar(image, label="Received power in dBm")
plt.show()
