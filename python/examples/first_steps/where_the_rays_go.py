"""
Where the rays go
=================

The strongest rays of a trace to each object, drawn into the scene from above, from the side and aslant. Colours tell how
often a ray bounced.
"""
import numpy as np

import echopath as ep
from echopath import plots

scene = ep.Scene()
scene.add(ep.actors.pedestrian(), name="walker", position=(8, -0.5, 0), yaw=np.pi)
scene.add(ep.actors.trihedral(0.15), name="corner", material="metal", position=(6, -2, 0.8), yaw=-0.3)
scene.add(ep.actors.wall(14, 3), name="wall", material=ep.materials["concrete"].replace(mirror=True), position=(6, 2, 0))

chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=256, sampling_rate=20e6, num_chirps=64,
                          chirp_interval=60e-6)
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 1))], receivers=[ep.Antenna((0, 0.01, 1))])

paths = ep.trace(scene, radar, num_rays=20_000)
print(paths)

# %%
# Green rays went straight to an object and back, blue ones took the wall on one way, orange ones bounced three times within
# the corner reflector.
figure = plots.plot_scene(scene, paths, num_rays=150, title="150 of the paths of 20 000 rays: the strongest to each object")
plots.show(figure)
