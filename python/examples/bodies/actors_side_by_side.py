"""
What actors there are
=====================

Vehicles, people, animals and what stands beside a road come as actors: named parts with materials and motions of their own.
Each is drawn from its right side, the row of parked cars from ahead, to one scale, coloured by its parts.
"""
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

import echopath as ep

a = ep.actors
rows = [[("car, small", a.car(kind="small")), ("car, compact", a.car()), ("car, saloon", a.car(kind="saloon")),
         ("car, estate", a.car(kind="estate"))],
        [("car, suv", a.car(kind="suv")), ("van", a.van()), ("motorcycle", a.motorcycle()), ("cyclist", a.cyclist())],
        [("truck", a.truck()), ("tree", a.tree(height=4.5, crown_radius=1.4)),
         ("pole", a.pole(height=4.5))],
        [("pedestrian", a.pedestrian()), ("runner", a.runner()), ("standing_person", a.standing_person()),
         ("child", a.child()), ("dog", a.dog()), ("bicycle", a.bicycle()), ("traffic_sign", a.traffic_sign()),
         ("guard_rail", a.guard_rail(length=4.0)), ("drone", a.drone())],
        [("parked_row, from ahead", a.parked_row())]]


def draw(axes, name, actor, left, ground):
    """Paints the triangles from far to near; returns the next actor's place."""
    scene = ep.Scene()
    scene.add(actor, name="actor", yaw=-np.pi / 2 if "from ahead" in name else 0.0)
    colors = plt.get_cmap("tab20")(np.arange(len(scene.meshes)) % 20)[:, :3]
    faces, shades = [], []
    for mesh, color in zip(scene.meshes, colors):
        corners = scene.world_vertices(mesh.id, 0.0)[np.asarray(mesh.triangles)]
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        light = 0.55 + 0.45 * np.abs(normal @ [0.3, 0.5, 0.8]) / np.maximum(np.linalg.norm(normal, axis=1), 1e-12)
        faces.append(corners)
        shades.append(color * light[:, None])
    faces, shades = np.concatenate(faces), np.concatenate(shades)
    order = np.argsort(-faces[:, :, 1].mean(axis=1))
    shift = left - faces[..., 0].min()
    axes.add_collection(PolyCollection(faces[order][:, :, [0, 2]] + [shift, ground], facecolors=shades[order],
                                       edgecolors=shades[order], linewidths=0.1), autolim=False)
    right = shift + faces[..., 0].max()
    axes.text(0.5 * (left + right), ground - 0.15, name, ha="center", va="top", fontsize=7.5)
    return max(right + 0.5, left + 2.3)


# %%
# Names of parts are paths: ``"car/wheel/*"`` takes what turns, ``"cyclist/rider/leg_*"`` both legs.
figure, axes = plt.subplots(figsize=(11, 9.0), layout="constrained")
ground = 0.0
for row, drop in zip(rows, (3.2, 5.3, 4.0, 3.2, 0.0)):
    place = 0.0
    for name, actor in row:
        place = draw(axes, name, actor, place, ground)
    ground -= drop
axes.set(xlim=(-0.9, 23.5), ylim=(-16.3, 1.8), xlabel="Length in m", yticks=[],
         ylabel="Five rows, each on its own ground; as high as long",
         title="Actors, from the side")
axes.set_aspect("equal")
plt.show()
