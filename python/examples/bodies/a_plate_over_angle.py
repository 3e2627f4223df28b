"""
A plate over angle
==================

The radar cross section of a square metal plate, against physical optics in closed form: (4 pi A^2 / wavelength^2) cos^2
sinc^2. Far side lobes are made by the edges alone; they need more rays than the main lobe does. 256 rays are too few on
purpose, to show what that looks like; `ep.rcs` warns of them, and the warning is silenced here.
"""
import warnings

import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

side, frequency = 0.1, 77e9
wavelength = ep.speed_of_light / frequency
scene = ep.Scene()
scene.add(ep.actors.plate(side, side), name="plate", material="metal")

# %%
# Directions point from the target towards the antennas: the plate's front looks along -x.
angle = np.radians(np.linspace(0, 25, 151))
toward_radar = np.column_stack([-np.cos(angle), np.sin(angle), np.zeros_like(angle)])
warnings.filterwarnings("ignore", "rcs: .* not known to 3 dB")
traced = {num_rays: ep.rcs(scene, frequency=frequency, incidence=toward_radar, num_rays=num_rays) for num_rays in (256, 4096)}

phase = 2 * side * np.sin(angle) / wavelength
closed_form = 4 * np.pi * side**4 / wavelength**2 * (np.cos(angle) * np.sinc(phase)) ** 2

# %%
figure, axes = plt.subplots(figsize=(8, 4.5), layout="constrained")
for num_rays, colour in ((256, "tab:orange"), (4096, "tab:blue")):
    axes.plot(np.degrees(angle), 10 * np.log10(traced[num_rays]), color=colour, label=f"{num_rays} rays")
axes.plot(np.degrees(angle), 10 * np.log10(closed_form), "k--", linewidth=1, label="closed form")
axes.set(xlabel="Angle off the normal in degrees", ylabel="Radar cross section in dBsm", ylim=(-45, 22),
         title="Metal plate of 0.1 m at 77 GHz")
axes.legend()
axes.grid(alpha=0.3)
plt.show()
