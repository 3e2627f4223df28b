"""
A moving ball
=============

A receding ball is displayed where it is and as fast as it is, plus what the chirp makes of its velocity: range and Doppler
couple, and a receding target seems a little farther away, here by f v / slope.
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

start, velocity = 20.0, 20.0
scene = ep.Scene()
scene.add(ep.actors.sphere(0.1), name="ball", material="metal", smooth=True, position=(start, 0, 0),
          motion=ep.LinearMotion(velocity=(velocity, 0, 0)))
chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=500e6, num_samples=512, sampling_rate=20e6, num_chirps=128,
                          chirp_interval=40e-6)
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 0))], receivers=[ep.Antenna((0, 0, 0))])
paths = ep.trace(scene, radar, num_rays=8192)
spectrum = ep.range_doppler(ep.synthesize(paths, radar), radar, window="hann", zero_pad=4)

# %%
# The expected place, in the middle of the frame. The front of the ball is a radius nearer than its centre.
middle = 0.5 * chirps.num_chirps * chirps.chirp_interval
distance = start - 0.1 + velocity * middle
coupling = chirps.centre_frequency * velocity / chirps.slope
print(f"at {distance:.3f} m, displayed {coupling:.3f} m farther away")

# %%
level = 10 * np.log10(np.abs(spectrum.values[0, 0]) ** 2) + 30
figure, axes = plt.subplots(figsize=(8, 4.5), layout="constrained")
image = axes.pcolormesh(spectrum.range, spectrum.velocity, level, vmin=level.max() - 60, vmax=level.max(), cmap="inferno")
axes.plot(distance, velocity, "k+", markersize=14, markeredgewidth=2, label="where it is")
axes.plot(distance + coupling, velocity, "bx", markersize=11, markeredgewidth=2, label="where it is expected in the map")
axes.set(xlabel="Range in m", ylabel="Radial velocity in m/s", xlim=(19, 21.4), ylim=(18, 22),
         title="A ball that recedes with 20 m/s")
axes.legend(loc="lower right", facecolor="0.8")
figure.colorbar(image, label="Received power in dBm")
plt.show()
