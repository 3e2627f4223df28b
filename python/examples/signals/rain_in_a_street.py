"""
Rain in a street
================

The same street without and with a downpour of 25 mm/h: its drops fill the ranges about the radar with clutter that moves with
the wind, and what lies far away is weaker by 2 dB for each 100 m, there and back.
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

downpour = ep.Weather(rain_mm_per_hour=25, wind=(-4, 0, 0))
chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=300e6, num_samples=256, sampling_rate=20e6, num_chirps=128,
                          chirp_interval=30e-6)
pattern = ep.CosinePower(exponent=40.0)
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 0.6), pattern=pattern)],
                 receivers=[ep.Antenna((0, 0.01, 0.6), pattern=pattern)])


def street(weather):
    scene = ep.Scene(weather=weather)
    scene.add(ep.actors.ground((140, 20)), name="road", material="asphalt_road", position=(70, 0, 0))
    scene.add(ep.actors.car(), name="car", position=(45, 1, 0), yaw=np.pi, speed=9)
    scene.add(ep.actors.pedestrian(), name="pedestrian", position=(20, -1, 0), speed=1.3)
    ep.mark_mirrors(scene, radar)  # the road: echoes over it are found by images
    return ep.simulate(scene, radar, num_rays=300_000)


frames = {"dry": street(None), "25 mm/h, wind toward the radar": street(downpour)}
wet = frames["25 mm/h, wind toward the radar"]
for effect in wet.effects:
    if effect.name in ("attenuation by weather", "echoes of rain"):
        print(f"{effect.name}: {effect.reason}")

# %%
# The maps of both.
figure, axes = plt.subplots(1, 2, figsize=(11, 4.5), layout="constrained", sharey=True)
for one, (title, frame) in zip(axes, frames.items()):
    frame.plot(ax=one, vmin=-135, vmax=-85, title=title)
    one.set(xlim=(0, 80), ylim=(-15, 15))
plt.show()
