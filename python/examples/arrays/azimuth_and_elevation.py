"""
Azimuth and elevation
=====================

An array with rows and columns tells both angles. Six balls, and where the radar sees them: ``estimate_angles`` looks between
the beams of its grid.
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

half = 0.5 * ep.speed_of_light / 77.5e9
radar = ep.Radar(ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=256, sampling_rate=20e6, num_chirps=32,
                                  chirp_interval=30e-6),
                 transmitters=[ep.Antenna((0, 0, 4 * half * m)) for m in range(2)],
                 receivers=[ep.Antenna((0, half * n, half * k)) for n in range(6) for k in range(4)], transmit_power=1.0)
truth = np.array([(0, 0), (-15, 0), (15, 0), (0, 10), (0, -10), (20, 12)])  # azimuth and elevation in degrees
scene = ep.Scene()
for number, (azimuth, elevation) in enumerate(np.radians(truth)):
    distance = 10 + 0.8 * number
    toward = np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
    scene.add(ep.actors.sphere(0.2), name=f"ball_{number}", material="metal", smooth=True, position=distance * toward)

# %%
# The balls differ in range, so that each has a cell of its own.
frame = ep.simulate(scene, radar, num_rays=20_000, detections={"false_alarm_rate": 1e-6}, guard=False)
found = frame.detections
figure, axes = plt.subplots(figsize=(7, 5), layout="constrained")
axes.plot(*truth.T, "o", markersize=14, markerfacecolor="none", label="where the balls are")
marks = axes.scatter(np.degrees(found.azimuth), np.degrees(found.elevation), c=found.range, s=30, zorder=3, label="detections")
axes.set(xlabel="Azimuth in degrees (left is positive)", ylabel="Elevation in degrees", xlim=(30, -30), ylim=(-20, 20),
         title="Six balls as a planar array of 8 rows and 6 columns sees them", aspect="equal")
axes.legend(loc="lower left")
axes.grid(alpha=0.3)
figure.colorbar(marks, label="Range in m", shrink=0.75)
plt.show()
