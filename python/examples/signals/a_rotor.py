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
# A short Fourier transform over the chirps, at the range of the rotor.
span, step = 64, 16
cell = round(distance / chirps.range_resolution)
slow_time = cube[0, 0] @ np.exp(-2j * np.pi * np.arange(chirps.num_samples) * cell / chirps.num_samples)
starts = np.arange(0, chirps.num_chirps - span, step)
window = np.hanning(span)
columns = [np.fft.fftshift(np.abs(np.fft.fft(slow_time[start:start + span] * window, 256)) ** 2) for start in starts]
velocity = np.fft.fftshift(np.fft.fftfreq(256, chirps.chirp_interval)) * chirps.wavelength / 2
time = (starts + span / 2) * chirps.chirp_interval

level = 10 * np.log10(np.array(columns).T + 1e-30)
figure, axes = plt.subplots(figsize=(9, 4.5), layout="constrained")
image = axes.pcolormesh(time * 1e3, velocity, level - level.max(), vmin=-40, vmax=0, cmap="inferno")
for sign in (1, -1):
    axes.plot(time * 1e3, -sign * 2 * np.pi * turns * arm * np.cos(2 * np.pi * turns * time), "c:",
              label="closed form" if sign > 0 else None)
axes.set(xlabel="Time in ms", ylabel="Radial velocity in m/s", title="Two balls on a rotor of 0.3 m at eight turns a second")
axes.legend(loc="upper right", facecolor="0.2", labelcolor="white")
figure.colorbar(image, label="Power over its peak in dB")
plt.show()
