"""Where rays, triangles and single precision meet badly."""
from __future__ import annotations

from collections import Counter

import numpy as np

import echopath as ep
from echopath import _core

from ...actors import shapes
from ...paths.absent import NO_MESH
from ..physics import closed_forms as exact
from ..physics.read_outs import field, rcs_of
from .case import Cases
from .scenes import (
    METAL,
    POWER,
    ROUGH,
    UTM,
    broadside_rcs,
    decibels,
    edge_points,
    make_radar,
    misses,
    plate_at,
    scene_of,
    traced,
)

cases = Cases("Geometry")
MOST_PATHS_AT_EDGES = 1e-3  # that corners rounded to other single precision numbers may take or give


def level_error(paths, distance: float, truth: float, keep=slice(None)) -> float:
    return abs(decibels(rcs_of(paths, distance, keep) / truth))


@cases("hit positions", "points rebuilt from (u, v) lie in the plane of their facet, at 300 m too: 1e-12 m and 1e-15 of the "
       "distance", bound=1.3e-12, unit="m",
       broken="points in single precision: 1.5e-5 m")
def hit_positions() -> float:
    scene = scene_of(("far", shapes.sphere(2.0, subdivisions=8), ROUGH, {"position": (300.0, 3.0, 1.0)}))
    paths = traced(scene, make_radar(), 20_000, max_bounces=1)
    corners = np.asarray(scene.world_vertices(0, 0.0), np.longdouble)[np.asarray(scene.meshes[0].triangles, int)]
    facet = corners[np.asarray(paths.triangle_id, int)]
    normal = np.cross(facet[:, 1] - facet[:, 0], facet[:, 2] - facet[:, 0])
    normal /= np.sqrt((normal ** 2).sum(axis=1, keepdims=True))
    height = np.abs((normal * (paths.points(0.0) - facet[:, 0])).sum(axis=1))
    return float(height.max())


def street_scene(offset):
    return scene_of(("ball", shapes.sphere(0.4), ROUGH, {"position": tuple(offset + [6.0, 0.5, 0.25])}),
                    ("plate", shapes.plate(1.0, 2.0), METAL, {"position": tuple(offset + [8.0, -2.0, 0.0])}),
                    ("wall", shapes.wall(32.0, 8.0), ep.Material(permittivity=5 - 0.3j, scattering=0.4, mirror=True),
                     {"position": tuple(offset + [10.0, 2.0, -2.0])}))


def street(offset):
    return traced(street_scene(offset), make_radar(offset, baseline=0.125), 20_000)


@cases("world at UTM coordinates", "an offset of 5 400 km leaves what a million rays meet as it is (share that differs, or "
       "by more than a micrometre)", bound=1e-6,
       broken="rays in world coordinates instead of those about the scene: 0.028")
def utm_hits() -> float:
    directions = np.random.default_rng(1).normal((1.0, 0.0, 0.0), (0.05, 0.3, 0.3), (1_000_000, 3))
    met = [_core.bench.first_hits(street_scene(offset), np.broadcast_to(offset, directions.shape), directions)
           for offset in (np.zeros(3), UTM)]
    (mesh, triangle, distance, _), (other_mesh, other_triangle, other_distance, _) = met
    if np.mean(mesh != NO_MESH) < 0.3:
        return 1.0  # nothing to compare
    return float(np.mean((mesh != other_mesh) | (triangle != other_triangle) | (np.abs(distance - other_distance) > 1e-6)))


def path_keys(paths) -> list:
    """Of each path its weight, its events and where it hits, rounded: a ray's paths are alike wherever the world begins."""
    places = np.column_stack([paths.hits["triangle_id"], np.round(1e4 * paths.hits["u"])]).astype(np.int64).tolist()
    weights = np.round(1e5 * np.asarray(paths.weight)).tolist()
    return [(weight, diffuse, *map(tuple, places[begin:begin + count])) for weight, diffuse, begin, count
            in zip(weights, paths.diffuse.tolist(), paths.offsets.tolist(), paths.num_bounces.tolist())]


@cases("signal at UTM coordinates",
       "double precision resolves 9e-10 m there: relative change of the signal of the paths that "
       "both worlds have, all but a thousandth", bound=1e-5,
       broken="rays in world coordinates instead of those about the scene: 0.85 of the paths are others")
