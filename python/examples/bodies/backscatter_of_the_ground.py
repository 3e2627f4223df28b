"""
Backscatter of the ground
=========================

How much of a wave comes back from a road, from gravel, grass and snow decides what a radar finds there. These materials scatter
in lobes that were fitted to published backscatter; a patch of each, simulated, has the level of its lobe.
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep
from echopath.base.storage.data_folder import data_folder

names = ["asphalt_road", "gravel", "grass", "snow"]
published = {name: np.loadtxt(data_folder("materials") / "backscatter" / f"{name}.csv", delimiter=",", skiprows=2).T
             for name in names}
chirps = ep.ChirpSequence(start_frequency=77e9, num_chirps=1)
distance, area = 30.0, 1.0


def simulated(name, grazing_deg):
    """sigma0 in dB of a patch of 1 m^2, from its mean diffuse power by the radar equation."""
    grazing = np.radians(grazing_deg)
    scene = ep.Scene()
    patch = ep.Mesh([[-.5, -.5, 0], [.5, -.5, 0], [.5, .5, 0], [-.5, .5, 0]], [[0, 1, 2], [0, 2, 3]])
    scene.add(patch, name="patch", material=ep.materials[name])
    antenna = ep.Antenna((-distance * np.cos(grazing), 0, distance * np.sin(grazing)))
    paths = ep.trace(scene, ep.Radar(chirps, transmitters=[antenna], receivers=[antenna]), num_rays=20_000, max_bounces=1)
    power = np.sum(paths.select("T D R").power)
    wavelength = ep.speed_of_light / 77e9
    return 10 * np.log10(power * (4 * np.pi)**3 * distance**4 / (paths.radar.transmit_power * wavelength**2 * area))


# %%
# The deviation of each fit, and the picture of both.
figure, axes = plt.subplots(figsize=(8, 5), layout="constrained")
angles = np.linspace(3, 40, 200)
for name, colour in zip(names, ("C0", "C1", "C2", "C3")):
    grazing_deg, measured_db = published[name]
    material = ep.materials[name]
    deviation = 10 * np.log10(material.backscatter(np.radians(grazing_deg), frequency=77e9)) - measured_db
    print(f"{name}: rms {np.sqrt(np.mean(deviation**2)):.2f} dB, at most {np.abs(deviation).max():.2f} dB")
    axes.plot(angles, 10 * np.log10(material.backscatter(np.radians(angles), frequency=77e9)), colour, label=f"{name}, its lobe")
    axes.plot(grazing_deg, measured_db, colour, marker="o", linestyle="", markerfacecolor="none")
    axes.plot([5, 10, 20, 35], [simulated(name, angle) for angle in (5, 10, 20, 35)], colour, marker="x", linestyle="",
              markersize=9)
axes.plot([], [], "ko", markerfacecolor="none", label="published (Kulemin 2003)")
axes.plot([], [], "kx", label="simulated patch of 1 m²")
axes.set(xlabel="Grazing angle in degrees", ylabel="Cross section per area in dB", title="Backscatter of the ground at 77 GHz",
         ylim=(-60, -5))
axes.legend(loc="lower right")
axes.grid(alpha=0.3)
plt.show()
