"""
A corner reflector
==================

The smallest experiment: one corner reflector, one radar, one range profile. The echo stands where the corner is, as strong
as the radar equation says for its radar cross section of 4 pi a^4 / (3 wavelength^2).
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

# %%
# A scene is a tree of named objects. The corner opens towards -x, so it faces a radar at the origin.
distance, size = 20.0, 0.1
scene = ep.Scene()
scene.add(ep.actors.trihedral(size), name="corner", material="metal", position=(distance, 0, 0))

chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=256, sampling_rate=20e6, num_chirps=128,
                          chirp_interval=30e-6)
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 0))], receivers=[ep.Antenna((0, 0.01, 0))], transmit_power=0.1)

# %%
# Rays are shot once. The record of what they hit makes the signal, and the signal makes the map.
paths = ep.trace(scene, radar, num_rays=20_000)
cube = ep.synthesize(paths, radar)
spectrum = ep.range_doppler(ep.add_noise(cube, radar, seed=1), radar, window="hann", zero_pad=4)
profile = 10 * np.log10(np.max(np.abs(spectrum.values[0, 0]) ** 2, axis=0)) + 30

cross_section = 4 * np.pi * size**4 / (3 * chirps.wavelength**2)
expected = radar.transmit_power * chirps.wavelength**2 * cross_section / ((4 * np.pi) ** 3 * distance**4)

# %%
# The strongest cell stands at the distance of the corner.
figure, axes = plt.subplots(figsize=(8, 4), layout="constrained")
axes.plot(spectrum.range, profile, label="received, largest over velocity")
axes.plot(distance, 10 * np.log10(expected) + 30, "x", color="tab:red", markersize=10, label="radar equation")
axes.set(xlabel="Range in m", ylabel="Received power in dBm", xlim=(15, 25), ylim=(-135, -90), title="A corner of 0.1 m at 20 m")
axes.legend()
axes.grid(alpha=0.3)
plt.show()
