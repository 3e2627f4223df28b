"""Scenes of plates beside a mirror wall whose echoes closed forms put in their places, for tests of labels."""
from __future__ import annotations

import numpy as np

import echopath as ep

from .radars import build_radar

MIRROR = ep.Material.metal(mirror=True)
ROUGH = ep.Material(reflectivity=0.9, scattering=1.0)
RADAR = np.array([0.0, 0.0, 1.0])
WALL_Y = 5.0


def make_radar(num_rx=1, height=1.0, pattern=None, **settings):
    antennas = [ep.Antenna((0, 0.0019 * i, height), pattern=pattern) for i in range(num_rx)]
    return build_radar(antennas[:1], antennas, **{"num_samples": 256, "sampling_rate": 10e6, "num_chirps": 64,
                                                  "transmit_power": 10.0} | settings)


def add_plate(scene, name, position, velocity=(0, 0, 0), material=ROUGH, size=0.2):
    """A plate that faces the radar."""
    scene.add(ep.actors.plate(size, size), name=name, material=material, position=position,
              yaw=np.arctan2(-position[1], -position[0]), motion=ep.LinearMotion(velocity=velocity))


def add_wall(scene):
    wall = ep.Mesh([[-20, WALL_Y, -10], [60, WALL_Y, -10], [60, WALL_Y, 12], [-20, WALL_Y, 12]], [[0, 1, 2], [0, 2, 3]])
    scene.add(wall, name="wall", material=MIRROR)


def way(position, velocity, over_wall: bool):
    """(distance, radial speed) of a point, or of its image in the wall."""
    position, velocity = np.array(position, float), np.array(velocity, float)
    if over_wall:
        position[1], velocity[1] = 2 * WALL_Y - position[1], -velocity[1]
    line = position - RADAR
    return np.linalg.norm(line), velocity @ line / np.linalg.norm(line)


def echoes_of(name, position, velocity):
    """{part: (range m, velocity m/s)} of the direct echo and the one-way and two-way ghosts."""
    (near, slow), (far, fast) = way(position, velocity, False), way(position, velocity, True)
    return {name: (near, slow), f"{name} one way": ((near + far) / 2, (slow + fast) / 2), f"{name} two way": (far, fast)}


TARGETS = {"a": ((7.0, -2.0, 1.0), (-4.0, 0.0, 0.0)), "b": ((18.0, -3.0, 1.0), (6.0, 2.0, 0.0))}


def trace_plates_and_wall():
    """(paths, selections, {part: (range, velocity)} by closed form)."""
    scene, parts, truth = ep.Scene(), {}, {"wall": (WALL_Y, 0.0)}
    add_wall(scene)
    for name, (position, velocity) in TARGETS.items():
        add_plate(scene, name, position, velocity)
        truth |= echoes_of(name, position, velocity)
        parts |= {name: f"T '{name}' R", f"{name} one way": f"T ('{name}' 'wall' | 'wall' '{name}') R",
                  f"{name} two way": f"T 'wall' '{name}' 'wall' R"}
    # The rays see the scene in the middle of the frame: the positions above are those at that time.
    # Rough plates have speckle, of which one in ten echoes has a fade below the noise: with this seed none has.
    radar = make_radar()
    paths = ep.trace(scene, radar, num_rays=20_000, start_time=-0.5 * radar.frame_duration, seed=6)
    return paths, parts | {"wall": "T 'wall' R"}, truth
