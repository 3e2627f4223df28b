"""
A street with a walker
======================

A person walks towards the radar between two concrete walls. The map shows more than one person: the walls mirror her, and
echoes by the walls come later than the straight one.
"""
import numpy as np

import echopath as ep
from echopath import plots

scene = ep.Scene()
scene.add(ep.actors.pedestrian(height=1.75, speed=1.4), name="walker", position=(10, 0.5, 0), yaw=np.pi)
concrete = ep.materials["concrete"].replace(scattering=0.3, mirror=True)
scene.add(ep.actors.wall(30, 5), name="wall_left", material=concrete, position=(14, 3, 0))
scene.add(ep.actors.wall(30, 5), name="wall_right", material=concrete, position=(14, -3, 0), yaw=np.pi)

chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=256, sampling_rate=20e6, num_chirps=128,
                          chirp_interval=200e-6)
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 1))], receivers=[ep.Antenna((0, 0.01, 1))], transmit_power=0.1)

# %%
# ``simulate`` does all of it in one call: it traces, synthesises the signal, adds noise and transforms.
frame = ep.simulate(scene, radar, num_rays=40_000, guard=False)
print(frame)

# %%
# Velocities are positive for what recedes, so the walker stands below zero. The walls stand still.
figure = plots.plot_range_doppler(frame.spectrum, title="A person walks towards the radar between two walls")
plots.show(figure)
