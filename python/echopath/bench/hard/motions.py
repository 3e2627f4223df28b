"""Motions that frames, records and polynomials do not expect."""
from __future__ import annotations

import numpy as np

import echopath as ep
from echopath import _core

from ...actors import shapes
from ...paths.absent import NO_MESH
from .case import Cases
from .scenes import METAL, POWER, ROUGH, make_radar, scene_of, traced, traced_quietly

cases = Cases("Motion")
C = ep.speed_of_light


def moving_patch(motion, side: float = 1e-3):
    """A patch so small that it is one point, moved by `motion` from the origin of its node."""
    return scene_of(("patch", shapes.plate(side, side), METAL, {"motion": motion}))


def cube_error(paths, **settings) -> float:
    """Largest difference of a signal from that of the exact replay, relative to the largest sample."""
    exact_cube = ep.synthesize(paths, paths.radar, evaluate="chirps", method="direct")
    return float(np.abs(ep.synthesize(paths, paths.radar, method="direct",
                                      **settings) - exact_cube).max() / np.abs(exact_cube).max())


@cases("static scene", "all chirps hold the same bits: largest difference between them", bound=0.0, unit="sqrt(W)",
       broken="what is at rest interpolated like what moves: 5.5e-17")
def static_scene() -> float:
    scene = scene_of(("ball", shapes.sphere(0.4), ROUGH, {"position": (6.0, 0.5, 0.2)}),
                     ("plate", shapes.plate(1.0, 1.0), METAL,
                     {"position": (9.0, 0.0, 0.0)}))
    paths, worst = traced(scene, make_radar(num_chirps=64), 20_000), 0.0
    for method in ("auto", "direct", "recurrence", "nufft"):
        cube = ep.synthesize(paths, paths.radar, method=method)
        worst = max(worst, float(np.abs(cube - cube[:, :, :1]).max()))
    return worst


@cases("velocity jumps", "linear keyframes with kinks in chirps: polynomials are cut there (error beside the exact replay)",
       bound=3e-5, unit="of the signal",
       broken="polynomials across the jumps, their tails not looked at: 2.0")
def velocity_jumps() -> float:
    times = np.array([-1e-3, 0.41e-3, 0.4137e-3, 1.333e-3, 4e-3])
    points = np.array([[10.0, 0, 0], [10.03, 0, 0], [10.03, 0, 0], [9.99, 0.01, 0], [10.08, 0, 0.01]])
    motion = ep.KeyframeMotion(times=times, translations=points, interpolation="linear")
    return cube_error(traced(moving_patch(motion, 0.05), make_radar(num_chirps=64), 4000))


@cases("phases through a velocity jump", "lengths at any time are twice the distance of the keyframes", bound=1e-9, unit="m",
       broken="splines through linear keyframes: 0.060 m")
def lengths_through_jump() -> float:
    times, x = np.array([-1.0, 1e-3, 5e-3]), np.array([10.0, 10.02, 9.9])
    motion = ep.KeyframeMotion(times=times, translations=np.column_stack([x, 0 * x, 0 * x]), interpolation="linear")
    paths = traced(moving_patch(motion, 1e-6), make_radar(num_chirps=32), 200)
    at = np.linspace(0.0, 2e-3, 41)
    return float(np.abs(np.asarray(paths.lengths(at)) - 2 * np.interp(at, times, x)[:, None]).max())


@cases("interpenetrating meshes",
       "two bodies that move through each other: hits are those of a brute-force search at that time (rays)",
       bound=0.0, unit="rays",
       broken="the pose of time 0 at all times: 2487 rays")
def interpenetrating() -> float:
    scene = scene_of(("box", shapes.box(0.6), METAL, {"motion": ep.LinearMotion(velocity=(10.0, 0, 0)), "position": (4.0,
                                                                                                                     0.0,
                                                                                                                     0.0)}),
                     ("ball", shapes.sphere(0.5, subdivisions=4), ROUGH,
                      {"motion": ep.LinearMotion(velocity=(-10.0, 0, 0), angular_velocity=(0, 0, 9.0)),
                       "position": (4.4, 0.1, 0.0)}))
    random, wrong = np.random.default_rng(5), 0
    for time in (0.0, 0.013, 0.02, 0.031):
        directions = np.array([4.2, 0.0, 0.0]) + random.uniform(-0.6, 0.6, (1500, 3))
        mesh_id, _, distance, _ = _core.bench.first_hits(scene, np.zeros_like(directions), directions, time=time)
        _, expected = brute_force(scene, directions, time)
        near = np.isclose(distance, expected, atol=1e-5) | ((mesh_id == NO_MESH) & np.isinf(expected))
        wrong += int(np.sum(~near))
    return float(wrong)


def brute_force(scene, directions, time: float):
    """Mesh and distance [N] of the nearest triangle from the origin: Moeller-Trumbore against all of them."""
    directions = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    best, owner = np.full(len(directions), np.inf), np.full(len(directions), NO_MESH)
    for mesh in scene.meshes:
        corners = np.asarray(scene.world_vertices(mesh.id, time))[np.asarray(mesh.triangles, int)]
        for a, b, c in corners:
            p = np.cross(directions, c - a)
            determinant = p @ (b - a)
            with np.errstate(divide="ignore", invalid="ignore"):
                u = -(p @ a) / determinant
                q = np.cross(-a, b - a)
                v, distance = directions @ q / determinant, (q @ (c - a)) / determinant
                inside = (u >= 0) & (v >= 0) & (u + v <= 1) & (distance > 0) & (distance < best)
            best, owner = np.where(inside, distance, best), np.where(inside, mesh.id, owner)
    return owner, best


