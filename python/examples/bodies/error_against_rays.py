"""
Error against rays
==================

How many rays does a coherent echo need? A metal sphere of 0.1 m at 77 GHz has a closed form, pi a^2. Each ray stands for a
patch of the surface, its footprint; how the phase over that patch is taken into account decides by how much the sum errs.
The picture is of numbers of rays that are too small, too; `ep.rcs` warns of those, and the warning is silenced here.
"""
import warnings

import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

radius = 0.1
scene = ep.Scene()
scene.add(ep.actors.sphere(radius, subdivisions=24), name="sphere", material="metal", smooth=True)
numbers = 2 ** np.arange(8, 15)
warnings.filterwarnings("ignore", "rcs: .* not known to 3 dB")


def error_db(num_rays, footprint):
    """Root mean square over four shifts of the rays, in dB."""
    values = [ep.rcs(scene, frequency=77e9, incidence=(-1, 0, 0), num_rays=num_rays, footprint=footprint, seed=seed)
              for seed in (1, 2, 3, 4)]
    return np.sqrt(np.mean((10 * np.log10(np.array(values) / (np.pi * radius**2))) ** 2))


# %%
# The second-order footprint, the default, knows how the phase curves over the patch.
figure, axes = plt.subplots(figsize=(8, 4.5), layout="constrained")
for footprint, label in (("none", "every ray a point"), ("first_order", "slope of the phase"),
                         ("second_order", "slope and curvature (default)")):
    axes.loglog(numbers, [error_db(int(number), footprint) for number in numbers], "o-", label=label)
axes.axhline(0.1, color="0.5", linestyle=":")
axes.text(numbers[-1], 0.11, "0.1 dB", color="0.4", horizontalalignment="right")
axes.set(xlabel="Number of rays", ylabel="Error in dB (rms over four shifts)",
         title="Metal sphere of 161 wavelengths circumference")
axes.legend()
axes.grid(alpha=0.3, which="both")
plt.show()
