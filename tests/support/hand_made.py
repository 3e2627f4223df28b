"""Paths written by hand over a small street, and random expressions over it, for tests that know the answer."""
import random

import numpy as np

import echopath as ep

GROUPS = ["street", "pedestrian", "pedestrian/arms"]
MESHES = ["street/wall_left", "street/wall_right", "street/floor", "pedestrian/torso", "pedestrian/arms/left",
          "pedestrian/arms/right"]
GLOBS = ["street", "street/wall*", "*left", "pedestrian/*", "pedestrian/arms", "*/arms/righ?", "*", "*e*"]
HIT = np.dtype([("mesh_id", np.uint32), ("triangle_id", np.uint32), ("u", np.float32), ("v", np.float32)])


def make_street() -> ep.Scene:
    """Metal triangles at 5 m, one for each mesh, in the order of MESHES."""
    scene = ep.Scene()
    triangle = ep.Mesh([[5, -1, -1], [5, 1, -1], [5, 0, 1]], [[0, 1, 2]])
    for name in GROUPS + MESHES:
        parent, _, own = name.rpartition("/")
        is_mesh = name in MESHES
        scene.add(triangle if is_mesh else None, name=own, parent=parent or None,
                  material=ep.Material.metal() if is_mesh else None)
    assert [mesh.name for mesh in scene.meshes] == MESHES
    return scene


def small_radar() -> ep.Radar:
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=16, sampling_rate=1e6, num_chirps=2,
                                chirp_interval=60e-6)
    return ep.Radar(waveform, transmitters=[ep.Antenna((0, 0, 0))], receivers=[ep.Antenna((0, 0.01, 0))])


def hand_made_paths(street, routes, weight=0.0) -> ep.Paths:
    """Paths [P] over [[("street/floor", "S"), ...], ...], of weight [P] or one for all."""
    diffuse = [sum((event == "D") << k for k, (_, event) in enumerate(route)) for route in routes]
    return _paths(street, [[MESHES.index(name) for name, _ in route] for route in routes], diffuse, weight)


def diffuse_paths(scene, routes, weight=0.0) -> ep.Paths:
    """Paths [P] over [[ID of a mesh, ...], ...] that scatter at each of them, in its middle, of weight [P] or one for all."""
    return _paths(scene, routes, [2 ** len(route) - 1 for route in routes], weight, middle=1.0 / 3.0)


def _paths(scene, routes, diffuse, weight, middle=0.0) -> ep.Paths:
    radar = small_radar()
    counts = np.array([len(route) for route in routes], np.uint8)
    hits = np.zeros(int(counts.sum(dtype=int)), HIT)
    hits["mesh_id"] = [mesh for route in routes for mesh in route]
    hits["u"] = hits["v"] = middle
    zeros = np.zeros(len(routes))
    return ep.Paths.from_arrays(
        hits=hits, offsets=np.cumsum(counts, dtype=np.int64) - counts, num_bounces=counts,
        diffuse=np.array(diffuse, np.uint64), weight=(zeros + weight).astype(np.complex64), stratum=zeros.astype(np.uint16),
        batch=zeros.astype(np.uint8), flags=zeros.astype(np.uint32), scene=scene, radar=radar,
        frame=ep.trace(scene, radar, num_rays=100, polarization="scalar").frame)


def random_routes(count, max_hits, seed):
    draw = random.Random(seed)
    return [[(draw.choice(MESHES), draw.choice("SD")) for _ in range(draw.randint(1, max_hits))] for _ in range(count)]


def random_expression(draw: random.Random, globs=GLOBS) -> str:
    """A path expression over the globs, nested at most twice."""
    def choice(depth):
        return " | ".join(sequence(depth) for _ in range(draw.choice([1, 1, 2])))

    def sequence(depth):
        return " ".join(repeat(depth) for _ in range(draw.randint(1, 3)))

    def repeat(depth):
        low = draw.randint(0, 2)
        counts = f"{{{low}}}", f"{{{low},}}", f"{{{low}, {low + draw.randint(0, 2)}}}"
        atom = f"({choice(depth - 1)})" if depth and draw.random() < 0.3 else hit()
        return atom + draw.choice(["", "", "", "*", "+", "?", *counts])

    def hit():
        several = " ".join(f"'{draw.choice(globs)}'" for _ in range(draw.randint(1, 3)))
        meshes = draw.choice([f"'{draw.choice(globs)}'", f"[{several}]", f"[^ {several}]"])
        return draw.choice([".", "(S)", "(D)", meshes, "S" + meshes, "D" + meshes])

    return f"T {choice(2)} R"
