"""A street of twenty objects, and traces of it that are compared bit by bit."""
from __future__ import annotations

import numpy as np

import echopath as ep
from support.radars import build_radar

NUM_RAYS = 4096
ARRAYS = ("offsets", "num_bounces", "diffuse", "weight", "mesh_id", "triangle_id", "u", "v", "stratum", "batch", "flags",
          "amplitude")


def radar(**settings):
    return build_radar(receivers=[(0, 0.01, 0), (0, -0.01, 0)], num_chirps=8, bandwidth=1e8, **settings)


def street_table() -> dict:
    """{name: keywords of Scene.add} of twenty objects: ground, two walls, a bus with three parts, 16 boxes and posts."""
    table = {
        "ground": {"content": ep.actors.plate(width=80.0, height=30.0), "transform": [[0, 0, 1, 30], [1, 0, 0, 0], [0, 1, 0, -1],
                                                                                      [0, 0, 0, 1]], "material": "concrete"},
        "left": {"content": ep.actors.box(size=(60.0, 0.2, 4.0)), "position": (30, 9, 0), "material": "concrete"},
        "right": {"content": ep.actors.box(size=(60.0, 0.2, 4.0)), "position": (30, -9, 0), "material": "concrete"},
        "bus": {"content": [("body", box_mesh(4.0, 2.0, 2.0)), ("mirror", box_mesh(0.1, 0.3, 0.2)),
                            ("wheel", box_mesh(0.6, 0.2, 0.6))], "position": (40, 3, 0), "yaw": 0.1, "material": "metal",
                "motion": ep.LinearMotion(velocity=(-9, 0, 0))},
    }
    for number in range(16):
        moves = number % 4 == 0
        table[f"box{number}"] = {
            "content": box_mesh(0.5, 0.4, 0.3 + 0.05 * number),
            "position": (8 + 2.5 * number, (-1) ** number * (1 + number % 5), 0),
            "yaw": 0.2 * number, "material": ("metal", "skin", "wood")[number % 3],
            "motion": ep.LinearMotion(velocity=(0, 2, 0), angular_velocity=(0, 0, 1)) if moves else None}
    return table


def box_mesh(length, width, height):
    return ep.actors.box(size=(length, width, height))


def built(table) -> ep.Scene:
    scene = ep.Scene()
    for name, keywords in table.items():
        keywords = dict(keywords)
        scene.add(keywords.pop("content"), name=name, **keywords)
    return scene


def traced(scene, **settings):
    return ep.trace(scene, radar(), num_rays=NUM_RAYS, max_bounces=3, seed=3, **settings)


def assert_same_bits(one, other):
    for name in ARRAYS:
        first, second = np.asarray(getattr(one, name)), np.asarray(getattr(other, name))
        assert first.dtype == second.dtype and np.array_equal(first, second), name
