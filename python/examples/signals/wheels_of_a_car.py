"""
Wheels of a car
===============

A car drives past at 8 m/s. Its body has one velocity, but wheels roll: where they touch the road they rest, at their top they
are twice as fast as the car. Parts of actors have names, so that the map comes apart into body and wheels.
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

scene = ep.Scene()
scene.add(ep.actors.car(kind="saloon", speed=8.0), name="car", position=(9.0, 3.0, 0.0))
chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=500e6, num_samples=64, sampling_rate=10e6, num_chirps=256,
                          chirp_interval=50e-6)
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 0.5))], receivers=[ep.Antenna((0, 0.01, 0.5))])
paths = ep.trace(scene, radar, num_rays=100_000, max_bounces=2)
parts = ep.decompose(paths, radar, {"tyres and rims": "T .* 'car/wheel/*' .* R", "all but the wheels": "T .* R"})

# %%
# Powers of all ranges together, over velocity.
figure, axes = plt.subplots(figsize=(8, 4), layout="constrained")
for name in ("all but the wheels", "tyres and rims"):
    spectrum = ep.range_doppler(parts[name], radar, window=("chebyshev", 70.0))
    power = np.sum(np.abs(spectrum.values[0, 0]) ** 2, axis=-1)
    axes.plot(spectrum.velocity, 10 * np.log10(power) + 30, label=name)
for speed, text in ((0.0, "road"), (8.0, "car"), (16.0, "top of a tyre")):
    axes.axvline(speed * np.cos(np.arctan2(3.0, 9.0)), color="0.6", linewidth=0.8)
    axes.text(speed * np.cos(np.arctan2(3.0, 9.0)) + 0.15, -62, text, fontsize=8, color="0.3")
axes.set(xlim=(-5, 19), ylim=(-150, -55), xlabel="Radial velocity in m/s", ylabel="Received power in dBm",
         title="A car at 8 m/s, body and wheels")
axes.legend(loc="center right")
axes.grid(alpha=0.3)
plt.show()
