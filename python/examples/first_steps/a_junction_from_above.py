"""
A junction from above
=====================

Cars, a cyclist and a pedestrian follow trajectories over a junction. One car turns left by an arc, after it has waited; the
other changes lanes; wheels roll, and feet stay on the ground. Bodies are drawn every two seconds, from their meshes.
"""
import matplotlib.pyplot as plt
import numpy as np

import echopath as ep

street = ep.Lane([(-40, -1.75), (40, -1.75)])
movers = {
    "turning car": (ep.actors.car, ep.Trajectory([(-40, -1.75), (1.75, -1.75), (1.75, 35)], turn_radius=7, speed=11,
                                                 lateral_acceleration=2.5, stops=[(32, 1.0)])),
    "oncoming van": (ep.actors.van, street.trajectory(speed=12, offset=2 * street.width, reverse=True,
                                                      changes=[(22, 30, street.width)])),
    "cyclist": (ep.actors.cyclist, ep.Trajectory([(-1.75, 38), (-1.75, -30)], speed=[(0, 5), (40, 7)])),
    "pedestrian": (ep.actors.pedestrian, ep.Trajectory([(20, -9), (14, -7), (12, 2), (12, 12)], speed=1.5,
                                                       stops=[(0, 0.5), (6, 1.0)], acceleration=1.0, deceleration=1.0)),
}
scene = ep.Scene()
for name, (actor, trajectory) in movers.items():
    scene.add(actor(trajectory=trajectory), name=name)

# %%
# Seen from above, and the speeds: braking and waiting before the turn, slow in the curve.
figure, (above, below) = plt.subplots(2, figsize=(9, 9), height_ratios=[3, 1], layout="constrained")
for x in (-3.5, 3.5):      # the edges of a street of two lanes and of one of three
    above.plot([x, x, 42 * np.sign(x)], [40, 7, 7], color="0.6", lw=1)
    above.plot([x, x, 42 * np.sign(x)], [-40, -3.5, -3.5], color="0.6", lw=1)
for index, (name, (_, trajectory)) in enumerate(movers.items()):
    times = np.linspace(0, trajectory.end, 400)
    above.plot(*trajectory.position(times)[:, :2].T, color=f"C{index}", lw=1, label=name)
    for time in np.arange(0, min(trajectory.end, 15), 2):
        for mesh in scene[name].meshes:
            above.plot(*scene.world_vertices(mesh.id, time)[::3, :2].T, ",", color=f"C{index}")
    below.plot(times, trajectory.speed(times), color=f"C{index}")
above.set(xlabel="x in m", ylabel="y in m", aspect="equal", xlim=(-42, 42), ylim=(-28, 38),
          title="Tracks, and bodies every 2 s")
above.legend(loc="upper left")
below.set(xlabel="Time in s", ylabel="Speed in m/s", xlim=(0, 15), title="Speed along the tracks")
plt.show()
