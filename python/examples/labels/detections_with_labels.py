"""
Detections that know who made them
==================================

CFAR finds what stands out of the noise. Because the paths behind each echo are known, every detection bears the object that
made it, or the ghost that it is.
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

half = 0.5 * ep.speed_of_light / 77.5e9
radar = ep.Radar(ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=256, sampling_rate=20e6, num_chirps=64,
                                  chirp_interval=100e-6),
                 transmitters=[ep.Antenna((0, 4 * half * m, 1)) for m in range(2)],
                 receivers=[ep.Antenna((0, half * n, 1)) for n in range(4)], transmit_power=1.0)
scene = ep.Scene()
scene.add(ep.actors.pedestrian(speed=1.4), name="walker", position=(9, -0.5, 0), yaw=np.pi)
scene.add(ep.actors.box((3.5, 1.7, 1.3)), name="car", position=(14, -2.5, 0.8),
          material=ep.Material(conductor=True, scattering=0.7), motion=ep.LinearMotion(velocity=(4, 0, 0)))
scene.add(ep.actors.wall(30, 4), name="wall", material=ep.Material.metal(mirror=True), position=(12, 3, 0))
frame = ep.simulate(scene, radar, num_rays=40_000, detections={"false_alarm_rate": 1e-5}, guard=False)

# %%
# ``points`` are places in the radar's frame. Ghosts that took the wall both ways lie behind it; of those that took it one way
# transmitters and receivers see different directions, so that the array puts them anywhere about these.
found, points = frame.detections, frame.detections.points
figure, axes = plt.subplots(figsize=(9, 6.5), layout="constrained")
for name, colour in (("walker", "tab:blue"), ("car", "tab:orange")):
    for is_ghost, marker, what in ((False, "o", ""), (True, "x", ", ghost")):
        chosen = np.array([one == name for one in found.object]) & ((found.ghost_type > 0) == is_ghost) & ~found.is_noise
        axes.plot(points[chosen, 1], points[chosen, 0], marker, color=colour, label=f"{name}{what}: {chosen.sum()}")
axes.plot(points[found.is_noise, 1], points[found.is_noise, 0], ".", color="0.6", label=f"noise: {found.is_noise.sum()}")
axes.axvline(3, color="0.3", linewidth=3, label="the wall")
axes.plot(0, 0, "k^", markersize=10, label="the radar")
axes.set(xlabel="To the left in m (right: −)", ylabel="Ahead in m", xlim=(10, 1.1 * points[:, 1].min()), ylim=(-1, 22),
         title="Detections seen from above", aspect="equal")
axes.legend(loc="lower right")
axes.grid(alpha=0.3)
plt.show()
