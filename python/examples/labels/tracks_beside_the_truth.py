"""
Tracks beside the truth
=======================

Two cars pass each other while a person walks beside the road. Detections of each frame become tracks, ``ep.truth`` has the boxes
that they belong to. A detector and a tracker of your own can be judged the same way.
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

scene = ep.Scene()
scene.add(ep.actors.car(), name="coming", position=(32, 2, 0), yaw=np.pi, speed=9.0)
scene.add(ep.actors.car(), name="going", position=(13, -2, 0), speed=7.0)
scene.add(ep.actors.pedestrian(speed=1.4, duration=3.0), name="walker", position=(16, 5, 0), yaw=-np.pi / 2)
chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=400e6, num_samples=128, sampling_rate=10e6, num_chirps=64,
                          chirp_interval=60e-6)
receivers = [ep.Antenna((0, 0.5 * number * chirps.wavelength, 0.8)) for number in range(16)]
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 0.8))], receivers=receivers, transmit_power=1.0)
frames = [ep.simulate(scene, radar, num_rays=10_000, start_time=start, detections=True, guard=False)
          for start in np.arange(16) * 0.1]

# %%
# The truth has a row for each object and frame; tracks are named by the box that they follow.
truth = ep.truth(frames)
tracks = ep.track([frame.detections for frame in frames], truth.of_object("walker").time, truth=truth, range_std=0.4,
                  merge_distance=2.5)
for name in ("coming", "going", "walker"):
    rows, true = tracks.object == name, truth.of_object(name)
    speed = np.hypot(*tracks.state[rows][-1, 2:])
    print(f"{name:7} tracked in {rows.sum():2} of {len(frames)} frames, at the end {speed:.1f} m/s "
          f"(truth {np.linalg.norm(true.velocity[-1]):.1f} m/s), {true.rcs_dbsm.mean():.1f} dBsm in the mean")

# %%
# From above: the boxes of the first frame dotted and of the last one in full, the tracks in colour.
figure, axes = plt.subplots(figsize=(6, 7), layout="constrained")
for frame, style in ((0, ":"), (15, "-")):
    for corners in truth.of_frame(frame).corners:
        x, y = corners[[0, 2, 6, 4, 0], :2].T
        axes.plot(y, x, style, color="0.4", linewidth=1)
tracks.plot(ax=axes, title="Tracks of detections, and the boxes that they follow")
plt.show()
