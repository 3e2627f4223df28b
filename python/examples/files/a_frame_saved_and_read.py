"""
A frame saved and read
======================

A frame file holds scene, radar, paths and signals. Read back, its paths give the same bits, and can be synthesised again
with another waveform, without another trace.
"""
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

scene = ep.Scene()
scene.add(ep.actors.pedestrian(), name="walker", position=(6, 0, 0), yaw=np.pi)
scene.add(ep.actors.trihedral(0.05), name="corner", material="metal", position=(8, 1.5, 1))
chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=256, sampling_rate=20e6, num_chirps=64,
                          chirp_interval=100e-6)
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 1))], receivers=[ep.Antenna((0, 0.01, 1))], transmit_power=1.0)
frame = ep.simulate(scene, radar, num_rays=20_000, guard=False)

path = Path(tempfile.mkdtemp()) / "frame.h5"
ep.save_frame(frame, path)
again = ep.load_frame(path)
print("same cube:", np.array_equal(again.cube, frame.cube), f"- {path.stat().st_size / 1e6:.1f} MB")

# %%
# The same rays, seen with a quarter of the bandwidth and twice the chirps.
other = ep.ChirpSequence(start_frequency=77e9, bandwidth=250e6, num_samples=128, sampling_rate=10e6, num_chirps=128,
                         chirp_interval=100e-6)
other_radar = ep.Radar(other, transmitters=again.radar.transmitters, receivers=again.radar.receivers,
                       transmit_power=1.0)
coarse = ep.range_doppler(ep.synthesize(again.paths, other_radar), other_radar)

figure, panels = plt.subplots(1, 2, figsize=(11, 4.5), layout="constrained", sharex=True, sharey=True)
shown = {"as saved: 1 GHz, 6.4 ms": again.spectrum, "again: 250 MHz, 12.8 ms, no noise": coarse}
for axes, (title, spectrum) in zip(panels, shown.items()):
    level = 10 * np.log10(np.abs(spectrum.values[0, 0]) ** 2) + 30
    image = axes.pcolormesh(spectrum.range, spectrum.velocity, level, vmin=-125, vmax=-85, cmap="inferno")
    axes.set(xlabel="Range in m", xlim=(4, 10), ylim=(-4, 2), title=title)
panels[0].set_ylabel("Radial velocity in m/s")
figure.colorbar(image, ax=panels, label="Received power in dBm", extend="both")
plt.show()
