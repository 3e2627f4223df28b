"""Single paths over mirrors at points that have slid from where they reflect, and a search of the true points."""
import numpy as np
from scipy.optimize import root

import echopath as ep

from . import shapes

TRANSMITTER, TARGET = np.zeros(3), np.array([20.0, 0.0, 0.0])
ROUGH = ep.Material(reflectivity=0.5, scattering=1.0)


class Ball:
    """Part of a sphere around `top`, where the unit vector `normal` stands on it; radius in m, negative: hollow."""

    def __init__(self, top, normal, radius):
        self.top, self.normal, self.radius = np.asarray(top, float), np.asarray(normal, float), radius
        first = np.cross(self.normal, [0.0, 0.6, 0.8])
        self.axes = np.stack([first / np.linalg.norm(first), np.cross(self.normal, first / np.linalg.norm(first))])

    def at(self, offsets):
        """Points of the surface over tangential offsets [..., 2] in m."""
        centre = self.top - self.radius * self.normal
        outward = np.asarray(offsets) @ self.axes + self.radius * self.normal
        return centre + abs(self.radius) * outward / np.linalg.norm(outward, axis=-1, keepdims=True)

    def mesh(self, cells=40):
        width = 0.8 * min(abs(self.radius), 1.0)
        steps = np.linspace(-width / 2, width / 2, cells + 1)
        vertices = self.at(np.stack(np.meshgrid(steps, steps, indexing="ij"), axis=-1).reshape(-1, 2))
        first = np.arange(cells * (cells + 1)).reshape(cells, cells + 1)[:, :-1].ravel()
        return ep.Mesh(vertices, np.concatenate([np.stack([first, first + 1, first + cells + 2], axis=1),
                                                 np.stack([first, first + cells + 2, first + cells + 1], axis=1)]))


class Plane(Ball):
    def __init__(self, top, normal):
        super().__init__(top, normal, np.inf)

    def at(self, offsets):
        return self.top + np.asarray(offsets) @ self.axes

    def mesh(self):
        return ep.Mesh(self.at([[-9, -9], [9, -9], [9, 9], [-9, 9]]), [[0, 1, 2], [0, 2, 3]])


def hit_near(mesh, point):
    """(triangle, u, v) of the point of the mesh next to `point`, which lies over one of its triangles or near an edge."""
    corners = mesh.vertices[mesh.triangles]
    edge_u, edge_v, along = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0], point - corners[:, 0]
    cross = np.cross(edge_u, edge_v)
    area = np.sum(cross**2, axis=1)
    u, v = np.sum(cross * np.cross(along, edge_v), axis=1) / area, np.sum(cross * np.cross(edge_u, along), axis=1) / area
    size = np.sqrt(np.sqrt(area))
    is_close = np.linalg.norm(corners.mean(axis=1) - point, axis=1) < 2 * size
    triangle = int(np.argmax(np.where(is_close, np.min([u, v, 1 - u - v], axis=0), -np.inf)))
    return triangle, max(u[triangle], 0.0), max(v[triangle], 0.0)


def one_path(scene, radar, points):
    """A record of one path over the meshes of the scene in their order, at rest, diffuse at the last of `points` [N, 3]."""
    hits = np.zeros(len(points), dtype=[("mesh_id", "u4"), ("triangle_id", "u4"), ("u", "f4"), ("v", "f4")])
    for k, (mesh, point) in enumerate(zip(scene.meshes, points)):
        hits[k] = (mesh.id, *hit_near(mesh.mesh, np.asarray(point, float) - scene.nodes[mesh.node].placement[:3, 3]))
    mean = [np.mean([antenna.position for antenna in side], axis=0) for side in (radar.transmitters, radar.receivers)]
    stratum = ep.Stratum(axis=[1, 0, 0], versine=2.0, num_rays=1, ray_density=1.0, name="all")
    middle = 0.5 * (radar.waveform.num_chirps * radar.waveform.chirp_interval)
    frame = ep.TraceFrame(start_time=0.0, trace_time=middle, transmitter=mean[0], receiver=mean[1], strata=[stratum], seed=1,
                          max_bounces=4, polarization="scalar", footprint="none", statistics=ep.TraceStatistics())
    last = 1 << (len(points) - 1)
    columns = {"offsets": np.array([0]), "num_bounces": np.array([len(points)], np.uint8),
               "diffuse": np.array([last], np.uint64), "weight": np.array([1], np.complex64),
               "stratum": np.zeros(1, np.uint16), "batch": np.zeros(1, np.uint8),
               "flags": np.zeros(1, np.uint32)}
    return ep.Paths.from_arrays(hits=hits, **columns, scene=scene, radar=radar, frame=frame)


def scene_with(mirrors, at=TARGET, motion=None, material=shapes.METAL):
    """Smooth mirrors, and a small rough plate `at`, which may move."""
    scene = ep.Scene()
    for k, mirror in enumerate(mirrors):
        scene.add(mirror.mesh(), name=f"mirror{k}", material=material, smooth=True)
    scene.add(shapes.plate((0, 0, 0), (-1.0, 0.3, 0.0), 0.02), name="target", material=ROUGH, position=at, motion=motion)
    return scene


def frozen(mirrors, slides, at=TARGET, radar=None, **keywords):
    """The path over points of the mirrors that lie tangential `slides` [N, 2] in m off their tops."""
    points = [mirror.at(slide) for mirror, slide in zip(mirrors, slides)]
    radar = shapes.make_radar(TRANSMITTER) if radar is None else radar
    return one_path(scene_with(mirrors, at, **keywords), radar, [*points, at])


def length_over(points):
    return np.sum(np.linalg.norm(np.diff(points, axis=0), axis=1))


def length_over_mirrors(mirrors, offsets, at, start=TRANSMITTER):
    return length_over([start, *(m.at(o) for m, o in zip(mirrors, np.reshape(offsets, (-1, 2)))), at])


def stationary_length(mirrors, at, start=TRANSMITTER):
    """Over the points near the tops where the length is stationary, by a search, m."""
    def length(offsets):
        return length_over_mirrors(mirrors, offsets, at, start)

    def gradient(offsets, step=1e-5):
        return np.array([length(offsets + e) - length(offsets - e) for e in step * np.eye(len(offsets))]) / (2 * step)

    return length(root(gradient, np.zeros(2 * len(mirrors)), tol=1e-12).x)


def excess_by_search(mirrors, slides, at):
    """How much longer the path over the slid points is than the one over the points where the length is stationary, m."""
    return length_over_mirrors(mirrors, slides, at) - stationary_length(mirrors, at)


def bisector(point, before, behind):
    both = (before - point) / np.linalg.norm(before - point) + (behind - point) / np.linalg.norm(behind - point)
    return both / np.linalg.norm(both)


def mirrors_over(tops, at, radii):
    """Planes or balls (finite radii in m, negative: hollow) that reflect the path from TRANSMITTER over the points `tops` to
    `at`, all [3]."""
    chain = [TRANSMITTER, *tops, at]
    normals = [bisector(chain[k], chain[k - 1], chain[k + 1]) for k in range(1, len(chain) - 1)]
    return [Plane(top, normal) if np.isinf(radius) else Ball(top, normal, radius)
            for top, normal, radius in zip(tops, normals, radii)]
