"""
Ghosts by their way
===================

Path expressions say which way an echo took. Here the echoes of a walker beside a wall are taken apart: straight, one way by
the wall, both ways. The parts are signals of their own that add up to the whole.
"""
import numpy as np

import echopath as ep
from echopath import plots

scene = ep.Scene()
scene.add(ep.actors.pedestrian(speed=1.4), name="walker", position=(8, 0, 0), yaw=np.pi)
scene.add(ep.actors.wall(20, 4), name="wall", material=ep.Material.metal(mirror=True), position=(8, 2.5, 0))
chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=256, sampling_rate=20e6, num_chirps=128,
                          chirp_interval=200e-6)
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 1))], receivers=[ep.Antenna((0, 0.01, 1))], transmit_power=0.1)

# %%
# Hits stand in the order of travel between the transmitter T and the receiver R. What no expression takes is "other".
ways = {"straight": "T 'walker'+ R", "one way by the wall": "T ('wall' 'walker'+ | 'walker'+ 'wall') R",
        "both ways by the wall": "T 'wall' 'walker'+ 'wall' R"}
paths = ep.trace(scene, radar, num_rays=40_000)
parts = ep.decompose(paths, radar, ways)
whole = ep.synthesize(paths, radar)
difference = abs(sum(parts.values()) - whole).max() / abs(whole).max()
print(f"sum of the parts and the whole differ by {difference:.0e} of the peak")

# %%
spectra = {name: ep.range_doppler(cube, radar) for name, cube in parts.items() if name != "other"}
powers = {name: ep.received_power(paths.select(way)) for name, way in ways.items()}
figure = plots.plot_partition(spectra, powers=powers, title="A walker 2.5 m beside a metal wall, by the way of the echo")
plots.show(figure)
