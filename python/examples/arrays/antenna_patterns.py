"""
Antenna patterns
================

A pattern is isotropic, a power of the cosine, a beam of known widths, or a table, of a CSV file for example. All are power
gains over an isotropic antenna; the boresight is +x of the antenna.
"""
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

folder = Path(ep.__file__).parents[2] / "data" / "antennas"
azimuth = np.linspace(-np.pi, np.pi, 361)
gain = 5 * np.cos(np.clip(2.0 * azimuth, -np.pi / 2, np.pi / 2)) ** 2
elevation = np.radians([-40, -20, 0, 20, 40])
fan = np.outer(np.cos(np.clip(2 * elevation, -np.pi / 2, np.pi / 2)) ** 2, gain)

# %%
# ``GainTable`` takes any table; outside of it there is no gain. The file holds a patch antenna.
patterns = {"isotropic": ep.Isotropic(), "cosine to the 4th": ep.CosinePower(4),
            "beam of 60 by 20 degrees": ep.GaussianBeam(azimuth=np.radians(60), elevation=np.radians(20)),
            "table: a fan": ep.GainTable(azimuth=azimuth, elevation=elevation, gain=fan),
            "file: a patch": ep.load_antenna(folder / "patch_77ghz.csv")}
figure, axes = plt.subplots(figsize=(6, 6), subplot_kw={"projection": "polar"}, layout="constrained")
directions = np.column_stack([np.cos(azimuth), np.sin(azimuth), np.zeros_like(azimuth)])
for name, pattern in patterns.items():
    axes.plot(azimuth, 10 * np.log10(np.abs(pattern.field(directions)) ** 2 + 1e-9), label=name)
axes.set_theta_zero_location("N")
axes.set_ylim(-25, 16)
axes.set_title("Gain in dBi over azimuth (left is positive)")
axes.legend(loc="upper left", bbox_to_anchor=(1.05, 1.0))
plt.show()
