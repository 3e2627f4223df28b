"""
Micro-Doppler of a walker
=========================

One trace serves one frame; a longer film is a row of frames. Short Fourier transforms over the chirps of each frame, at the
ranges of a walker, make a spectrogram: torso in the middle, arms and legs swinging about it.
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

scene = ep.Scene()
scene.add(ep.actors.pedestrian(speed=1.3, duration=3.0), name="walker", position=(8, 0, 0), yaw=np.pi)
chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=500e6, num_samples=128, sampling_rate=10e6, num_chirps=256,
                          chirp_interval=200e-6)
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 1))], receivers=[ep.Antenna((0, 0.01, 1))], transmit_power=10.0)

# %%
# Each frame lasts 51 ms; 28 of them cover more than a step of either leg. A small share of the rays suffices to see the
# picture.
length = chirps.num_chirps * chirps.chirp_interval
starts = np.arange(28) * length
columns = []
for start in starts:
    paths = ep.trace(scene, radar, num_rays=6000, start_time=start)
    cube = ep.add_noise(ep.synthesize(paths, radar, tolerance=1e-4), radar, seed=1, start_time=start)
    spectrum = ep.range_doppler(cube, radar, window="hann")
    about = np.abs(spectrum.range - (8 - 1.3 * start)) < 1
    columns.append(np.sum(np.abs(spectrum.values[0, 0][:, about]) ** 2, axis=1))

# %%
# Velocities are negative: she comes nearer.
level = 10 * np.log10(np.array(columns).T) + 30
figure, axes = plt.subplots(figsize=(9, 4.5), layout="constrained")
image = axes.pcolormesh(starts + length / 2, spectrum.velocity, level, vmin=level.max() - 50, vmax=level.max(), cmap="inferno")
axes.axhline(-1.3, color="white", linestyle=":", label="walking speed")
axes.set(xlabel="Time in s", ylabel="Radial velocity in m/s", ylim=(-4.5, 1),
         title="Arms and legs of a walker over more than a cycle")
axes.legend(loc="upper right", facecolor="0.2", labelcolor="white")
figure.colorbar(image, label="Received power in dBm, within 1 m")
plt.show()
