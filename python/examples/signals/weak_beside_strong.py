"""
Weak beside strong
==================

A window of the Fourier transform trades the width of a peak for its side lobes. A ball 60 dB weaker than a corner reflector
drowns in the side lobes of the rectangular window; Dolph and Chebyshev's keeps them below a level of choice.
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

scene = ep.Scene()
scene.add(ep.actors.trihedral(0.3), name="corner", material="metal", position=(20.07, 1, 0))
scene.add(ep.actors.sphere(0.03), name="ball", material="metal", smooth=True, position=(22.5, -1, 0))
chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=512, sampling_rate=20e6, num_chirps=16,
                          chirp_interval=30e-6)
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 0))], receivers=[ep.Antenna((0, 0.01, 0))])
cube = ep.synthesize(ep.trace(scene, radar, num_rays=30_000), radar, tolerance=1e-10)

# %%
figure, axes = plt.subplots(figsize=(8, 4.5), layout="constrained")
for window, label in (("rect", "rectangular"), ("hann", "Hann"), (("chebyshev", 100), "Chebyshev, 100 dB")):
    spectrum = ep.range_doppler(cube, radar, window=window, zero_pad=8)
    axes.plot(spectrum.range, 10 * np.log10(np.abs(spectrum.values[0, 0]).max(axis=0) ** 2 + 1e-30) + 30, label=label)
axes.annotate("ball", (22.49, -149), (22.49, -110), horizontalalignment="center", arrowprops={"arrowstyle": "->"})
axes.set(xlabel="Range in m", ylabel="Received power in dBm", xlim=(17.5, 25), ylim=(-200, -60),
         title="A corner of 0.3 m at 20 m, a ball of 3 cm radius 2.4 m behind it")
axes.legend()
axes.grid(alpha=0.3)
plt.show()
