"""Scenes and radars whose validity is known."""

import echopath as ep
from support.radars import build_radar


def radar_of(num_chirps=128, chirp_interval=40e-6, transmitters=((0, 0, 1),), receivers=((0, 0, 1),), motion=None):
    return build_radar(transmitters, receivers, num_samples=512, num_chirps=num_chirps, chirp_interval=chirp_interval,
                       motion=motion)


def scene_of(**objects):
    """Scene of name=(mesh, material, position, motion)."""
    scene = ep.Scene()
    for name, (mesh, material, position, motion) in objects.items():
        scene.add(mesh, name=name, material=material, position=position, motion=motion)
    return scene


BALL = ep.actors.sphere(0.5)
