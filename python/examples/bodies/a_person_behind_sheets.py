"""
A person behind sheets
======================

A person is 8 m ahead, behind panes, walls and cloth that are turned from 0 to 75 degrees. Waves pass each sheet on
the way out and on the way back: lines are Airy's formula, dots are traced. With vertical polarisation and an upright sheet, the
electric field lies across the plane of incidence (TE).
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=256, sampling_rate=20e6, num_chirps=2,
                          chirp_interval=30e-6)
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 1))], receivers=[ep.Antenna((0, 0.01, 1))])
sheets = {"glass pane, 4 mm": "glass_pane", "painted bumper, 3 mm": "painted_bumper", "curtain": "curtain",
          "plasterboard wall": "plasterboard_wall"}


def level(material, turn):
    """Power of the straight echo of the person in dBW."""
    scene = ep.Scene()
    scene.add(ep.actors.pedestrian(), name="person", position=(8, 0, 0), yaw=np.pi)
    if material is not None:
        scene.add(ep.actors.plate(12, 6), name="sheet", material=material, position=(4, 0, 0), yaw=turn)
    paths = ep.trace(scene, radar, num_rays=15_000, max_bounces=1)
    return 10 * np.log10(ep.received_power(paths.select("T 'person' R")).power)


# %%
# Between faces waves add up or cancel, by thickness, angle and frequency: the two boards of a wall do so every few degrees.
free = level(None, 0.0)
turns = np.radians([0, 15, 30, 45, 60, 75])
angles = np.radians(np.linspace(0, 80, 401))
figure, axes = plt.subplots(figsize=(8, 4.5), layout="constrained")
for name, key in sheets.items():
    sheet = ep.sheet_coefficients(ep.materials[key], frequency=77e9, incidence=angles)
    line, = axes.plot(np.degrees(angles), 20 * np.log10(sheet.passed_power(te_share=1.0)), label=name)
    found = [level(ep.materials[key], turn) - free for turn in turns]
    axes.plot(np.degrees(turns), found, "o", color=line.get_color())
axes.set(xlabel="angle of incidence (degrees)", ylabel="echo of the person over that in the open (dB)", ylim=(-40, 1),
         title="Lines: both ways through the sheet by Airy's formula. Dots: traced")
axes.legend(loc=(0.02, 0.37))
axes.grid(alpha=0.4)
plt.show()
