"""
Noise and the radar equation
============================

The signal-to-noise ratio of a cell is Pr Ns Nc / (k T0 F fs), with Pr of the radar equation: here measured over distance for
a metal ball, as the power of its cell over the mean of empty ones.
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

radius = 0.1
chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=250e6, num_samples=512, sampling_rate=20e6, num_chirps=64,
                          chirp_interval=30e-6)
antenna = ep.Antenna((0, 0, 0), pattern=ep.CosinePower(49))
radar = ep.Radar(chirps, transmitters=[antenna], receivers=[antenna], transmit_power=0.01, noise_figure_db=12)


def measured(distance, seed):
    """Power in W of the strongest cell about the distance, and mean power of the cells beyond 200 m."""
    scene = ep.Scene()
    scene.add(ep.actors.sphere(radius), name="ball", material="metal", smooth=True, position=(distance + radius, 0, 0))
    cube = ep.add_noise(ep.synthesize(ep.trace(scene, radar, num_rays=2048), radar), radar, seed=seed)
    spectrum = ep.range_doppler(cube, radar, window="rect", zero_pad=2)
    power = np.abs(spectrum.values[0, 0]) ** 2
    about = np.abs(spectrum.range - distance) < 1
    return power[:, about].max(), power[:, spectrum.range > 200].mean()


# %%
# A beam of cos^49 has a gain of 2 (49 + 1) = 100 ahead, where the ball is.
distances = np.geomspace(8, 80, 14)
signal, noise = np.array([measured(d, seed) for seed, d in enumerate(distances)]).T

fine = np.geomspace(8, 80, 200)
received = radar.transmit_power * 100**2 * chirps.wavelength**2 * np.pi * radius**2 / ((4 * np.pi) ** 3 * fine**4)
noise_power = ep.boltzmann * 290 * 10**1.2 * chirps.sampling_rate
gain = chirps.num_samples * chirps.num_chirps

figure, axes = plt.subplots(figsize=(8, 4.5), layout="constrained")
axes.semilogx(fine, 10 * np.log10(received * gain / noise_power), color="0.5", label="radar equation")
axes.semilogx(distances, 10 * np.log10(signal / noise), "o", label="simulated, rectangular window")
axes.set(xlabel="Distance in m", ylabel="Signal-to-noise ratio of the cell in dB", title="A metal ball of 0.1 m radius, 10 mW")
axes.set_xticks([10, 20, 40, 80], ["10", "20", "40", "80"])
axes.minorticks_off()
axes.legend()
axes.grid(alpha=0.3)
plt.show()
