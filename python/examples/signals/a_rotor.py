"""
A rotor, and what one trace may do
==================================

Two small balls go round with eight turns a second. Their velocity swings as a sine over the frame, and so does their range.
A record of rays serves a frame while its points stay in sight; ``validity`` says whether they do. Here they do not, and the
record is renewed eight times.
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

turns, arm, distance = 8.0, 0.3, 5.0
scene = ep.Scene()
scene.add(name="rotor", position=(distance, 0, 0), motion=ep.LinearMotion(angular_velocity=(0, 0, 2 * np.pi * turns)))
for number, side in enumerate((arm, -arm)):
    scene.add(ep.actors.sphere(0.02), name=f"ball_{number}", parent="rotor", material=ep.Material(conductor=True, scattering=1.0),
              position=(0, side, 0))
chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=500e6, num_samples=128, sampling_rate=10e6, num_chirps=2048,
                          chirp_interval=40e-6)
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 0))], receivers=[ep.Antenna((0, 0, 0))])
paths = ep.trace(scene, radar, num_rays=2000)
cube = ep.synthesize(paths, radar, evaluate="samples", tolerance=1e-5, retrace="invalid", keyframes=8)
print(ep.validity(paths))

# %%
# A short Fourier transform over the chirps, at the ranges of the rotor: windows of 64 chirps in steps of 16. The faint upright
# lines are where the record was renewed: the phases of the rough balls begin anew there.
spectrogram = ep.spectrogram(cube, radar, window_length=64, hop=16, zero_pad=4, range_gate=(distance - 0.5, distance + 0.5))
figure, axes = plt.subplots(figsize=(9, 4.5), layout="constrained")
spectrogram.plot(ax=axes, title="Two balls on a rotor of 0.3 m at eight turns a second")
time = spectrogram.times
for sign in (1, -1):
    axes.plot(time, -sign * 2 * np.pi * turns * arm * np.cos(2 * np.pi * turns * time), "c:",
              label="closed form" if sign > 0 else None)
axes.legend(loc="upper right", facecolor="0.2", labelcolor="white")
plt.show()
