"""
A ball that is carried
======================

A street is watched while somebody carries a metal ball through it. ``ep.Live`` shoots only the rays again that the ball may
touch, and changes only their part of the signal: the map follows in a small part of the time of a new one, and is the same.
"""
import time

import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

scene = ep.Scene()
concrete = ep.materials["concrete"].replace(scattering=0.3, mirror=True)
scene.add(ep.actors.ground((60, 20)), name="road", material=concrete, position=(25, 0, 0))
for k, (x, y, yaw) in enumerate([(9, -4, 0.1), (15, 4, np.pi), (22, -4, 0.0), (30, 4, np.pi), (38, -4, 0.05)]):
    scene.add(ep.actors.car(), name=f"car_{k}", position=(x, y, 0), yaw=yaw)
scene.add(ep.actors.standing_person(), name="person", position=(18, 2.0, 0))
scene.add(ep.actors.sphere(0.25, edge=0.02), name="ball", material=ep.Material.metal(), smooth=True)
chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=500e6, num_samples=256, sampling_rate=20e6, num_chirps=64,
                          chirp_interval=100e-6)
pattern = ep.CosinePower(8.0)
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 1), pattern=pattern)],
                 receivers=[ep.Antenna((0, 0.01, 1), pattern=pattern)])

# %%
# Eighty steps, from in front of the radar between the cars to the end of the street. Each view is kept for the picture.
way = np.linspace((6.0, 0.0, 1.2), (42.0, 1.0, 1.2), 80)
live, views = ep.Live(scene, radar, num_rays=20_000), []
for place in way:
    live.scene["ball"].position = place
    views.append(live.update())
print(views[0], views[40], sep="\n")
began = time.perf_counter()
fresh = ep.Live(live.scene, radar, num_rays=20_000).update()
seconds = time.perf_counter() - began
error = np.abs(views[-1].cube - fresh.cube).max() / np.abs(fresh.cube).max()
print(f"a fresh view takes {1e3 * seconds:.0f} ms and differs by {error:.1e} of the largest sample")

# %%
# Lines are what stands still: the road, cars, the person. The ball goes from 6 to 42 m; its echo beats with that of its image
# in the road.
power = np.array([np.abs(view.map.values[0, 0, np.argmin(np.abs(view.map.velocity))]) ** 2 for view in views])
ranges = views[0].map.range
far = power[:, ranges > 5.0]
steps = np.arange(len(views))
figure, (upper, lower) = plt.subplots(2, 1, figsize=(9, 8), layout="constrained", sharex=True, height_ratios=(3, 2))
highest = 10 * np.log10(far.max()) + 30  # dBm
image = upper.pcolormesh(steps, ranges, 10 * np.log10(power.T + 1e-30) + 30, shading="nearest", cmap="magma", vmax=highest,
                         vmin=highest - 60)
upper.plot(steps, np.linalg.norm(way - (0, 0, 1), axis=1) + 1.5, ":", color="white", label="range of the ball plus 1.5 m")
upper.set(ylabel="Range in m", ylim=(0, 48), title="What the radar sees while the ball is carried down the street")
upper.legend(loc="lower right", facecolor="black", labelcolor="white")
figure.colorbar(image, ax=upper, label="Received power at 0 m/s in dBm")
lower.bar(steps[1:], [100.0 * view.num_rays_shot / view.num_rays for view in views[1:]], width=0.8)
lower.set(xlabel="Step of the ball", ylabel="Rays shot again in %", ylim=(0, None))
plt.show()
