"""
Frames in time
==============

One car drives away, another is parked ahead of it; the radar stands still in one film and drives in the other. `ep.Sequence`
simulates one frame after the other, a folder keeps their maps, and `to_xarray` stacks these to range over time.
"""
import tempfile

import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

scene = ep.Scene()
rough = ep.Material(conductor=True, scattering=1.0)
scene.add(ep.actors.box((4, 1.8, 1.4)), name="driving car", material=rough, position=(8, 1.5, 0.9), speed=8)
scene.add(ep.actors.box((4, 1.8, 1.4)), name="parked car", material=rough, position=(26, -2.5, 0.9))

chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=500e6, num_samples=256, sampling_rate=20e6, num_chirps=64,
                          chirp_interval=60e-6)
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 0.6))], receivers=[ep.Antenna((0, 0.01, 0.6))], transmit_power=0.1)
radars = {"The radar stands still": radar, "The radar drives at 5 m/s": radar.replace(speed=5)}
maps = {}
for title, one in radars.items():
    sequence = ep.Sequence(scene, one, frames=24, interval=0.1, num_rays=2000, guard=False)
    with tempfile.TemporaryDirectory() as folder:
        maps[title] = sequence.save(folder, keep="maps").to_xarray().power.load()  # [time, range, velocity] in dBm

# %%
# Of each frame and range the strongest velocity. The backs of both cars are where the closed form puts them.
figure, plots = plt.subplots(1, 2, figsize=(10, 4.5), sharey=True, layout="constrained")
for axes, (title, power), own in zip(plots, maps.items(), (0, 5)):
    level = power.max("velocity")
    floor = float(level.median())  # the noise
    image = axes.pcolormesh(level.range, level.time, level, cmap="inferno", vmin=floor, vmax=floor + 45, shading="nearest")
    for car, place, speed, colour in (("driving", 6, 8, "cyan"), ("parked", 24, 0, "lime")):
        side = 0.6 if speed else 1.6  # m, from the radar's way to the near edge of the car
        ahead = place + (speed - own) * level.time
        axes.plot(np.hypot(ahead, side), level.time, ":", color=colour, label=f"back of the {car} car")
    axes.set(xlabel="Range in m", xlim=(0, 36), title=title)
plots[0].set(ylabel="Start of the frame in s")
plots[0].legend(loc="upper left", facecolor="0.2", labelcolor="white")
figure.colorbar(image, ax=plots, label="Received power in dBm")
plt.show()
