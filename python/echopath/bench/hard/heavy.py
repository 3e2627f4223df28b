"""What takes too long for a test suite: millions of triangles, hits and rays, a thousand traces."""
from __future__ import annotations

import gc
import resource

import numpy as np

import echopath as ep
from echopath import _core

from ...actors import shapes
from ...paths.absent import NO_MESH
from ..physics import closed_forms as exact
from .case import Cases
from .repeat import small_street
from .scenes import METAL, POWER, ROUGH, decibels, edge_points, level_of, make_radar, misses, scene_of, traced

cases = Cases("Large")


@cases("10 million rays at edges of a cube", "share that leaks", bound=1e-6, unit="of them", heavy=True,
       broken="Embree without its robust flag: 0.052")
def leaks_of_a_cube() -> float:
    box, lost = shapes.box(2.0, edge=0.25), 0
    scene, origins = scene_of(("box", box, METAL)), np.random.default_rng(6).uniform(-0.8, 0.8, (10, 3))
    for seed, origin in enumerate(origins):
        lost += misses(scene, origin, edge_points(box, 1_000_000, seed))
    return lost / 1e7


@cases("10 million triangles", "a plate of 10 million triangles has the level of two", bound=0.02, unit="dB", heavy=True,
       broken="the area of the triangle instead of that of the ray's cell: 134 dB")
def ten_million_triangles() -> float:
    edge = 0.1 / np.sqrt(10e6 / 2)
    fine = shapes.plate(0.1, 0.1, edge=edge)
    assert len(fine.triangles) >= 9.9e6
    return abs(decibels(level_of(fine) / level_of(shapes.plate(0.1, 0.1))))


@cases("100 million hits", "a rough box traced from inside by 100 million rays: hits that are not in the record, and its "
       "power beside the integral over the walls", bound=1e-3, unit="relative", heavy=True,
       broken="every 500th block of rays lost: 2.1e-3")
def hundred_million_hits() -> float:
    count, reflectivity, place, size = 100_000_000, 0.5, np.array([0.3, 0.2, 0.1]), np.array([8.0, 6.0, 4.0])
    scene = scene_of(("box", shapes.box(tuple(size)), ep.Material(reflectivity=reflectivity, scattering=1.0)))
    paths = traced(scene, make_radar(tuple(place)), count, max_bounces=1)
    missing = abs(len(paths.hits) - count) / count
    power = float(np.sum(paths.power))
    # P rho lambda^2 / (16 pi^3) times the integral of cos^2 / r^4 over the walls.
    expected = POWER * reflectivity * exact.WAVELENGTH ** 2 / (16 * np.pi ** 3) * _walls(place, size)
    return max(missing, abs(power / expected - 1.0))


def _walls(place, size, count: int = 400) -> float:
    """Integral of cos^2 / r^4 over the walls of a box about the origin, seen from `place`, 1/m^2."""
    middles, total = (np.arange(count) + 0.5) / count - 0.5, 0.0
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        a, b = size[u] * middles[:, None] - place[u], size[v] * middles[None, :] - place[v]
        for side in (-0.5, 0.5):
            height = size[axis] * side - place[axis]
            total += np.sum(height ** 2 / (height ** 2 + a ** 2 + b ** 2) ** 3) * size[u] * size[v] / count ** 2
    return float(total)


@cases("1 000 traces", "traces, replays and signals in a loop: growth of the resident memory over the last 800", bound=8.0,
       unit="MiB", heavy=True,
       broken="Embree's scene not released: 200 MiB")
def thousand_traces() -> float:
    scene, radar = small_street(4)
    settled = 0.0
    for turn in range(1000):
        paths = ep.trace(scene, radar, num_rays=2000, seed=turn + 1)
        ep.range_doppler(ep.synthesize(paths, radar), radar)
        if turn == 199:
            gc.collect()
            settled = resident()
    gc.collect()
    return (resident() - settled) / 2 ** 20


def resident() -> int:
    """Bytes of this process in memory."""
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * resource.getpagesize()


@cases("a second ray tracer", "20 random scenes, a million random rays each, against Embree 4 of embreex: share with "
       "another first hit, rays within single precision of an edge apart", bound=1e-5, unit="of the rays", heavy=True,
       broken="surfaces of one side: 0.061 (one scene)")
def second_tracer() -> float:
    return max(disagreement(seed, 1_000_000) for seed in range(20))


@cases("shadows of a second ray tracer", "the same scenes: share of segments that only one of the two finds free",
       bound=1e-5,
       unit="of the segments", heavy=True,
       broken="shadow rays that end 1 % early: 5.2e-4 (one scene)")
def second_shadows() -> float:
    return max(shadow_disagreement(seed, 1_000_000) for seed in range(20))


