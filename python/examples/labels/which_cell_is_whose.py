"""
Which cell is whose
===================

``annotate`` labels every cell of the map: which object or ghost made it. On the right, where each ghost appears, with the
surface that mirrored it.
"""
import numpy as np

import echopath as ep
from echopath import plots

scene = ep.Scene()
scene.add(ep.actors.pedestrian(speed=1.4), name="walker", position=(7, 0, 0), yaw=np.pi)
scene.add(ep.actors.box((1.5, 1.0, 1.0)), name="cart", position=(10, -1.5, 0.6),
          material=ep.Material(conductor=True, scattering=0.8), motion=ep.LinearMotion(velocity=(2, 0, 0)))
scene.add(ep.actors.wall(24, 4), name="wall", material=ep.materials["concrete"].replace(mirror=True), position=(9, 2.5, 0))
chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=256, sampling_rate=20e6, num_chirps=128,
                          chirp_interval=150e-6)
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 1))], receivers=[ep.Antenna((0, 0.01, 1))], transmit_power=0.2)
paths = ep.trace(scene, radar, num_rays=40_000)

# %%
labels = ep.annotate(paths, None, radar, noise_margin_db=10, dynamic_range_db=60)
print(labels)

# %%
figure = plots.plot_ghosts(labels, title="Cells of objects and of their ghosts")
plots.show(figure)
