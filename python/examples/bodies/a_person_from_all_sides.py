"""
A person from all sides
=======================

The mean radar cross section of a person over azimuth. Clothes are rough: echoes of single instants fluctuate by many dB
(speckle), their mean does not. The band is what was measured for two adults in four garments at 76 to 81 GHz (means over
azimuth; Fortuny-Guasch and Chareau, EUR 25762 EN, 2013).

`ep.rcs` warns of single directions whose coherent part these rays do not know to 3 dB. The mean over all 36 of them, which is
what was measured, is known far better, so the warning is silenced.
"""
import warnings

import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

scene = ep.Scene()
scene.add(ep.actors.pedestrian(height=1.75), name="person", position=(0, 0, 0))

azimuth = np.radians(np.arange(0, 360, 10))
directions = np.column_stack([np.cos(azimuth), np.sin(azimuth), np.zeros_like(azimuth)])
warnings.filterwarnings("ignore", "rcs: .* not known to 3 dB")
power = ep.rcs(scene, frequency=77e9, incidence=directions, num_rays=30_000, components=True)
total = power["coherent"] + power["diffuse"]
mean = 10 * np.log10(np.mean(total))
print(f"mean over azimuth: {mean:.1f} dBsm")

# %%
# Ahead is where the person walks to.
figure, axes = plt.subplots(figsize=(6.5, 6), subplot_kw={"projection": "polar"}, layout="constrained")
around = np.append(azimuth, 2 * np.pi)
for label, values in (("all", total), ("diffuse share", power["diffuse"])):
    axes.plot(around, 10 * np.log10(np.append(values, values[0])), label=label)
axes.fill_between(np.linspace(0, 2 * np.pi, 200), -6.9, -3.5, color="tab:green", alpha=0.25, label="measured means over azimuth")
axes.set_theta_zero_location("N")
axes.set_ylim(-20, 5)
axes.set_title("Radar cross section of a person in dBsm (0 degrees: seen from ahead)")
axes.legend(loc="lower left", bbox_to_anchor=(-0.12, -0.12))
plt.show()
