"""A street of cars with turning wheels and of people who walk, between walls, before an array of 3 x 4 antennas."""
from __future__ import annotations

import numpy as np

import echopath as ep

from ...actors import shapes
from ..crowd.scenes import rounded_car
from ..physics.closed_forms import FREQUENCY, WAVELENGTH

LANES = (-4.5, -1.7, 1.7, 4.5)  # m
WHEELS = ((1.35, 0.8), (1.35, -0.8), (-1.35, 0.8), (-1.35, -0.8))  # m, from the middle of a car
WHEEL_RADIUS, WHEEL_HEIGHT = 0.3, 0.33  # m


def radar(motion=None, *, receivers: int = 4):
    """77 GHz, three transmitters in turn and `receivers`, 128 chirps of 256 samples. motion: of the radar or None"""
    waveform = ep.ChirpSequence(start_frequency=FREQUENCY, bandwidth=5e8, num_samples=256, sampling_rate=10e6,
                                num_chirps=128, chirp_interval=3e-5)
    pattern = ep.CosinePower(2.0)
    return ep.Radar(waveform, motion=motion,
                    transmitters=[ep.Antenna((0.0, 2.0 * WAVELENGTH * k, 0.7), pattern=pattern) for k in range(3)],
                    receivers=[ep.Antenna((0.0, 0.5 * WAVELENGTH * k, 0.75), pattern=pattern) for k in range(receivers)])


def crowd(num_each: int):
    """So many cars and as many people."""
    scene, draw = ep.Scene(), np.random.default_rng(3)
    mirror = ep.materials["concrete"].replace(scattering=0.3, mirror=True)
    scene.add(shapes.ground((120.0, 40.0)), name="ground", material=mirror, position=(50.0, 0.0, 0.0))
    for name, side in (("wall_left", 1.0), ("wall_right", -1.0)):
        scene.add(shapes.wall(120.0, 6.0), name=name, material=mirror, position=(50.0, 10.0 * side, 0.0),
                  yaw=0.0 if side > 0 else np.pi)
    meshes = rounded_car(), shapes.sphere(WHEEL_RADIUS, subdivisions=12)
    for k in range(num_each):
        place = 8.0 + 14.0 * (k // 4) + draw.uniform(0.0, 6.0), LANES[k % 4]
        _add_car(scene, f"car_{k}", place, draw.uniform(5.0, 15.0), *meshes)
    for k in range(num_each):
        place = 6.0 + 6.5 * (k // 2) + draw.uniform(0.0, 4.0), (1.0 if k % 2 else -1.0) * draw.uniform(6.5, 9.0), 0.0
        person = ep.actors.pedestrian(height=draw.uniform(1.55, 1.9), speed=draw.uniform(0.8, 1.8), phase=draw.uniform())
        scene.add(person, name=f"person_{k}", position=place, yaw=draw.uniform(-np.pi, np.pi))
    pole = shapes.capsule(0.05, 4.0, edge=0.02)
    for k in range(8):
        scene.add(pole, name=f"pole_{k}", position=(12.0 + 10.0 * (k // 2), 9.3 if k % 2 else -9.3, 2.01),
                  material=ep.Material.metal(), smooth=True)
    return scene


def _add_car(scene, name: str, place, speed: float, body, wheel) -> None:
    """place: (x, y) in m; speed: m/s, toward the radar on its left."""
    metal = ep.Material.metal()
    node = scene.add(None, name=name, position=(*place, 0.0), yaw=np.pi if place[1] > 0.0 else 0.0,
                     motion=ep.LinearMotion(velocity=(speed, 0.0, 0.0)))
    scene.add(body, name="body", parent=node, material=metal, smooth=True)
    for index, (ahead, aside) in enumerate(WHEELS):
        turning = ep.LinearMotion(angular_velocity=(0.0, speed / WHEEL_HEIGHT, 0.0))
        scene.add(wheel, name=f"wheel_{index}", parent=node, position=(ahead, aside, WHEEL_HEIGHT), material=metal,
                  smooth=True, motion=turning)
