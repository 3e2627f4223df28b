"""
Who hides whom
==============

A van drives between the radar and a person. ``visibility`` says how much of each object the radar can see and what hides the
rest, by straight lines.
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

scene = ep.Scene()
scene.add(ep.actors.box((0.4, 0.5, 1.75)), name="person", material="skin", position=(14, 0, 0.875))
scene.add(ep.actors.box((2.0, 4.5, 1.2)), name="van", material="metal", position=(9, -5, 0.6),
          motion=ep.LinearMotion(velocity=(0, 5, 0)))
chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=500e6, num_samples=128, sampling_rate=10e6, num_chirps=32,
                          chirp_interval=60e-6)
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 1))], receivers=[ep.Antenna((0, 0.01, 1))])

# %%
# The van is 1.2 m high: it never hides the head.
times = np.linspace(0, 2, 81)
person, van = np.array([[one.transmitter.visible_share for one in ep.visibility(scene, radar, time=time, num_directions=1024)]
                        for time in times]).T
figure, axes = plt.subplots(figsize=(8, 4), layout="constrained")
axes.plot(times, 100 * person, label="person")
axes.plot(times, 100 * van, "--", label="van")
axes.set(xlabel="Time in s", ylabel="Share in view in %", ylim=(0, 105),
         title="A van of 1.2 m height passes in front of a person")
axes.legend(loc="lower left")
axes.grid(alpha=0.3)
plt.show()
