"""
A map from above
================

Range and azimuth of corner reflectors and a moving ball, by an array of three transmitters and four receivers that take
turns. The picture is drawn as the street would look from above, the radar at the bottom.
"""
import numpy as np

import echopath as ep
from echopath import plots

half = 0.5 * ep.speed_of_light / 77.5e9
pattern = ep.CosinePower(2)
transmitters = [ep.Antenna((0, 4 * half * m, 0), pattern=pattern) for m in range(3)]
receivers = [ep.Antenna((0, half * n, 0), pattern=pattern) for n in range(4)]
chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=256, sampling_rate=20e6, num_chirps=32,
                          chirp_interval=30e-6)
radar = ep.Radar(chirps, transmitters=transmitters, receivers=receivers, transmit_power=0.05)

scene = ep.Scene()
for name, distance, degrees in (("near", 6, -35), ("middle", 9, 10), ("far", 14, 30)):
    angle = np.radians(degrees)
    scene.add(ep.actors.trihedral(0.08), name=f"corner_{name}", material="metal", yaw=angle,
              position=(distance * np.cos(angle), distance * np.sin(angle), 0))
scene.add(ep.actors.sphere(0.25), name="ball", material="metal", smooth=True, position=(10, -2, 0),
          motion=ep.LinearMotion(velocity=(-6, 0, 0)))

# %%
# The phase between the transmitters' turns, which the ball's motion makes, is taken out at each velocity.
frame = ep.simulate(scene, radar, num_rays=40_000, angles={"combine": "peak", "window": ("chebyshev", 30)}, guard=False)
truth = ep.truth(frame)
places = dict(zip(truth.name, zip(truth.range, truth.azimuth)))
figure = plots.plot_range_azimuth(frame.range_azimuth, title="Three corners at 6, 9 and 14 m, a ball at 10 m", places=places)
plots.show(figure)
