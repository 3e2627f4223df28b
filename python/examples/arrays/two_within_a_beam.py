"""
Two targets within a beam
=========================

Delay and sum cannot tell two balls apart that stand closer than a beam's width. Capon's weights pass the least power from
elsewhere; where the balls differ in velocity or range, even a little, it resolves them.
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

half = 0.5 * ep.speed_of_light / 77.5e9
radar = ep.Radar(ep.ChirpSequence(start_frequency=77e9, bandwidth=300e6, num_samples=128, sampling_rate=10e6, num_chirps=64,
                                  chirp_interval=30e-6),
                 transmitters=[ep.Antenna((0, 0, 0))], receivers=[ep.Antenna((0, half * n, 0)) for n in range(8)],
                 transmit_power=10.0)
angles = np.radians([-4.0, 4.0])
scene = ep.Scene()
for number, (angle, distance, speed) in enumerate(zip(angles, (12.0, 12.2), (0.6, -0.6))):
    toward = np.array([np.cos(angle), np.sin(angle), 0])
    scene.add(ep.actors.sphere(0.1), name=f"ball_{number}", material="metal", smooth=True, position=distance * toward,
              motion=ep.LinearMotion(velocity=speed * toward))

# %%
cube = ep.add_noise(ep.synthesize(ep.trace(scene, radar, num_rays=8192), radar), radar, seed=1)
spectrum = ep.range_doppler(cube, radar)
power = np.mean(np.abs(spectrum.values[0]) ** 2, axis=0)
cell = np.argwhere(power == power.max())
grid = np.radians(np.linspace(-30, 30, 481))
figure, axes = plt.subplots(figsize=(8, 4.5), layout="constrained")
for method, label in (("bartlett", "delay and sum"), ("capon", "Capon")):
    beams = ep.beamform(spectrum, radar, azimuth=grid, cells=cell, method=method, velocity_neighbours=4, diagonal_loading=1e-3)
    values = beams.power[0, :, 0]
    axes.plot(np.degrees(grid), 10 * np.log10(values / values.max()), label=label)
for number, angle in enumerate(angles):
    axes.axvline(np.degrees(angle), color="0.5", linestyle=":", label="where the balls are" if number == 0 else None)
axes.set(xlabel="Azimuth in degrees (left is positive)", ylabel="Power over its peak in dB", ylim=(-40, 2),
         title="Two balls 8 degrees apart, eight antennas")
axes.legend()
axes.grid(alpha=0.3)
plt.show()
