"""A small frame that is written to files."""
from __future__ import annotations

import numpy as np

import echopath as ep
from support.radars import build_radar
from support.shapes import lambert, quad

PARTS = {"route": {"direct": "T . R", "wall": "T .* 'wall' .* R"}, "body": {"fan": "T .* 'fan' .* R"}}


def fan():
    """Three sheets on one edge: a non-manifold mesh that waves."""
    vertices = np.array([[0, 0, 0], [0, 0, 1], [1, 0, 0], [0, 1, 0], [-1, 0, 0.0]])
    frames = np.stack([vertices, vertices * [1, 1, 1.1], vertices * [1, 1.2, 1], vertices])
    sequence = ep.VertexSequence(times=[-1.0, 0.0, 1.0, 2.0], vertices=frames, interpolation="linear")
    return ep.Mesh(vertices, [[0, 1, 2], [0, 1, 3], [0, 1, 4]]), sequence


def make_scene():
    """A wall that is a mirror, a deforming fan, two turning plates of one mesh, under a moving parent."""
    scene = ep.Scene()
    wall = quad((-5, 3, -5), (40, 3, -5), (40, 3, 6), (-5, 3, 6))
    rough = ep.Material(permittivity=5 - 0.3j, scattering=0.3, cross_polarization=0.2, mirror=True)
    scene.add(wall, name="wall", material=rough)
    mesh, sequence = fan()
    scene.add(mesh, name="fan", material=lambert(0.27), motion=sequence, position=(6, 0, 0))
    keys = ep.KeyframeMotion(times=[-1.0, 0.0, 1.0, 2.0],
                             translations=[[0, 0, 0], [0.1, 0, 0], [0.1, 0.2, 0], [0, 0, 0.0]])
    scene.add(None, name="carrier", motion=keys, position=(8, 1, 0), yaw=0.3)
    plate = quad((0, -0.5, -0.5), (0, 0.5, -0.5), (0, 0.5, 0.5), (0, -0.5, 0.5))
    spin = ep.LinearMotion(velocity=(-1, 0, 0), angular_velocity=(0, 0, 0.5))
    for index in range(2):
        scene.add(plate, name=f"plate{index}", material=ep.Material.metal(), motion=spin, parent="carrier",
                  position=(0, 0, index))
    return scene


def make_radar():
    receivers = [ep.Antenna((0, 0.01 * (i + 1), 0), pattern=ep.CosinePower(2.0)) for i in range(2)]
    return build_radar([ep.Antenna(polarization=(0, 1, 0))], receivers, num_chirps=16, chirp_interval=1e-4,
                       transmit_power=0.02, noise_figure_db=9.0, position=(0.1, -0.2, 0.3), yaw=0.05, pitch=-0.02,
                       motion=ep.LinearMotion(velocity=(1, 0, 0)))
