"""
A car from all sides
====================

The radar cross section of a compact car at 77 GHz over aspect. Its panels are curved and smooth: each aspect has its own few
points that mirror the radar, and where a panel is square to it, abeam and behind, the echo flashes.
"""
import warnings

import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

warnings.filterwarnings("ignore", "rcs: .* not known to 3 dB")  # single aspects of 4096 rays; the picture is of their course
scene = ep.Scene()
scene.add(ep.actors.car(), name="car")
azimuth = np.radians(np.arange(0.0, 360.0, 5.0))
directions = np.column_stack([np.cos(azimuth), np.sin(azimuth), 0.0 * azimuth])
power = ep.rcs(scene, frequency=77e9, incidence=directions, num_rays=4096, components=True)
total = power["coherent"] + power["diffuse"]
print(f"mean {10 * np.log10(np.mean(total)):.1f} dBsm, median {10 * np.log10(np.median(total)):.1f} dBsm")

# %%
# The diffuse share comes from tyres, lamps, the grille and the underside.
figure, axes = plt.subplots(figsize=(6.5, 6), subplot_kw={"projection": "polar"}, layout="constrained")
around = np.append(azimuth, 2 * np.pi)
for label, values in (("all", total), ("diffuse share", power["diffuse"])):
    axes.plot(around, 10 * np.log10(np.maximum(np.append(values, values[0]), 1e-3)), label=label)
axes.set_theta_zero_location("N")
axes.set_ylim(-25, 30)
axes.set_title("Radar cross section of a car in dBsm (0 degrees: seen from ahead)")
axes.legend(loc="lower left", bbox_to_anchor=(-0.12, -0.12))
plt.show()
