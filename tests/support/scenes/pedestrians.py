"""A pedestrian whose parts tests look at."""
import numpy as np

import echopath as ep

HEIGHT, SPEED = 1.78, 1.4  # m, m/s


class Person:
    """A pedestrian's parts evaluated at many times, as a scene does it."""

    def __init__(self, height, speed, **options):
        self.actor = ep.actors.pedestrian(height=height, speed=speed, start_time=-0.1, duration=4.0, **options)
        self.scene = ep.Scene()
        self.scene.add(self.actor, name="pedestrian")
        self.ids = {mesh.name.removeprefix("pedestrian/"): mesh.id for mesh in self.scene.meshes}
        self.parts = {part.name: part for part in self.actor.parts}

    def vertices(self, name, times):
        """[T, V, 3]"""
        return np.stack([self.scene.world_vertices(self.ids[name], float(t)) for t in times])

    def center(self, name, times):
        """[T, 3]"""
        return self.vertices(name, times).mean(axis=1)


def rotation(q):
    """Rotation matrix of a unit quaternion (w, x, y, z)."""
    w, v = q[0], q[1:]
    cross = np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
    return np.eye(3) + 2 * w * cross + 2 * cross @ cross
