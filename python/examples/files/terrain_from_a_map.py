"""
Terrain from a map
==================

A file that others made: the elevation model of a part of Tennessee (Campbell County, from the United States Geological
Survey) that comes with matplotlib. Its grid becomes a mesh; a radar above it sees slopes that face it, and shadows behind
the ridges.
"""
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.cbook import get_sample_data

import echopath as ep

model = get_sample_data("jacksboro_fault_dem.npz")
height = model["elevation"].astype(float)[40:240:3, 40:240:3]
step = 90.0  # m between the posts that are kept
rows, columns = height.shape
x, y = np.meshgrid(step * np.arange(columns), -step * np.arange(rows))
vertices = np.column_stack([x.ravel(), y.ravel(), height.ravel()])
corner = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
triangles = np.vstack([np.column_stack([corner, corner + columns, corner + 1]),
                       np.column_stack([corner + 1, corner + columns, corner + columns + 1])])

# %%
# Rough ground scatters to all sides. The radar, at the origin of the scene, is 250 m above the western rim and looks east.
place = np.array([0.0, -3000.0, height[33, 0] + 250])
scene = ep.Scene()
scene.add(ep.Mesh(vertices - place, triangles), name="terrain", material=ep.Material(permittivity=5 - 0.3j, scattering=1.0))
chirps = ep.ChirpSequence(start_frequency=10e9, bandwidth=10e6, num_samples=1024, sampling_rate=20e6, num_chirps=1,
                          chirp_interval=100e-6)
antenna = ep.Antenna((0, 0, 0), pattern=ep.CosinePower(4))
radar = ep.Radar(chirps, transmitters=[antenna], receivers=[antenna], transmit_power=1000)
paths = ep.trace(scene, radar, num_rays=60_000, max_bounces=1)

# %%
# Each hit is a place on the ground that the radar sees: where there is none, a ridge stands before it.
lit = paths.select("power > 1e-16")
points = lit.points(lit.frame.trace_time)[lit.offsets] + place
figure, axes = plt.subplots(figsize=(8, 6.5), layout="constrained")
axes.pcolormesh(x / 1e3, y / 1e3, height, cmap="Greys_r")
dots = axes.scatter(points[:, 0] / 1e3, points[:, 1] / 1e3, s=1, c=10 * np.log10(lit.power) + 30, cmap="inferno",
                    vmin=-130, vmax=-85)
axes.plot(place[0] / 1e3, place[1] / 1e3, "c^", markersize=12, label="radar, 250 m above the ground")
axes.set(xlabel="East in km", ylabel="North in km", xlim=(-0.2, 5.95),
         title="What a radar sees of a landscape (10 GHz)", aspect="equal")
axes.legend(loc="upper right")
figure.colorbar(dots, label="Received power of the ray in dBm", extend="both")
plt.show()
