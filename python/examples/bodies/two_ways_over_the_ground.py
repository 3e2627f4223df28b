"""
Two ways over the ground
========================

Over a metal ground an echo takes four ways: straight or over the ground, out and back. They interfere, and the power over
distance has lobes. A small ball follows the closed form of a point, the fourth power of abs(1 + (d/g) exp(-jk(g - d))), with
d the straight way and g that over the ground; the antennas are vertical, which a metal ground mirrors without turning the
field.
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

height, frequency = 0.5, 77e9
antenna = ep.Antenna((0, 0, height))
chirps = ep.ChirpSequence(start_frequency=frequency, bandwidth=1e9, num_samples=512, sampling_rate=20e6, num_chirps=1,
                          chirp_interval=30e-6)
radar = ep.Radar(chirps, transmitters=[antenna], receivers=[antenna])


# %%
# The band of a waveform blurs the lobes. ``received_power`` tells the power at the start frequency alone.
def received(distance, ground):
    """Power in W of the echoes of the ball, with or without a ground."""
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.05), name="ball", material="metal", smooth=True, position=(distance, 0, height))
    if ground:
        scene.add(ep.actors.ground((200, 20)), name="ground", material=ep.Material.metal(mirror=True))
    paths = ep.trace(scene, radar, num_rays=1024)
    return ep.received_power(paths.select("T .* 'ball' .* R")).coherent


distances = np.geomspace(10, 60, 50)
gain = [10 * np.log10(received(d, ground=True) / received(d, ground=False)) for d in distances]

fine = np.geomspace(10, 60, 4000)
over = np.hypot(fine, 2 * height)
turn = np.exp(-2j * np.pi * frequency / ep.speed_of_light * (over - fine))
closed_form = 40 * np.log10(np.abs(1 + fine / over * turn))

# %%
figure, axes = plt.subplots(figsize=(8, 4.5), layout="constrained")
axes.semilogx(fine, closed_form, color="0.6", label="closed form of a point")
axes.semilogx(distances, gain, "o", markersize=4, label="rays, with images in the ground")
axes.set(xlabel="Distance in m", ylabel="Gain over free space in dB", ylim=(-40, 18),
         title="Ball and radar 0.5 m above a metal ground")
axes.set_xticks([10, 20, 30, 40, 60], ["10", "20", "30", "40", "60"])
axes.minorticks_off()
axes.legend(loc="lower right")
axes.grid(alpha=0.3)
plt.show()
