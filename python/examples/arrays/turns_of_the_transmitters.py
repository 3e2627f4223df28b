"""
Turns of the transmitters
=========================

Transmitters that take turns see a moving target at different times. Its motion between the turns adds a phase to the array,
which looks like another direction, unless it is taken out.
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

half = 0.5 * ep.speed_of_light / 77.5e9
radar = ep.Radar(ep.ChirpSequence(start_frequency=77e9, bandwidth=500e6, num_samples=128, sampling_rate=10e6, num_chirps=32,
                                  chirp_interval=30e-6),
                 transmitters=[ep.Antenna((0, 4 * half * m, 0)) for m in range(3)],
                 receivers=[ep.Antenna((0, half * n, 0)) for n in range(4)])
scene = ep.Scene()
scene.add(ep.actors.sphere(0.2), name="ball", material="metal", smooth=True, position=(15, 0, 0),
          motion=ep.LinearMotion(velocity=(10, 0, 0)))
spectrum = ep.range_doppler(ep.synthesize(ep.trace(scene, radar, num_rays=4096), radar), radar, zero_pad=2)
power = np.mean(np.abs(spectrum.values) ** 2, axis=(0, 1))
cell = np.argwhere(power == power.max())

# %%
# 10 m/s times 30 us are 0.3 mm one way; there and back that is a phase of 56 degrees for each turn.
grid = np.radians(np.linspace(-40, 40, 641))
figure, axes = plt.subplots(figsize=(8, 4.5), layout="constrained")
for compensate, label in ((False, "as received"), (True, "phase of the turns taken out")):
    beams = ep.beamform(spectrum, radar, azimuth=grid, cells=cell, compensate=compensate)
    axes.plot(np.degrees(grid), 10 * np.log10(beams.power[0, :, 0]) + 30, label=label)
axes.axvline(0, color="0.5", linestyle=":", label="where the ball is")
axes.set(xlabel="Azimuth in degrees (left is positive)", ylabel="Received power in dBm", ylim=(-155, -120),
         title="A ball that recedes with 10 m/s, three transmitters in turn")
axes.legend(loc="upper right")
axes.grid(alpha=0.3)
plt.show()
