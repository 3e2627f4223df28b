"""
A radar that drives
===================

The radar moves with 10 m/s past posts at the roadside. What stands still approaches with the cosine of its bearing, so that
posts at one distance from its way lie on one curve in the map of range and velocity; what does not lie there moves by itself.
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

speed = 10.0
scene = ep.Scene()
rough = ep.Material(conductor=True, scattering=1.0)
for x in range(4, 31, 4):
    for side in (-1, 1):
        scene.add(ep.actors.capsule(0.08, 1.2), name=f"post_{x}_{side}", material=rough, position=(x, 3 * side, 0.6))
scene.add(ep.actors.box((4, 1.8, 1.4)), name="car", material=rough, position=(24, 0.5, 0.8),
          motion=ep.LinearMotion(velocity=(6, 0, 0)))

chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=500e6, num_samples=256, sampling_rate=20e6, num_chirps=128,
                          chirp_interval=60e-6)
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 0.6))], receivers=[ep.Antenna((0, 0.01, 0.6))], transmit_power=0.1,
                 speed=speed)
spectrum = ep.simulate(scene, radar, num_rays=40_000, guard=False).spectrum

# %%
# The dotted line is where still posts 3 m aside are expected: -speed times the cosine of the bearing.
level = 10 * np.log10(np.abs(spectrum.values[0, 0]) ** 2) + 30
floor = np.median(level)  # the noise
expected = np.linspace(3.01, 32, 300)
figure, axes = plt.subplots(figsize=(9, 4.5), layout="constrained")
image = axes.pcolormesh(spectrum.range, spectrum.velocity, level, cmap="inferno", vmin=floor, vmax=floor + 50)
axes.plot(expected, -speed * np.sqrt(1 - (3 / expected) ** 2), ":", color="cyan", label="still posts 3 m aside")
axes.annotate("car, 6 m/s", (22, -4), (15, -2), color="white", arrowprops={"arrowstyle": "->", "color": "white"})
axes.set(xlabel="Range in m", ylabel="Radial velocity in m/s", xlim=(2, 33), ylim=(-12, 0),
         title="Posts and a car, seen from a radar at 10 m/s")
axes.legend(loc="upper right", facecolor="0.2", labelcolor="white")
figure.colorbar(image, label="Received power in dBm")
plt.show()
