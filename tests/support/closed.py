"""Whether surfaces are closed and where an actor is, by counting edges and by adding what the scene says."""
from collections import Counter

import numpy as np

import echopath as ep
from echopath.actors.surfaces import joined


def scene_of(actor, name="a"):
    scene = ep.Scene()
    scene.add(actor, name=name)
    return scene


def boundary_edges(triangles):
    """Directed edges that no triangle beside them runs the other way."""
    count = Counter()
    for a, b, c in np.asarray(triangles).tolist():
        for edge in ((a, b), (b, c), (c, a)):
            count[edge] += 1
    return [edge for edge, number in count.items() if count[edge[::-1]] != number]


def joined_parts(actor, takes):
    """(vertices, triangles) of the parts whose name `takes`, with vertices at the same place made one."""
    return joined(*[(np.asarray(part.mesh.vertices) + part.position, np.asarray(part.mesh.triangles))
                    for part in actor.parts if takes(part.name)])


def volume_of(vertices, triangles):
    """By Gauss's theorem, in m^3; negative where a surface is inside out."""
    return np.linalg.det(np.asarray(vertices)[np.asarray(triangles)]).sum() / 6.0


def extent(actor, takes=lambda name: True, time=0.0):
    """Length, width and height [3], and the lowest z, over the parts whose name `takes`."""
    scene = scene_of(actor)
    points = np.concatenate([scene.world_vertices(mesh.id, time) for mesh in scene.meshes
                             if takes(mesh.name.removeprefix("a/"))])
    return np.ptp(points, axis=0), points[:, 2].min()
