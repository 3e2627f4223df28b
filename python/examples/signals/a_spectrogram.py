"""
Micro-Doppler of a walking person
=================================

Two seconds are fifty frames, whose chirps follow each other without a gap. ``ep.spectrogram`` makes one picture of them: torso
in the middle, arms and legs swinging about it. The same of each limb says which cell is whose.
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

scene = ep.Scene()
scene.add(ep.actors.pedestrian(speed=1.3, duration=3.0), name="walker", position=(8, 0, 0), yaw=np.pi)
chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=500e6, num_samples=64, sampling_rate=5e6, num_chirps=256,
                          chirp_interval=160e-6)
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 1))], receivers=[ep.Antenna((0, 0.01, 1))], transmit_power=10.0)
length = chirps.num_chirps * chirps.chirp_interval
limbs = {"arms": "T 'walker/arm_*'+ R", "legs": "T 'walker/leg_*'+ R", "torso and head": "T 'walker'+ R"}

# %%
# Frames are made one after the other and forgotten. Rough surfaces keep their scatterers from frame to frame, so that windows of
# 128 chirps may slide over the edges.
whole, parts = [], {name: [] for name in limbs}
for frame in ep.Sequence(scene, radar, frames=50, interval=length, num_rays=5000, parts=limbs, tolerance=1e-4, guard=False):
    whole.append(frame.noisy_cube)
    for name in limbs:
        parts[name].append(frame.parts["parts"][name])
settings = {"window_length": 128, "hop": 32, "span_frames": True}
spectrogram = ep.spectrogram(whole, radar, **settings)
labels = ep.spectrogram_labels({name: ep.spectrogram(cubes, radar, **settings) for name, cubes in parts.items()}, spectrogram)
print(spectrogram, labels, sep="\n")

# %%
# Velocities are negative: she comes nearer. Feet reach four times the walking speed, and stand still when they carry her.
figure, axes = plt.subplots(2, 1, figsize=(9, 8), layout="constrained", sharex=True)
spectrogram.plot(ax=axes[0], title="Two seconds of a walking person")
labels.plot(ax=axes[1], title="Which part of the body made each cell")
axes[0].axhline(-1.3, color="white", linestyle=":")
axes[0].annotate("walking speed", (0.02, -1.2), color="white")
axes[1].set_ylim(axes[0].get_ylim())
plt.show()
