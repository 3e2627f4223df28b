"""Canonical targets, scenes and radars that tests of levels share."""
import functools

import numpy as np

import echopath as ep

from .radars import FREQUENCY, build_radar

WAVELENGTH = ep.speed_of_light / FREQUENCY      # m
METAL = ep.Material.metal()


def lambert(reflectivity):
    return ep.Material(reflectivity=reflectivity, scattering=1.0)


def unit(vectors):
    """Vectors [..., 3] of length 1, and their lengths [...]."""
    length = np.linalg.norm(vectors, axis=-1)
    return vectors / length[..., None], length


def quad(*corners):
    return ep.Mesh(np.array(corners, float), [[0, 1, 2], [0, 2, 3]])


def rectangle(corner, edge_a, edge_b):
    corner, a, b = (np.asarray(value, float) for value in (corner, edge_a, edge_b))
    return quad(corner, corner + a, corner + a + b, corner + b)


def plate(centre, normal, side, up=(0.0, 0.0, 1.0)):
    """A square whose horizontal edges are perpendicular to `up`."""
    across = np.cross(up, normal)
    across = across / np.linalg.norm(across)
    upward = np.cross(normal, across) / np.linalg.norm(normal)
    return rectangle(np.asarray(centre) - 0.5 * side * (across + upward), side * across, side * upward)


def sphere(centre, radius, subdivisions):
    """An icosphere of 20 * 4^subdivisions triangles."""
    points, faces = _unit_sphere(subdivisions)
    return ep.Mesh(np.asarray(centre) + radius * points, faces)


@functools.cache
def _unit_sphere(subdivisions):
    """Points [V, 3] and triangles [F, 3], which nobody changes."""
    golden = 0.5 * (1 + np.sqrt(5))
    points = np.array((
        (-1, golden, 0), (1, golden, 0), (-1, -golden, 0), (1, -golden, 0), (0, -1, golden), (0, 1, golden),
        (0, -1, -golden), (0, 1, -golden), (golden, 0, -1), (golden, 0, 1), (-golden, 0, -1), (-golden, 0, 1)))
    points = points / np.hypot(1, golden)
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6),
             (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10),
             (8, 6, 7), (9, 8, 1)]
    for _ in range(subdivisions):
        points, faces = _subdivided(points, np.array(faces))
    return points, faces


def _subdivided(points, faces):
    """Each triangle in four, whose new corners come in the order of the edges a b, b c and c a of all."""
    edges = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    _, first, index = np.unique(edges @ [len(points), 1], return_index=True, return_inverse=True)
    order = np.argsort(first)
    between = points[edges[first[order]]].sum(axis=1)
    middles = between / np.linalg.norm(between, axis=1)[:, None]
    (a, b, c), (ab, bc, ca) = faces.T, (len(points) + np.argsort(order)[index]).reshape(-1, 3).T
    fine = np.stack([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]])
    return np.concatenate([points, middles]), fine.transpose(2, 0, 1).reshape(-1, 3)


def scene_of(**objects):
    """Scene of name=(mesh, material) or (mesh, material, smooth)."""
    scene = ep.Scene()
    for name, (mesh, material, *smooth) in objects.items():
        scene.add(mesh, name=name, material=material, smooth=bool(smooth and smooth[0]))
    return scene


def curved_scene():
    """A smooth ball that throws light on a plate: its paths have all optional columns."""
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.3), name="ball", material="metal", position=(5, 0, 0), smooth=True)
    scene.add(ep.actors.plate(1.0, 1.0), name="plate", material="metal", position=(4.5, 1.2, 0), yaw=1.0)
    return scene


def make_radar(transmitter, receiver=None, polarization=(0.0, 0.0, 1.0), frequency=FREQUENCY):
    """1 W, isotropic antennas, one chirp."""
    places = (transmitter, transmitter if receiver is None else receiver)
    antennas = [ep.Antenna(place, polarization=polarization) for place in places]
    return build_radar(antennas[:1], antennas[1:], start_frequency=frequency, num_samples=512, transmit_power=1.0)


def fields(paths):
    """[P] amplitudes with the phase of their lengths, sqrt(W)."""
    cycles = paths.lengths([paths.frame.trace_time])[0] * (paths.radar.waveform.start_frequency / ep.speed_of_light)
    return paths.amplitude * np.exp(-2j * np.pi * np.mod(cycles, 1.0))


def power_by_hit(paths, of_mesh):
    """Mean power of diffuse paths in W: paths over the same hit on mesh `of_mesh` share its phase and add as fields."""
    if paths.num_paths == 0:
        return 0.0
    starts = np.asarray(paths.offsets, int)
    row = np.full(paths.num_paths, -1)
    for k in range(int(paths.num_bounces.max())):
        inside = k < paths.num_bounces
        found = inside & (row < 0)
        at = np.where(inside, starts + k, 0)
        row = np.where(found & (paths.mesh_id[at] == of_mesh), at, row)
    group = np.zeros(len(row), np.int64)
    for key in (paths.triangle_id[row], paths.u[row].view(np.uint32), paths.v[row].view(np.uint32)):
        _, group = np.unique(group << 32 | key, return_inverse=True)
    field = fields(paths)
    return float(np.sum(np.bincount(group, field.real) ** 2 + np.bincount(group, field.imag) ** 2))


def decibel(power):
    return 10 * np.log10(power)
