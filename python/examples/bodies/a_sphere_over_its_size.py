"""
A sphere over its size
======================

Metal spheres against the exact series of Mie. Rays know the sphere from about five wavelengths of circumference on; below,
waves creep around it and resonate, which no ray does.
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

frequency = 10e9
wavelength = ep.speed_of_light / frequency


def traced(size):
    """Radar cross section in m^2 of a sphere whose circumference is `size` wavelengths."""
    scene = ep.Scene()
    scene.add(ep.actors.sphere(size * wavelength / (2 * np.pi)), name="sphere", material="metal", smooth=True)
    return ep.rcs(scene, frequency=frequency, incidence=(-1, 0, 0), num_rays=8192)


# %%
# All sizes are divided by that of the disc which the sphere shows.
fine, coarse = np.geomspace(0.5, 60, 600), np.geomspace(0.5, 60, 40)
disc = lambda size: np.pi * (size * wavelength / (2 * np.pi)) ** 2
exact = [ep.mie_rcs(size * wavelength / (2 * np.pi), frequency) / disc(size) for size in fine]
rays = [traced(size) / disc(size) for size in coarse]

figure, axes = plt.subplots(figsize=(8, 4.5), layout="constrained")
axes.semilogx(fine, 10 * np.log10(exact), label="Mie, exact")
axes.semilogx(coarse, 10 * np.log10(rays), "o", markersize=4, label="8192 rays each")
axes.axvspan(0.5, 5, color="0.92")
axes.text(0.53, 6.2, "too small for rays", color="0.4")
axes.set(xlabel="Circumference in wavelengths", ylabel="Cross section over that of the disc in dB", ylim=(-10, 8),
         title="Metal sphere, monostatic")
axes.legend(loc="lower right")
axes.grid(alpha=0.3)
plt.show()
