"""What it costs the geometry that something moves: one object among thousands, a body that deforms, many small ones.

Each figure stands beside Embree's own share of it with a tree for each mesh, of which those that move are fitted: what a
program pays that does nothing else. Smaller ones than that come from trees that small neighbours share.
"""
from __future__ import annotations

import statistics

import numpy as np

import echopath as ep

from ...actors import shapes
from . import city

ROUNDS, QUICK_ROUNDS = 21, 3
STEP = 1e-3                        # s from pose to pose
BOXES, QUICK_BOXES = 100_000, 2_000
HOUSES, QUICK_HOUSES = 2300, 300
LIMIT_RATIO = 3.0                  # of the seconds of an update over those of Embree alone


def _sphere(subdivisions: int, **keywords) -> ep.Scene:
    scene = ep.Scene()
    scene.add(shapes.sphere(1.0, subdivisions=subdivisions), name="body", material=ep.Material.metal(), **keywords)
    return scene


def _driving_through(scene: ep.Scene, body: ep.Mesh) -> ep.Scene:
    scene.add(body, name="car", material=ep.Material.metal(), position=(0.0, 0.0, 2.0),
              motion=ep.LinearMotion(velocity=(10.0, 0.0, 0.0), angular_velocity=(0.0, 0.0, 0.3)))
    return scene


def _boxes(count: int) -> ep.Scene:
    scene, metal, mesh = ep.Scene(), ep.Material.metal(), shapes.box((1.0, 1.0, 1.0))
    side = int(np.ceil(np.sqrt(count)))
    for index in range(count):
        scene.add(mesh, name=f"box_{index}", material=metal, position=(3.0 * (index % side), 3.0 * (index // side), 0.0))
    return scene


def _waves(subdivisions: int) -> ep.Scene:
    mesh = shapes.sphere(1.0, subdivisions=subdivisions)
    vertices = np.asarray(mesh.vertices)
    lift = 0.05 * np.sin(4.0 * vertices[:, :1]) * np.array([[0.0, 0.0, 1.0]])
    frames = np.stack([vertices, vertices + lift, vertices - lift, vertices])
    return _sphere(subdivisions, motion=ep.VertexSequence(times=np.arange(4.0), vertices=frames))


def _cases(quick: bool) -> dict:
    body, fine = shapes.sphere(2.0, subdivisions=8), 10 if quick else 71
    turning = ep.LinearMotion(velocity=(1.0, 0.0, 0.0), angular_velocity=(0.0, 0.0, 1.0))
    houses = city.scene_of(city.houses(QUICK_HOUSES if quick else HOUSES), mirror=False)
    return {"one car drives through a city": _driving_through(houses, body),
            "one car drives among boxes": _driving_through(_boxes(QUICK_BOXES if quick else BOXES), body),
            "a rigid body turns": _sphere(fine, motion=turning),
            "a body deforms": _waves(fine)}


def rows(*, quick: bool = False) -> list[dict]:
    """A row for each case: s of the processor for the first pose, and medians for the next ones, of Embree alone too."""
    times = STEP * np.arange((QUICK_ROUNDS if quick else ROUNDS) + 1)
    found = []
    for name, scene in _cases(quick).items():
        seconds = ep._core.bench.moved_geometry(scene, times)
        again, bare = statistics.median(seconds["again"]), statistics.median(seconds["bare"])
        found.append({"name": name, "meshes": len(scene.meshes), "triangles": scene.num_triangles, "first_s": seconds["first"],
                      "again_s": again, "bare_s": bare, "ratio": again / bare})
    return found


def describe(rows: list[dict]) -> list[str]:
    """The rows in words."""
    lines = ["geometry of a moved object, processor time", f"{'':<32}{'meshes':>9}{'triangles':>11}{'first':>11}{'next':>12}"
             f"{'Embree alone':>14}{'over it':>9}"]
    lines += [f"{row['name']:<32}{row['meshes']:>9,}{row['triangles']:>11,}{1e3 * row['first_s']:>8.1f} ms"
              f"{1e6 * row['again_s']:>9.0f} us{1e6 * row['bare_s']:>11.0f} us{row['ratio']:>9.2f}  {_verdict(row)}"
              for row in rows]
    return lines


def _verdict(row: dict) -> str:
    return "holds" if row["ratio"] <= LIMIT_RATIO else f"MISSED {LIMIT_RATIO:g}"
