"""Meshes as files have them: slivers, duplicates, faces without area, wrong windings."""
from __future__ import annotations

import numpy as np

import echopath as ep
from echopath import _core

from ...actors import shapes
from ...paths.absent import NO_MESH
from ..physics.read_outs import field, rcs_of
from .case import Cases
from .scenes import METAL, UTM, decibels, level_of, make_radar, plate_at, scene_of, traced

cases = Cases("Meshes")


def sliver_wall(width: float, height: float, count: int, distance: float):
    """A wall across the x axis of `count` pairs of slivers as high as the wall."""
    y = np.linspace(-width / 2, width / 2, count + 1)
    low, high = (np.column_stack([np.full(count + 1, distance), y, np.full(count + 1, z)])
                 for z in (-height / 2, height / 2))
    k = np.arange(count)
    top = k + count + 1
    faces = np.vstack([np.column_stack([k, k + 1, top]), np.column_stack([k + 1, top + 1, top])])
    return ep.Mesh(np.vstack([low, high]), faces)


@cases("slivers", "a plate cut into slivers of 1 : 10 000 has the level of the sound one", bound=0.02, unit="dB",
       broken="triangles flatter than 1 : 1000 taken for ones without area: no mesh is left")
def slivers() -> float:
    cut = scene_of(("plate", sliver_wall(0.1, 0.1, 10_000, 200.0), METAL))
    whole, parts = (rcs_of(traced(scene, make_radar(), 2 ** 14, max_bounces=1), 200.0)
                    for scene in (scene_of(plate_at(200.0)), cut))
    return abs(decibels(parts / whole))


def _sliver_hits(width: float, height: float, lean: float):
    """Share of 50 000 rays that a wall of slivers loses, 5 m away and turned by `lean` rad, and the errors [N] in m of the
    distances of the others."""
    random, count, span = np.random.default_rng(2), 50_000, 20_000 * width
    scene = ep.Scene()
    scene.add(sliver_wall(span, height, 20_000, 0.0), name="wall", material=METAL, position=(5.0, 0.0, 0.0), yaw=lean)
    across, up = random.uniform(-0.45, 0.45, (2, count)) * [[span], [height]]
    targets = np.column_stack([5.0 - np.sin(lean) * across, np.cos(lean) * across, up])
    mesh_id, _, distance, _ = _core.bench.first_hits(scene, np.zeros_like(targets), targets)
    is_met = mesh_id != NO_MESH
    return float(np.mean(~is_met)), np.abs(distance - np.linalg.norm(targets, axis=1))[is_met]


SLIVERS = ((1e-5, 1.0, 0.0), (1e-4, 10.0, 0.0), (1e-5, 10.0, 1.2), (1e-4, 100.0, 1.2))  # width, height in m, lean in rad


@cases("slivers of a wall", "of rays that meet slivers 1e5 to 1e6 times as long as wide few are lost",
       bound=1e-3, unit="of them",
       broken="points not met again in double precision: 0.48")
def sliver_walls() -> float:
    return max(_sliver_hits(*sliver)[0] for sliver in SLIVERS)


@cases("points on slivers", "their distances are right (the median, beside the rounding of (u, v), 6e-8 of the length)",
       bound=1e-7, unit="of the length",
       broken="points not met again in double precision: 1.6e-5")
def points_on_slivers() -> float:
    return max(float(np.median(_sliver_hits(*sliver)[1])) / sliver[1] for sliver in SLIVERS)


@cases("coplanar duplicates", "a plate that is there twice has the level of one", bound=0.05, unit="dB",
       broken="origins not lifted off their surface: no echo is left")
def duplicates() -> float:
    one = shapes.plate(0.1, 0.1)
    twice = ep.Mesh(np.vstack([one.vertices] * 2), np.vstack([one.triangles, np.asarray(one.triangles) + len(one.vertices)]))
    levels = [level_of(mesh, max_bounces=2) for mesh in (one, twice)]
    return abs(decibels(levels[1] / levels[0]))


@cases("two meshes in one plane", "the first one met takes the ray: level of one", bound=0.05, unit="dB",
       broken="origins not lifted off their surface: no echo is left")
def coplanar_meshes() -> float:
    one = rcs_of(traced(scene_of(plate_at(200.0)), make_radar(), 2 ** 14, max_bounces=1), 200.0)
    both = scene_of(plate_at(200.0), ("again", shapes.plate(0.1, 0.1), METAL, {"position": (200.0, 0.0, 0.0)}))
    return abs(decibels(rcs_of(traced(both, make_radar(), 2 ** 14, max_bounces=1), 200.0) / one))


# Placement of the second of two unit squares, whether it is turned over, and the area in m^2 that they have in common.
SQUARES = (((0.3, 0.4, 0.0), False, 0.42), ((0.3, 0.4, 0.0), True, 0.42), ((0.0, 0.0, 5e-6), False, 1.0),
           ((0.0, 0.0, 20e-6), False, 0.0), ((1.0, 0.3, 0.0), False, 0.0), ((1.0, 1.0, 0.0), True, 0.0))