@cases("parts of moving bodies in each other", "the parts of two bodies that move through each other add up to the whole",
       bound=1e-12,
       unit="of the signal",
       broken="one group of paths left out: 0.88")
def interpenetrating_parts() -> float:
    scene = scene_of(("box", shapes.box(0.6), ep.Material(reflectivity=0.5, scattering=0.7),
                      {"motion": ep.LinearMotion(velocity=(10.0, 0, 0)), "position": (4.0, 0.0, 0.0)}),
                     ("ball", shapes.sphere(0.5, subdivisions=12), ROUGH, {"motion": ep.LinearMotion(velocity=(-10.0, 0, 0)),
                                                                          "position": (4.4, 0.1, 0.0)}))
    paths = traced(scene, make_radar(num_chirps=16), 10_000)
    whole = ep.synthesize(paths, paths.radar)
    parts = ep.decompose(paths, paths.radar, {"box": "T 'box' .* R", "ball": "T 'ball' R"})
    return float(np.abs(sum(parts.values()) - whole).max() / np.abs(whole).max())


@cases("a body that drives through the radar", "a rough and a metal plate pass both antennas: largest sample beside "
       "the field that is sent", bound=1.0, unit="of the field",
       broken="contributions beside the antennas kept: 14")
def through_the_radar() -> float:
    worst = 0.0
    for start in (-0.0005, -0.00048, -0.02):
        motion = ep.LinearMotion(velocity=(1.0, 0.0, 0.0))
        scene = scene_of(("plate", shapes.plate(0.3, 0.3), ROUGH, {"position": (start, 0.0, 0.0), "motion": motion}),
                         ("metal", shapes.plate(0.2, 0.2), METAL, {"position": (0.3 + start, 0.0, 0.0), "motion": motion}))
        paths = traced_quietly(scene, make_radar(num_chirps=32), 4000)
        for settings in ({}, {"evaluate": "chirps"}, {"replay": "fermat"}, {"retrace": "invalid", "keyframes": 4}):
            largest = float(np.abs(ep.synthesize(paths, paths.radar, **settings)).max()) / np.sqrt(POWER)
            worst = max(worst, largest) if np.isfinite(largest) else np.inf
    return worst


@cases("a plate that turns edge-on", "its echo goes through zero when it shows the radar its edge: beside the exact replay",
       bound=3e-4,
       unit="of the signal",
       broken="tails of the polynomials not looked at: 0.088")
def edge_on() -> float:
    motion = ep.LinearMotion(angular_velocity=(0.0, 0.0, 0.3 / 2e-3))
    scene = ep.Scene()
    scene.add(shapes.plate(0.02, 0.02), name="plate", material=ROUGH, position=(5.0, 0.0, 0.0), yaw=np.pi / 2 - 0.2,
              motion=motion)
    return cube_error(traced(scene, make_radar(num_chirps=64), 4000))


@cases("a motion that ends too soon", "refused, naming the object", bound=0.0, unit="accepted",
       broken="times not checked: accepted")
def too_short() -> float:
    motion = ep.KeyframeMotion(times=[0.0, 1e-6], translations=[[5.0, 0, 0], [6.0, 0, 0]], interpolation="linear")
    try:
        traced(moving_patch(motion), make_radar(num_chirps=8), 100)
    except ValueError as error:
        return float("patch" not in str(error))
    return 1.0


@cases("a frame at a late start", "the same motion one hour later, around the same place: relative change of the signal",
       bound=1e-5,
       unit="of the signal",
       broken="times in single precision: 1.35")
def late_start() -> float:
    hour, speed = 3600.0, -8.0
    cubes = []
    for start in (0.0, hour):
        motion = ep.LinearMotion(velocity=(speed, 0.0, 0.0))
        scene = scene_of(("ball", shapes.sphere(0.3), ROUGH,
                          {"position": (9.0 - speed * start, 0.0, 0.0), "motion": motion}))
        paths = traced(scene, make_radar(num_chirps=16), 4000, start_time=start)
        cubes.append(ep.synthesize(paths, paths.radar))
    return float(np.linalg.norm(cubes[0] - cubes[1]) / np.linalg.norm(cubes[0]))


@cases("one chirp, one sample, one ray", "a frame of the smallest size is finite", bound=0.0, unit="values not finite",
       broken="no guard of windows of one sample: 1")
def smallest_frame() -> float:
    radar = make_radar(num_chirps=1, num_samples=1, bandwidth=1e6)
    frame = ep.simulate(scene_of(("ball", shapes.sphere(0.4), ROUGH, {"position": (6.0, 0.0, 0.0)})), radar, num_rays=1)
    return float(sum(np.sum(~np.isfinite(values)) for values in (frame.cube, frame.noisy_cube, frame.spectrum.values)))
