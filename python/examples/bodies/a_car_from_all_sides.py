"""
A car from all sides
====================

The radar cross section of a compact car at 77 GHz over aspect. Its panels are curved and smooth: each aspect has its own few
points that mirror the radar, and where a panel is square to it, abeam and behind, the echo flashes.

At 77 GHz a panel of a metre is 250 wavelengths wide, and an echo to the side of its flash is what is left of a sum that nearly
cancels. No affordable number of rays knows each of 72 aspects to 3 dB (131 072 leave 26 of them), of which `ep.rcs` warns. The
picture is of the course over aspect, whose median four times as many rays move by 0.7 dB, so the warning is silenced.
"""
import warnings

import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

warnings.filterwarnings("ignore", "rcs: .* not known to 3 dB")
scene = ep.Scene()
scene.add(ep.actors.car(), name="car")
azimuth = np.radians(np.arange(0.0, 360.0, 5.0))
directions = np.column_stack([np.cos(azimuth), np.sin(azimuth), 0.0 * azimuth])
power = ep.rcs(scene, frequency=77e9, incidence=directions, num_rays=30_000, components=True)
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