@cases("report of coplanar surfaces", "two squares turned at random, at UTM coordinates: overlapping, turned over, 5 and 20 "
       "um apart, touching (largest error of the area told, 1 m^2 where one is told of that is none)", bound=1e-7,
       unit="m^2",
       broken="no limit of distance, no least overlap, or facing one way only: 1")
def coplanar_report() -> float:
    square = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
    faces, random, worst = np.array([[0, 1, 2], [0, 2, 3]]), np.random.default_rng(1), 0.0
    for shift, is_turned, area in SQUARES * 10:
        turn = np.linalg.qr(random.normal(size=(3, 3)))[0]
        two = faces[:, ::-1] if is_turned else faces
        meshes = ep.Mesh(UTM + square @ turn, faces), ep.Mesh(UTM + (square + shift) @ turn, two)
        scene = scene_of(("one", meshes[0], METAL), ("two", meshes[1], METAL))
        told = [overlap.area for overlap in scene.coplanar_overlaps()]
        worst = max(worst, abs(sum(told) - area), float(bool(told) != (area > 0.0)))
    return worst


@cases("triangles without area", "they are removed and counted; the record keeps its bits (bytes that differ)",
       bound=0.0,
       broken="such triangles kept: none is counted as removed")
def without_area() -> float:
    plate = shapes.plate(0.1, 0.1)
    bad_vertices = [[0, 0, 0], [0, 0.01, 0], [0, 0.02, 0]]
    n = len(plate.vertices)
    bad_triangles = [[0, 0, 1], [n, n + 1, n + 2], [1, 1, 1], [n, n + 2, n + 1]]
    broken = ep.Mesh(np.vstack([plate.vertices, bad_vertices]),
                     np.vstack([bad_triangles[:2], plate.triangles, bad_triangles[2:]]))
    assert broken.num_removed_triangles == 4 and list(broken.original_triangle) == [2, 3]
    records = [traced(scene_of(("plate", mesh, METAL, {"position": (200.0, 0.0, 0.0)})), make_radar(), 4000)
               for mesh in (plate, broken)]
    hits = [np.asarray(paths.hits).tobytes() for paths in records]
    weights = [np.asarray(paths.weight).tobytes() for paths in records]
    return float((hits[0] != hits[1]) + (weights[0] != weights[1]))


@cases("inverted normals", "a mesh turned inside out is the same target", bound=1e-12, unit="relative",
       broken="normals not turned to the incident side: 1")
def inverted() -> float:
    corner = shapes.trihedral(0.2)
    inside_out = ep.Mesh(corner.vertices, np.asarray(corner.triangles)[:, [0, 2, 1]])
    scenes = [scene_of(("corner", mesh, METAL, {"position": (20.0, 0.0, 0.0)})) for mesh in (corner, inside_out)]
    one, two = (abs(np.sum(field(traced(scene, make_radar(), 2 ** 13, footprint="none")))) for scene in scenes)
    return abs(one - two) / one if one > 0 else np.inf


@cases("tiny triangles", "a plate of 180 000 triangles, a twentieth of a wavelength each, has the level of two", bound=0.02,
       unit="dB",
       broken="the area of the triangle instead of that of the ray's cell: 99 dB")
def tiny_triangles() -> float:
    levels = [level_of(shapes.plate(0.1, 0.1, edge=edge)) for edge in (None, 0.1 / 300)]
    return abs(decibels(levels[1] / levels[0]))


def defective(mesh):
    """The mesh with duplicates, fins behind it on its edges, holes of no area, unused vertices and turned facets."""
    vertices, triangles = np.asarray(mesh.vertices), np.asarray(mesh.triangles, int)
    n = len(vertices)
    extra = [[0.03, 0.0, 0.0], [9e9, 0.0, 0.0], [0.02, 0.0, 0.01]]  # x > 0: behind the plate
    turned = triangles.copy()
    turned[::2] = turned[::2, ::-1]
    fins = [[*triangles[0, :2], n], [*triangles[0, :2], n + 2], [triangles[0, 0], n, n + 2]]
    bad = [[0, 0, 1], [1, 1, 1]]
    return ep.Mesh(np.vstack([vertices, extra]), np.vstack([turned, triangles, fins, bad]))


@cases("every defect at once", "a plate with duplicates, fins, inverted and degenerate facets: level of a sound one",
       bound=0.05, unit="dB",
       broken="triangles without area kept: the trace is refused (a tensor of NaN)")
def every_defect() -> float:
    sound = shapes.plate(0.1, 0.1, edge=0.02)
    levels = [level_of(mesh) for mesh in (sound, defective(sound))]
    return abs(decibels(levels[1] / levels[0]))
