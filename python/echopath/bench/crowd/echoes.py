"""Echoes whose power is known, for the coverage of intervals.

What launch cells take away is the same for every seed of the rays: of one scene, intervals hold the truth always or never. The
coherent echoes and those of two bounces are therefore of another body, attitude or place for each seed.

Power that no closed form tells is that of a trace with many more rays (coverage.py): of plates, lofted cars, spheres by a
wall, and what is diffuse, coverage tells how well runs know what more rays would say, not how well that is true.
"""
from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable

import numpy as np

import echopath as ep

from ...actors import shapes
from ..physics import closed_forms, targets
from . import scenes
from .two_bounces import power_over_ellipsoids

# centre and semi-axes of ellipsoids, m: a metal ball beside the long curved flank of a body
FLANK_AND_BALL = {"ball": ((10.0, 0.0, 0.0), (0.2, 0.2, 0.2)), "flank": ((8.5, 2.2, 0.0), (3.0, 0.6, 0.8))}
FAR = 4e4                         # m
RADII = (0.3, 2.0)                # m, of spheres; geometrical optics of smaller ones errs by .04 dB itself
RANGES = (20.0, 100.0)            # radii
AWAY = (0.7, 0.3)                 # m, of the flank along x and y to both sides
BATCHES = 8                       # of rays
EDGE = 0.4                        # of the root of the least radius of curvature times the wavelength: a tenth of what shows


@dataclasses.dataclass(frozen=True)
class Echo:
    """kind: for people, the class of echoes before a comma; draw: callable (seed) -> (scene, truth in W, or None for the mean
    power of many rays); selection: of its paths; objects: names of what they touch first, for what no ray has met; max_bounces,
    batches, sampler: of the trace; differs: whether each seed has a scene of its own"""

    kind: str
    draw: Callable
    selection: str
    objects: dict | None = None
    max_bounces: int = 1
    differs: bool = False
    batches: int = BATCHES
    sampler: str = "lattice"

    @property
    def of_class(self) -> str:
        return class_of(self.kind)


def class_of(kind: str) -> str:
    """What stands before the comma of an `Echo.kind`."""
    return kind.split(",")[0]


def all_echoes() -> list[Echo]:
    return [Echo("coherent, spheres", _sphere, "T 'target' R"),
            Echo("coherent, car's ellipsoid", _ellipsoid, "T 'target' R"),
            Echo("coherent, plates", _plate, "T 'plate' R", differs=True),
            Echo("coherent, lofted cars", _lofted_car, "T 'car' R", differs=True),
            Echo("diffuse, plate", lambda seed: (targets.lambert_plate().scene, None), "T 'plate' R"),
            Echo("diffuse, patch far away", lambda seed: (_far_patch(), None), "T 'pair/patch' R",
                 {"patch": "pair/patch", "board": "pair/board"}),
            Echo("ghost, patch then wall", lambda seed: (_ghost(), None), "T 'patch' 'mirror' R", None, 2),
            Echo("ghost, wall then patch", lambda seed: (_ghost(), None), "T 'mirror' 'patch' R", None, 2),
            Echo("ghost, sphere then wall", _sphere_by_wall, "T 'target' 'mirror' R", None, 2, differs=True),
            Echo("two bounces, ball then flank", lambda seed: _flank_and_ball(seed, ("ball", "flank")), "T 'ball' 'flank' R",
                 None, 2),
            Echo("two bounces, flank then ball", lambda seed: _flank_and_ball(seed, ("flank", "ball")), "T 'flank' 'ball' R",
                 None, 2),
            Echo("one batch, tree", lambda seed: (_tree(), None), "T 'tree/*' R", batches=1),
            Echo("one batch, tree by random directions", lambda seed: (_tree(), None), "T 'tree/*' R", batches=1,
                 sampler="random")]