def random_scene(seed: int) -> ep.Scene:
    """Bodies, sheets and a soup of triangles around the origin, in random places and turns."""
    random = np.random.default_rng(seed)
    scene = ep.Scene()
    bodies = [shapes.sphere(0.5, subdivisions=6), shapes.box((0.5, 0.8, 0.3)), shapes.trihedral(0.8),
              shapes.capsule(0.2, 1.2), shapes.plate(2.0, 1.0)]
    for k in range(12):
        centre = random.normal(size=3)
        placement = np.eye(4)
        placement[:3, :3] = np.linalg.qr(random.normal(size=(3, 3)))[0]
        placement[:3, :3] *= np.sign(np.linalg.det(placement[:3, :3]))
        placement[:3, 3] = centre / np.linalg.norm(centre) * random.uniform(2.0, 9.0)
        scene.add(bodies[k % len(bodies)], name=f"body{k}", material=METAL, transform=placement)
    soup = random.uniform(-6, 6, (200, 1, 3)) + random.uniform(-0.7, 0.7, (200, 3, 3))
    scene.add(ep.Mesh(soup.reshape(-1, 3), np.arange(600).reshape(-1, 3)), name="soup", material=ROUGH)
    return scene


def _embreex_of(scene):
    from embreex import rtcore_scene
    from embreex.mesh_construction import TriangleMesh

    made = rtcore_scene.EmbreeScene(robust=True)
    corners = np.vstack([np.asarray(scene.world_vertices(mesh.id, 0.0))[np.asarray(mesh.triangles, int)]
                         for mesh in scene.meshes])
    TriangleMesh(made, corners.astype(np.float32))
    return made, corners


def random_rays(seed: int, count: int):
    random = np.random.default_rng(seed + 1000)
    origins, directions = random.uniform(-4, 4, (count, 3)), random.normal(size=(count, 3))
    return origins, directions / np.linalg.norm(directions, axis=1, keepdims=True)


def disagreement(seed: int, count: int) -> float:
    """Share of random rays whose first hit is another one, those that pass an edge within single precision apart."""
    scene = random_scene(seed)
    other, corners = _embreex_of(scene)
    origins, directions = random_rays(seed, count)
    mesh_id, triangle_id, _, _ = _core.bench.first_hits(scene, origins, directions)
    found = other.run(origins.astype(np.float32), directions.astype(np.float32), query="INTERSECT", output=True)
    firsts = np.cumsum([0] + [len(mesh.triangles) for mesh in scene.meshes])
    ours = np.where(mesh_id == NO_MESH, -1, firsts[np.minimum(mesh_id, len(firsts) - 1)] + triangle_id)
    theirs = found["primID"]
    differ = np.flatnonzero(ours != theirs)
    return float(np.sum([not _is_close_call(corners, origins[i], directions[i], ours[i], theirs[i])
                         for i in differ]) / count)


EDGE = 1e-5  # m: what single precision resolves over 10 m, a few units


def _is_close_call(corners, origin, direction, one: int, two: int) -> bool:
    """Whether a ray passes within EDGE of an edge of one of both triangles."""
    return any(_edge_distance(corners[index], origin, direction) < EDGE for index in (one, two) if index >= 0)


def _edge_distance(triangle, origin, direction) -> float:
    """Least distance between a ray's line and the three edges of a triangle, m."""
    along = np.roll(triangle, -1, axis=0) - triangle
    best = np.inf
    for corner, edge in zip(triangle, along):
        normal = np.cross(direction, edge)
        across = np.linalg.norm(normal)
        offset = corner - origin
        share = np.clip(np.cross(direction, offset) @ -normal / across ** 2, 0.0, 1.0) if across > 0 else 0.0
        point = corner + share * edge - origin
        best = min(best, np.linalg.norm(point - (point @ direction) * direction))
    return float(best)


def shadow_disagreement(seed: int, count: int) -> float:
    """Share of random segments that only one tracer finds free, close calls at edges and ends apart."""
    scene = random_scene(seed)
    other, corners = _embreex_of(scene)
    origins, directions = random_rays(seed, count)
    lengths = np.random.default_rng(seed + 2000).uniform(0.5, 12.0, (count, 1))
    ours = np.asarray(_core.bench.blocked(scene, origins, origins + lengths * directions), bool)
    found = other.run(origins.astype(np.float32), directions.astype(np.float32), query="INTERSECT", output=True)
    theirs = (found["primID"] >= 0) & (found["tfar"] < lengths[:, 0])
    differ = np.flatnonzero(ours != theirs)
    close = [abs(found["tfar"][i] - lengths[i, 0]) < EDGE * 10
             or (found["primID"][i] >= 0 and _edge_distance(corners[found["primID"][i]], origins[i], directions[i]) < EDGE)
             for i in differ]
    return float((len(differ) - np.sum(close)) / count)