def utm_signal() -> float:
    records = street(np.zeros(3)), street(UTM)
    keys = [path_keys(paths) for paths in records]
    near, far = (Counter(of_record) for of_record in keys)
    shared = [np.array([near[key] == far[key] for key in of_record]) for of_record in keys]
    alone = 1.0 - min(mask.mean() for mask in shared)
    if alone > MOST_PATHS_AT_EDGES:
        return float(alone)
    one, two = (ep.synthesize(paths.select(mask), paths.radar) for paths, mask in zip(records, shared))
    return float(np.linalg.norm(one - two) / np.linalg.norm(one))


@cases("scene 10 km away", "a 1 m plate at broadside has its level", bound=0.1, unit="dB",
       broken="no rays aimed at objects: none meets the plate")
def ten_kilometres() -> float:
    paths = traced(scene_of(plate_at(1e4, 1.0)), make_radar(), 2 ** 15, max_bounces=1)
    return level_error(paths, 1e4, broadside_rcs(1.0, 1e4))


@cases("phase of a scene 10 km away", "a 1 m plate at broadside: phase of its echo beside that of its distance", bound=0.01,
       unit="rad",
       broken="lengths in single precision: 0.027 rad")
def ten_kilometres_phase() -> float:
    far = traced(scene_of(plate_at(1e4, 1.0)), make_radar(), 2 ** 15, max_bounces=1)
    total = np.sum(field(far)) * np.exp(2j * np.pi * np.mod(2e4 / exact.WAVELENGTH, 1.0))
    curvature = exact.WAVENUMBER * (1.0 / 12.0) / 1e4 * 2.0  # mean of k rho^2 / R over the face: rho^2 = 1/6 m^2
    return float(abs(abs(np.angle(total / -1j)) - curvature)) if total != 0 else np.inf


@cases("1 km beside 1 mm", "a plate of 1 mm over a ground of 1 km keeps its level", bound=0.1, unit="dB",
       broken="no rays aimed at objects: none meets the plate")
def kilometre_beside_millimetre() -> float:
    scene = scene_of(("ground", shapes.ground(1000.0, z=-1.0), ep.Material(reflectivity=0.3, scattering=1.0)),
                     plate_at(3.0, 1e-3))
    paths = traced(scene, make_radar(), 20_000, max_bounces=1)
    on_plate = np.asarray(paths.mesh_id)[paths.offsets] == 1
    return level_error(paths, 3.0, exact.plate_rcs(1e-3, 0.0), on_plate)


@cases("self intersection", "a convex metal sphere at 300 m returns single bounces only (share of paths with more)",
       bound=0.0,
       broken="origins not lifted off their surface: 6.4e-5")
def self_intersection() -> float:
    scene = scene_of(("sphere", shapes.sphere(0.5, subdivisions=24), METAL, {"position": (300.0, 0.0, 0.0), "smooth": True}))
    paths = traced(scene, make_radar(), 1_000_000, max_bounces=4)
    assert paths.num_paths > 250_000
    return float(np.mean(np.asarray(paths.num_bounces) > 1))


@cases("corner reflector at 300 m", "a trihedral of 0.1 m loses no rays to its own surfaces: level of its triple bounce",
       bound=0.1,
       unit="dB",
       broken="origins not lifted: 24 dB; lifted a thousand times as far: 0.17 dB")
def far_trihedral() -> float:
    scene = scene_of(("corner", shapes.trihedral(0.1), METAL, {"position": (300.0, 0.0, 0.0)}))
    paths = traced(scene, make_radar(), 2 ** 16, max_bounces=3)
    return level_error(paths, 300.0, exact.trihedral_rcs(0.1), np.asarray(paths.num_bounces) == 3)


@cases("edges of a closed box", "rays aimed from inside at shared edges that leak", bound=0.0, unit="rays",
       broken="Embree without its robust flag: 15 527 rays")
def box_edges() -> float:
    box = shapes.box(2.0, edge=0.25)
    return misses(scene_of(("box", box, METAL)), np.array([0.1, -0.2, 0.3]), edge_points(box, 300_000))


@cases("edges of a closed sphere", "the same on an icosphere of 2 880 facets", bound=0.0, unit="rays",
       broken="Embree without its robust flag: 14 485 rays")
