"""Spheres that stand for points, at known places with known speeds, before a radar."""
from __future__ import annotations

import numpy as np

import echopath as ep
from support.radars import build_radar

C = ep.speed_of_light
WAVELENGTH = C / 77.5e9
POWER = 300.0  # W, for small spheres and isotropic antennas
RADIUS = 0.05  # m, of spheres that stand for points: their echo comes from the nearest point of them


def radar_with(receivers=8, transmitters=1, num_chirps=64, num_samples=256, chirp_interval=50e-6,
               spacing=0.5 * WAVELENGTH):
    return build_radar([(0, k * receivers * spacing, 0) for k in range(transmitters)],
                       [(0, k * spacing, 0) for k in range(receivers)], num_chirps=num_chirps, num_samples=num_samples,
                       chirp_interval=chirp_interval, transmit_power=POWER)


def at(distance, azimuth):
    return distance * np.array([np.cos(azimuth), np.sin(azimuth), 0.0])


TARGETS = {"near": (6.3, 0.35, 4.0), "middle": (11.1, -0.2, -2.5), "far": (16.4, 0.1, 0.0)}  # m, rad, m/s outward


def scene_of(targets):
    scene = ep.Scene()
    for name, (distance, azimuth, speed) in targets.items():
        scene.add(ep.actors.sphere(RADIUS), name=name, material="metal", smooth=True,
                  position=tuple(at(distance + RADIUS, azimuth)),
                  motion=ep.LinearMotion(velocity=tuple(at(speed, azimuth))))
    return scene


def nearest(found, name):
    distance, _, speed = TARGETS[name]
    return int(np.argmin(np.abs(found.range - distance) + np.abs(found.velocity - speed)))
