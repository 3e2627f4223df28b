"""
Wheels, legs and rotors
=======================

What moves within a body spreads its echo over velocity: the wheels of a cyclist, the legs of a runner, the rotors of a drone.
Each is seen for 26 ms from ahead, 12 m away.
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=300e6, num_samples=64, sampling_rate=10e6, num_chirps=1024,
                          chirp_interval=25e-6)
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 1))], receivers=[ep.Antenna((0, 0.01, 1))])
bodies = {"cyclist at 5 m/s": (ep.actors.cyclist(speed=5.0), 0.0, "wheels", "T .* 'body/bicycle/wheel_*' .* R"),
          "runner at 3 m/s": (ep.actors.runner(speed=3.0), 0.0, "legs", "T .* 'body/leg_*' .* R"),
          "drone that hovers": (ep.actors.drone(), 1.2, "rotors", "T .* 'body/rotor_*' .* R")}

# %%
# Tips of the rotors would be at 68 m/s, more than the radar's 39 m/s: they fold.
figure, panels = plt.subplots(3, 1, figsize=(8, 8), layout="constrained", sharex=True)
for axes, (title, (actor, height, label, expression)) in zip(panels, bodies.items()):
    scene = ep.Scene()
    scene.add(actor, name="body", position=(12, 0, height), yaw=np.pi)
    paths = ep.trace(scene, radar, num_rays=60_000, max_bounces=2)
    parts = ep.decompose(paths, radar, {label: expression, "the rest": "T .* R"})
    for name, color in (("the rest", "tab:gray"), (label, "tab:red")):
        spectrum = ep.range_doppler(parts[name], radar, window=("chebyshev", 70.0))
        power = np.sum(np.abs(spectrum.values[0, 0]) ** 2, axis=-1)
        axes.plot(spectrum.velocity, 10 * np.log10(power + 1e-22) + 30, color=color, label=name, linewidth=1)
    axes.set(ylim=(-170, -90), ylabel="Power in dBm", title=title)
    axes.legend(loc="upper right")
    axes.grid(alpha=0.3)
panels[-1].set(xlabel="Radial velocity in m/s", xlim=(-39, 39))
plt.show()
