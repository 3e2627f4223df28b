"""
A virtual array
===============

Three transmitters and four receivers see directions as twelve antennas would that stand at the sums of their positions. A
longer array has a narrower beam.
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

half = 0.5 * ep.speed_of_light / 77.5e9
transmitters = [ep.Antenna((0, 4 * half * m, 0)) for m in range(3)]
receivers = [ep.Antenna((0, half * n, 0)) for n in range(4)]
chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=128, sampling_rate=10e6, num_chirps=8,
                          chirp_interval=20e-6)
scene = ep.Scene()
scene.add(ep.actors.sphere(0.2), name="ball", material="metal", smooth=True, position=(12 * np.cos(0.3), 12 * np.sin(0.3), 0))

# %%
figure, (above, below) = plt.subplots(2, 1, figsize=(8, 6), layout="constrained", height_ratios=(1, 2))
for number, (name, antennas) in enumerate({"1 x 4": transmitters[:1], "3 x 4": transmitters}.items()):
    radar = ep.Radar(chirps, transmitters=antennas, receivers=receivers)
    array = ep.virtual_array(radar)
    above.plot(array.elements[:, 1] * 1e3, np.full(len(array.elements), number), "o", label=name)
    spectrum = ep.range_doppler(ep.synthesize(ep.trace(scene, radar, num_rays=4096), radar), radar)
    cell = np.argwhere(np.abs(spectrum.values[0, 0]) == np.abs(spectrum.values[0, 0]).max())
    beams = ep.beamform(spectrum, radar, azimuth=np.radians(np.linspace(-80, 80, 641)), cells=cell)
    power = beams.power[0, :, 0]
    below.plot(np.degrees(beams.azimuth), 10 * np.log10(power / power.max()), label=f"{name}: {len(array.elements)} elements")
above.set(xlabel="Place of the virtual element to the left in mm", yticks=[0, 1], yticklabels=["1 x 4", "3 x 4"],
          ylim=(-0.6, 1.6),
          title="Virtual elements")
below.axvline(np.degrees(0.3), color="0.5", linestyle=":", label="true direction")
below.set(xlabel="Azimuth in degrees (left is positive)", ylabel="Power over its peak in dB", ylim=(-30, 1),
          title="Beams at the cell of a ball")
below.legend()
below.grid(alpha=0.3)
plt.show()
