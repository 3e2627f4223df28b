"""How often the interval that a run claims covers the true value: coherent, diffuse, ghost and two-bounce echoes."""
from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np

import echopath as ep

from ..actors import shapes
from . import targets

NUM_SEEDS, QUICK_SEEDS = 60, 4
RAYS, QUICK_RAYS = (2 ** 12, 2 ** 14, 2 ** 16), (2 ** 12,)
TRUE_RAYS, QUICK_TRUE_RAYS = 2 ** 22, 2 ** 16
BATCHES = 8
WANTED = (0.90, 0.98)
FIRST_SEED = 1000
# centre and semi-axes of the ellipsoids, m
FLANK_AND_BALL = {"ball": (np.array([10.0, 0.0, 0.0]), np.full(3, 0.2)), "flank": (np.array([8.5, 2.2, 0.0]), np.array([3.0, 0.6, 0.8]))}


@dataclasses.dataclass(frozen=True)
class Echo:
    """An echo whose power is known. kind: for people; scene; selection: of its paths; true_selection: paths whose power is the
    truth at many rays, the same or, where it converges sooner, the reverse."""

    kind: str
    scene: Callable
    selection: str
    true_selection: str
    max_bounces: int = 1


def all_echoes() -> list[Echo]:
    plain = {target.name: target for target in targets.all_targets()}

    def scene_of(name: str):
        return lambda: plain[name].scene

    return [Echo("coherent, sphere ka 3228", scene_of("sphere_3228"), "T 'target' R", "T 'target' R"),
            Echo("coherent, car's ellipsoid", scene_of("ellipsoid"), "T 'target' R", "T 'target' R"),
            Echo("diffuse, plate", scene_of("lambert_plate"), "T 'plate' R", "T 'plate' R"),
            Echo("diffuse, patch far away", _far_patch, "T 'pair/patch' R", "T 'pair/patch' R"),
            Echo("ghost, patch then wall", _ghost, "T 'patch' 'mirror' R", "T 'patch' 'mirror' R", 2),
            Echo("ghost, wall then patch", _ghost, "T 'mirror' 'patch' R", "T 'patch' 'mirror' R", 2),
            Echo("two bounces, ball then flank", flank_and_ball, "T 'ball' 'flank' R", "T 'ball' 'flank' R", 2),
            Echo("two bounces, flank then ball", flank_and_ball, "T 'flank' 'ball' R", "T 'ball' 'flank' R", 2)]


def measure_coverage(*, quick: bool) -> dict:
    """A row for each echo and number of rays."""
    seeds = QUICK_SEEDS if quick else NUM_SEEDS
    rows = []
    for echo in all_echoes():
        scene, radar = echo.scene(), targets.radar()
        truth = _power(echo, scene, radar, echo.true_selection, num_rays=QUICK_TRUE_RAYS if quick else TRUE_RAYS).power
        for rays in QUICK_RAYS if quick else RAYS:
            found = [_power(echo, scene, radar, echo.selection, num_rays=rays, seed=FIRST_SEED + seed, batches=BATCHES)
                     for seed in range(seeds)]
            rows.append({"kind": echo.kind, "rays": rays, **covered(found, truth)})
    return {"seeds": seeds, "wanted": WANTED, "rows": rows}


def covered(found: list, truth: float) -> dict:
    """Share of the powers whose interval holds the truth, and how far they are from it, in dB.

    found: ep.ReceivedPower of each seed; truth: W
    """
    mean = max(float(np.mean([one.power for one in found])), 1e-12 * truth)
    widths = [one.interval_db for one in found]
    return {"coverage": float(np.mean([one.low <= truth <= one.high for one in found])),
            "mean_error_db": float(10.0 * np.log10(mean / truth)),
            "claimed_db": float(np.median(widths)),
            "unresolved": int(sum(not one.resolved for one in found))}


def _power(echo: Echo, scene, radar, selection: str, **settings):
    return ep.received_power(ep.trace(scene, radar, max_bounces=echo.max_bounces, **settings).select(selection))


def _far_patch():
    """A Lambert patch of 0.1 m beside a wide one that takes most of the rays' cone."""
    scene = ep.Scene()
    rough = ep.Material(reflectivity=0.5, scattering=1.0)
    node = scene.add(None, name="pair", position=(60.0, 0.0, 0.0))
    scene.add(shapes.plate(0.1, 0.1), name="patch", material=rough, parent=node)
    scene.add(shapes.plate(3.0, 3.0), name="board", material=rough, parent=node, position=(0.0, 4.0, 0.0))
    return scene


def _ghost():
    """A Lambert patch of 0.5 m, and a metal wall 3 m aside."""
    scene = ep.Scene()
    scene.add(shapes.plate(0.5, 0.5), name="patch", material=ep.Material(reflectivity=0.5, scattering=1.0),
              position=(20.0, 0.0, 0.0))
    scene.add(shapes.wall(80.0, 20.0), name="mirror", material=ep.Material.metal(mirror=True), position=(0.0, 3.0, -10.0))
    return scene


def flank_and_ball():
    """A metal ball beside the long curved flank of a body, both smooth."""
    scene = ep.Scene()
    (ball, ball_axes), (flank, flank_axes) = FLANK_AND_BALL["ball"], FLANK_AND_BALL["flank"]
    metal = ep.Material.metal()
    scene.add(shapes.sphere(ball_axes[0], edge=0.02), name="ball", material=metal, position=tuple(ball), smooth=True)
    scene.add(shapes.ellipsoid(flank_axes, edge=0.05), name="flank", material=metal, position=tuple(flank), smooth=True)
    return scene
