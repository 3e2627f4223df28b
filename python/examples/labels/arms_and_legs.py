"""
Arms, legs and the rest
=======================

The parts of a body are meshes of their own, so that their echoes can be told apart: arms, legs, and everything else of a
walker.
"""
import numpy as np

import echopath as ep
from echopath import plots

scene = ep.Scene()
scene.add(ep.actors.pedestrian(speed=1.6, phase=0.3), name="walker", position=(6, 0, 0), yaw=np.pi)
chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=256, sampling_rate=20e6, num_chirps=256,
                          chirp_interval=120e-6)
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 1))], receivers=[ep.Antenna((0, 0.01, 1))], transmit_power=0.1)

# %%
# ``*`` crosses ``/``: the arms are arm_left/upper, arm_left/forearm, arm_left/hand, and so on.
parts = {"arms": "T .* 'walker/arm_*' .* R", "legs": "T .* 'walker/leg_*' .* R", "torso and head": "T 'walker'+ R"}
frame = ep.simulate(scene, radar, num_rays=40_000, parts=parts, noise_seed=None, guard=False)
spectra = {name: spectrum for name, spectrum in frame.part_spectra["parts"].items() if name != "other"}
figure = plots.plot_partition(spectra, title="A walker by parts of the body")
plots.show(figure)