def ellipsoids(bodies: dict):
    """Scene of smooth metal ellipsoids. bodies: {name: (centre, semi-axes)} in m."""
    scene = ep.Scene()
    for name, (centre, semi_axes) in bodies.items():
        scene.add(_body(tuple(semi_axes)), name=name, material=ep.Material.metal(), position=tuple(centre), smooth=True)
    return scene


@functools.lru_cache(maxsize=4)
def _body(semi_axes: tuple) -> ep.Mesh:
    """Two bodies stand elsewhere for each of hundreds of seeds: they are made, and looked over, once."""
    return shapes.ellipsoid(semi_axes, edge=_edge(semi_axes))


def _edge(semi_axes) -> float:
    """Of triangles, m."""
    return float(EDGE * np.sqrt(min(semi_axes) ** 2 / max(semi_axes) * closed_forms.WAVELENGTH))


def _sphere(seed: int):
    draw = np.random.default_rng(seed)
    radius = float(np.exp(draw.uniform(*np.log(RADII))))
    centre = radius * draw.uniform(*RANGES) * _direction(draw)
    near = np.linalg.norm(centre) - radius
    field = closed_forms.WAVELENGTH / (4.0 * np.pi * near) * radius / (2.0 * (radius + near))  # its image of the antenna
    return ellipsoids({"target": (centre, (radius,) * 3)}), targets.radar().transmit_power * field ** 2


def _ellipsoid(seed: int):
    target = targets.ellipsoid_seen_along(_direction(np.random.default_rng(seed)), edge=_edge(targets.CAR))
    factor = closed_forms.WAVELENGTH ** 2 / ((4.0 * np.pi) ** 3 * FAR ** 4)
    return target.scene, targets.radar().transmit_power * factor * target.truth


def _plate(seed: int):
    """A metal plate up to 12 degrees off the line of sight."""
    draw = np.random.default_rng(seed)
    side, distance, yaw = draw.uniform(0.1, 0.5), draw.uniform(8.0, 30.0), np.radians(draw.uniform(0.0, 12.0))
    scene = ep.Scene()
    scene.add(shapes.plate(side, side), name="plate", material=ep.Material.metal(), position=(distance, 0.0, 0.0), yaw=yaw)
    return scene, None


def _lofted_car(seed: int):
    draw = np.random.default_rng(seed)
    scene = ep.Scene()
    scene.add(scenes.lofted_car(), name="car", material=ep.Material.metal(), smooth=True,
              position=(draw.uniform(12.0, 50.0), 0.0, -0.7), yaw=draw.uniform(0.0, 2.0 * np.pi))
    return scene, None


def _sphere_by_wall(seed: int):
    """A metal sphere, and a metal wall 4 m aside."""
    draw = np.random.default_rng(seed)
    radius, distance = draw.uniform(0.2, 0.6), draw.uniform(8.0, 30.0)
    scene = ellipsoids({"target": ((distance, 0.0, radius + 0.1), (radius,) * 3)})
    scene.add(shapes.wall(200.0, 100.0), name="mirror", material=ep.Material.metal(mirror=True), position=(0.0, 4.0, -50.0))
    return scene, None


def _flank_and_ball(seed: int, order: tuple):
    """The flank stands elsewhere for each seed."""
    centre, semi_axes = FLANK_AND_BALL["flank"]
    away = np.append(np.random.default_rng(seed).uniform(-1.0, 1.0, 2) * AWAY, 0.0)
    bodies = FLANK_AND_BALL | {"flank": (np.add(centre, away), semi_axes)}
    return ellipsoids(bodies), power_over_ellipsoids([bodies[name] for name in order], targets.radar().transmit_power)


def _direction(draw):
    """Uniform over the sphere."""
    vector = draw.normal(size=3)
    return vector / np.linalg.norm(vector)


def _tree():
    """A crown, of which neighbouring rays meet leaves that face any way."""
    scene = ep.Scene()
    scene.add(ep.actors.tree(), name="tree", position=(15.0, 0.0, 0.0))
    return scene


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
