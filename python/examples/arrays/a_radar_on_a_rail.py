"""
A radar on a rail
=================

A radar with one antenna, which has no direction by itself, tells 7 cm apart across its view 16 m away where it slides along a
rail of two metres. ``backproject`` adds the signals of all places in phase at each point of the picture.
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

speed, places, length = 0.5, 256, 2.0  # m/s, places along the rail, m
chirps = ep.ChirpSequence(start_frequency=24e9, bandwidth=1.5e9, num_samples=256, sampling_rate=2e6, num_chirps=places,
                          chirp_interval=length / speed / places)
radar = ep.Radar(chirps, transmitters=[ep.Antenna()], receivers=[ep.Antenna((0, 0, 0.02))], position=(0, -length / 2, 2),
                 motion=ep.LinearMotion((0, speed, 0)))

scene = ep.Scene()
rough = ep.Material(conductor=True, scattering=1.0)
scene.add(ep.actors.box((4.4, 1.8, 1.5)), name="van", position=(14, -2.5, 0.75), yaw=0.5, material=rough)
for number in range(6):
    place = (12 + number, 1 + 0.5 * number, 1)
    scene.add(ep.actors.sphere(0.1), name=f"ball_{number}", material="metal", smooth=True, position=place)

# %%
# One record of rays serves all places: the antennas of each chirp are where the motion has them. The faint rows in the van and
# behind it are waves that went from a ball to the van, or back.
cube = ep.synthesize(ep.trace(scene, radar, num_rays=50_000), radar)
x, y = np.meshgrid(np.arange(10, 19, 0.04), np.arange(-5, 5, 0.03), indexing="ij")
image = ep.backproject(cube, radar, np.stack([x, y, np.ones_like(x)], axis=-1))

figure, axes = plt.subplots(figsize=(7, 6), layout="constrained")
power = 20 * np.log10(np.abs(image) + 1e-30) + 30
drawn = axes.pcolormesh(y, x, power, vmin=power.max() - 45, cmap="magma", shading="nearest")
ahead, left = np.array([(1, 1), (1, -1), (-1, -1), (-1, 1), (1, 1)]).T * np.array([[2.2], [0.9]])
axes.plot(-2.5 + ahead * np.sin(0.5) + left * np.cos(0.5), 14 + ahead * np.cos(0.5) - left * np.sin(0.5), "--", color="0.6",
          linewidth=1, label="the van")
axes.legend(loc="lower left")
axes.set(xlabel="To the left in m", ylabel="Ahead in m", xlim=(5, -5), aspect="equal",
         title="Six balls and a van, seen by one antenna on a rail of 2 m")
figure.colorbar(drawn, label="Power in dBm", shrink=0.8)
plt.show()
