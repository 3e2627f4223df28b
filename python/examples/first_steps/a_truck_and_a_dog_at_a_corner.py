"""
A truck and a dog at a corner
=============================

A trajectory moves more than a point: the trailer of a truck follows its hitch and cuts the corner, and a dog that turns beside it
trots with its paws on the ground. Frames in a row show its legs as micro-Doppler.
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

corner = ep.Trajectory([(2, -9), (24, -9), (24, 18)], turn_radius=9.0, speed=5.0)
walk = ep.Trajectory([(11, 3), (6, 3), (6, -1)], turn_radius=1.5, speed=1.8, stops=[(0, 0.3), (np.inf, 0)])
scene = ep.Scene()
for name, actor, trajectory in (("truck", ep.actors.truck, corner), ("dog", ep.actors.dog, walk)):
    scene.add(actor(trajectory=trajectory), name=name)

# %%
# The wheels' ways, and the bodies at some times: the trailer's wheels run inside those of the tractor.
figure, (above, film) = plt.subplots(1, 2, figsize=(12, 5), layout="constrained", width_ratios=[1, 1.5])
mesh_of = {mesh.name: mesh.id for mesh in scene.meshes}
for wheel, colour, label in (("truck/wheel/drive_left/rim", "C0", "rear wheel of the tractor"),
                             ("truck/wheel/trailer_2_left/rim", "C3", "wheel of the trailer")):
    way = np.array([scene.world_vertices(mesh_of[wheel], time).mean(axis=0) for time in np.arange(0.0, corner.end, 0.1)])
    above.plot(*way[:, :2].T, color=colour, label=label)
for name, times in (("truck", np.linspace(0.0, corner.end, 4)), ("dog", np.linspace(0.0, walk.end, 6))):
    for time in times:
        for mesh in scene[name].meshes:
            colour = "C2" if name == "dog" else "C3" if "trailer" in mesh.name else "C0"
            above.plot(*scene.world_vertices(mesh.id, time)[::4, :2].T, ",", color=colour)
above.set(xlabel="x in m", ylabel="y in m", aspect="equal", title="Truck at four times, dog (green) at six")
above.legend(loc="upper left")

# %%
# The frames of a sequence keep their scatterers, so that windows of the spectrogram slide over their edges. Of all echoes those
# that touch the dog alone: the trunk comes nearer, then goes across, while the legs swing to and fro and the paws stand still.
chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=500e6, num_samples=64, sampling_rate=5e6, num_chirps=512,
                          chirp_interval=160e-6)
radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 0.5))], receivers=[ep.Antenna((0, 0.01, 0.5))], transmit_power=10.0)
frames = ep.Sequence(scene, radar, frames=42, interval=512 * 160e-6, num_rays=800, tolerance=1e-4, guard=False)
ep.spectrogram(frames, part="dog", window_length=256, hop=64).plot(ax=film, title="Micro-Doppler of the dog")
plt.show()