def sphere_edges() -> float:
    ball = shapes.sphere(1.0, subdivisions=12)
    return misses(scene_of(("ball", ball, METAL)), np.array([0.3, 0.1, -0.2]), edge_points(ball, 300_000))


@cases("vertices", "of rays aimed exactly at vertices Embree may lose a few (its issues 181 and 188)", bound=1e-3,
       unit="of them",
       broken="Embree without its robust flag: 0.096")
def vertices() -> float:
    scene, lost, shot = scene_of(("ball", shapes.sphere(1.0, subdivisions=12), METAL)), 0, 0
    targets = np.asarray(scene.world_vertices(0, 0.0))
    for origin in np.random.default_rng(3).uniform(-0.5, 0.5, (20, 3)):
        lost, shot = lost + misses(scene, origin, targets), shot + len(targets)
    return lost / shot


@cases("grazing incidence", "amplitudes stay finite and below that of a mirror that faces the radar (points on a ground of "
       "20 m, 1 cm below and from 2 cm aside on, so that no image takes their place, are known to 1e-4 of their distance)",
       bound=1.0003, unit="of it", broken="an obliquity that does not fall with the cosine of incidence: 2.5")
def grazing() -> float:
    ground = "ground", shapes.ground(20.0, z=-1e-2), METAL, {"position": (10.02, 0.0, 0.0)}
    paths = traced(scene_of(ground), make_radar(), 100_000, max_bounces=1)
    largest = np.sqrt(POWER) / (4 * np.pi) / paths.frame.strata[-1].ray_density
    amplitude = np.asarray(paths.amplitude)
    assert paths.frame.statistics.num_grazing > 0 and paths.num_paths > 1000
    return float(np.abs(amplitude).max() / largest) if np.isfinite(amplitude).all() else np.inf


@cases("parallel plates", "paths of up to 64 bounces between metal plates: length beside that of the images, per bounce",
       bound=1e-9, unit="m",
       broken="points in single precision: 1.9e-6 m")
def parallel_plates() -> float:
    gap = 0.5
    scene = scene_of(("low", shapes.ground(60.0, z=-0.2), METAL), ("high", shapes.ground(60.0, z=gap - 0.2), METAL))
    radar = make_radar((0.0, 0.0, 0.0), baseline=0.01)
    paths = traced(scene, radar, 600, max_bounces=64)
    keep = np.flatnonzero(np.asarray(paths.flags) & 1 == 0)
    lengths, points = paths.lengths([paths.frame.trace_time])[0], paths.points(0.0)
    count, worst = np.asarray(paths.num_bounces, int), 0.0
    assert count.max() > 40
    for path in keep:
        hits = points[paths.offsets[path]:paths.offsets[path] + count[path]]
        expected = np.linalg.norm(hits[-1] - _image_over(hits[:-1, 2])) + np.linalg.norm(hits[-1] - [0.0, 0.01, 0.0])
        worst = max(worst, abs(lengths[path] - expected) / count[path])
    return worst


def _image_over(heights) -> np.ndarray:
    """The origin's image over level planes at these heights, in order of travel."""
    image = np.zeros(3)
    for z in heights:
        image[2] = 2 * round(float(z), 9) - image[2]
    return image


@cases("wedges", "metal plates at an angle turn every ray back after pi over the angle bounces at most, rounded up, and "
       "some only after as many, rounded down (beyond either, angles of 4.9 to 17 degrees)", bound=0.0, unit="bounces",
       broken="origins not lifted off their surface: 24")
def wedges() -> float:
    worst = 0.0
    for angle_deg in (4.9, 7.3, 11.0, 17.0):
        half = np.radians(0.5 * angle_deg)
        deep, high = -np.cos(half), np.sin(half)
        corners = ([[0, -1, 0], [0, 1, 0], [deep, 1, z], [deep, -1, z]] for z in (high, -high))
        scene = scene_of(*((name, ep.Mesh(four, [[0, 1, 2], [0, 2, 3]]), METAL, {"position": (5.0, 0.0, 0.0)})
                           for name, four in zip(("up", "down"), corners)))
        paths = traced(scene, make_radar(baseline=0.01), 4000, max_bounces=64)
        most = float(np.max(paths.num_bounces))
        worst = max(worst, most - np.ceil(180.0 / angle_deg), np.floor(180.0 / angle_deg) - most)
    return worst
