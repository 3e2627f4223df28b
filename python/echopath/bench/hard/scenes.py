"""Scenes and read-outs that several hard cases share. 77 GHz, lengths in m."""
from __future__ import annotations

import warnings

import numpy as np

import echopath as ep
from echopath import _core

from ...actors import shapes
from ...paths.absent import NO_MESH
from ..physics import closed_forms as exact
from ..physics.read_outs import rcs_of

UTM = np.array([450_000.0, 5_400_000.0, 120.0])  # m, a place in coordinates of maps
METAL = ep.Material.metal()
ROUGH = ep.Material(reflectivity=0.5, scattering=1.0)
POWER = 0.01  # W


def make_radar(position=(0.0, 0.0, 0.0), *, baseline=0.0, num_chirps=1, motion=None, **waveform) -> ep.Radar:
    """Isotropic antennas, the receiver `baseline` m to the left."""
    fields = dict(start_frequency=exact.FREQUENCY, bandwidth=1e9, num_samples=256, sampling_rate=20e6, num_chirps=num_chirps,
                  chirp_interval=30e-6)
    receiver = np.asarray(position, float) + [0.0, baseline, 0.0]
    return ep.Radar(ep.ChirpSequence(**{**fields, **waveform}), transmitters=[ep.Antenna(tuple(position))],
                    receivers=[ep.Antenna(tuple(receiver))], transmit_power=POWER, motion=motion)


def scene_of(*objects) -> ep.Scene:
    """Of (name, mesh, material) or (name, mesh, material, keywords of Scene.add)."""
    scene = ep.Scene()
    for name, mesh, material, *keywords in objects:
        scene.add(mesh, name=name, material=material, **(keywords[0] if keywords else {}))
    return scene


def traced(scene, radar, num_rays: int, **settings):
    """Paths, without remarks on coarse meshes: they are coarse on purpose."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ep.TessellationWarning)
        return ep.trace(scene, radar, num_rays=num_rays, **settings)


def traced_quietly(scene, radar, num_rays: int, **settings):
    """Paths without any remark: the antennas stand where they should not."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return ep.trace(scene, radar, num_rays=num_rays, **settings)


def decibels(ratio: float) -> float:
    return float(10 * np.log10(max(ratio, 1e-300)))


def plate_at(distance: float, side: float = 0.1, **keywords):
    """("plate", ...) for scene_of: broadside to a radar at the origin."""
    return ("plate", shapes.plate(side, side), METAL, {"position": (distance, 0.0, 0.0), **keywords})


def broadside_rcs(side: float, distance: float) -> float:
    """Physical optics of a square plate at broadside in the near field too: Fresnel integral over its face."""
    nodes, weights = np.polynomial.legendre.leggauss(64)
    y, w = 0.5 * side * nodes, 0.5 * side * weights
    r = np.sqrt(distance ** 2 + y[:, None] ** 2 + y[None, :] ** 2)
    spreading = (distance / r) ** 3  # cosine of incidence, both ways
    integral = np.sum(w[:, None] * w[None, :] * np.exp(-2j * exact.WAVENUMBER * (r - distance)) * spreading)
    return 4 * np.pi * abs(integral) ** 2 / exact.WAVELENGTH ** 2


def misses(scene, origin, targets) -> int:
    """Rays from `origin` [3] through `targets` [N, 3] that meet nothing."""
    directions = np.asarray(targets, float) - origin
    mesh_id, *_ = _core.bench.first_hits(scene, np.broadcast_to(origin, directions.shape), directions)
    return int(np.sum(mesh_id == NO_MESH))


def edge_points(mesh, count: int, seed: int = 1) -> np.ndarray:
    """[count, 3] random points on edges of a mesh."""
    random = np.random.default_rng(seed)
    vertices, triangles = np.asarray(mesh.vertices), np.asarray(mesh.triangles, int)
    face, corner, share = random.integers(len(triangles), size=count), random.integers(3,
                                                                                       size=count), random.random((count, 1))
    one, two = vertices[triangles[face, corner]], vertices[triangles[face, (corner + 1) % 3]]
    return one + share * (two - one)


def same_bits(a, b) -> bool:
    """Whether two records hold the same bits."""
    columns = ("hits", "offsets", "num_bounces", "diffuse", "weight", "stratum", "batch", "flags", "curved_cell", "jones")
    return all(np.asarray(getattr(a, name)).tobytes() == np.asarray(getattr(b, name)).tobytes() for name in columns)


def level_of(mesh, max_bounces: int = 1) -> float:
    """Radar cross section in m^2 of a metal mesh 200 m ahead."""
    scene = scene_of(("target", mesh, METAL, {"position": (200.0, 0.0, 0.0)}))
    return rcs_of(traced(scene, make_radar(), 2 ** 14, max_bounces=max_bounces), 200.0)
