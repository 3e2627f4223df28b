"""Meshes that are drawn together and with fewer triangles while something moves."""
from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

import echopath as ep
from echopath_viewer.model import Session, from_frame, mesh_palette
from echopath_viewer.scene_builder import SceneBuilder
from echopath_viewer.scene_builder.mesh_layer import MeshLayer
from echopath_viewer.scene_builder.quick_meshes import coarse_shape
from support import shapes

RADIUS = 0.5  # m
SIZE = (300, 300)  # pixels
TO_THE_LEFT = ep.LinearMotion(velocity=(0.0, 1.0, 0.0))


def ball(subdivisions: int):
    poly = pv.Icosphere(radius=RADIUS, nsub=subdivisions)
    return np.asarray(poly.points, float), np.asarray(poly.regular_faces)


def area_of(points, triangles) -> float:
    corners = points[triangles]
    return 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum()


def farthest(points, others) -> float:
    """Largest distance in m of any of the points [N, 3] from the nearest of others [M, 3]."""
    points, others = np.asarray(points, float), np.asarray(others, float)
    halves = 0.5 * (others**2).sum(axis=1)
    nearest = others[np.argmin(halves - points @ others.T, axis=1)]
    return float(np.linalg.norm(points - nearest, axis=1).max())


def test_a_coarse_ball_has_fewer_triangles_and_the_area_of_a_ball():
    points, triangles = ball(5)
    shape = coarse_shape(points, triangles, 0.05)
    rows, coarse = shape.rows, shape.triangles
    assert len(coarse) < 0.3 * len(triangles)
    assert area_of(points[rows], coarse) == pytest.approx(4.0 * np.pi * RADIUS**2, rel=0.05)
    sides = np.sort(coarse, axis=1)
    assert (np.diff(sides, axis=1) > 0).all() and sides.max() < len(rows)
    assert farthest(points, points[rows]) <= np.sqrt(3.0) * 0.05  # two places in one cube are no farther apart


def test_without_cells_a_shape_stays_as_it_is():
    points, triangles = ball(2)
    shape = coarse_shape(points, triangles, 0.0)
    assert np.array_equal(shape.rows, np.arange(len(points))) and np.array_equal(shape.triangles, triangles)


def test_a_body_smaller_than_a_cell_has_no_triangles():
    shape = coarse_shape(*ball(2), 10.0)
    assert len(shape.rows) == 1 and len(shape.triangles) == 0


@pytest.mark.parametrize("radius, height, subdivisions", [(0.05, 4.0, 0), (0.04, 0.25, 3), (0.003, 10.0, 0)])
@pytest.mark.parametrize("direction", [(0.0, 0.0, 1.0), (1.0, 0.5, 0.2)])
@pytest.mark.parametrize("cell", [0.125, 0.2, 1.0])
def test_thin_bodies_that_are_longer_than_a_cell_are_seen_over_their_length(radius, height, subdivisions, direction, cell):
    """Poles, limbs and wires."""
    poly = pv.Cylinder(radius=radius, height=height, direction=direction, resolution=24).triangulate().subdivide(subdivisions)
    points, triangles = np.asarray(poly.points, float), np.asarray(poly.regular_faces)
    shape = coarse_shape(points, triangles, cell)
    if np.ptp(points, axis=0).max() <= cell:
        assert len(shape.triangles) == 0
        return
    axis = np.array(direction) / np.linalg.norm(direction)
    along = points[shape.rows][shape.triangles].reshape(-1, 3) @ axis
    assert np.ptp(along) >= height - 2.0 * cell


@pytest.fixture
def layer():
    """Two balls beside each other over a mirror, before a camera."""
    scene, mesh = ep.Scene(), ep.Mesh(*ball(4))
    for name, side in (("left", -0.7), ("right", 0.7)):
        scene.add(mesh, name=name, material="plastic", position=(0.0, side, 0.5), motion=TO_THE_LEFT)
    scene.add(shapes.rectangle((-1.5, -1.5, -0.2), (3.0, 0.0, 0.0), (0.0, 3.0, 0.0)), name="floor",
              material=ep.Material.metal(mirror=True))
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    plotter.set_background("white")
    made = MeshLayer(plotter, scene, mesh_palette(scene), 0.0)
    made.show(set(), set())
    plotter.camera_position = "iso"
    plotter.reset_camera()
    made.plotter = plotter
    yield made
    plotter.close()


def picture(layer):
    layer.plotter.render()
    return layer.plotter.screenshot(None, return_img=True).astype(int)


def share_that_differs(one, other) -> float:
    """Of the pixels."""
    return float((np.abs(one - other).max(axis=-1) > 24).mean())


def cells_of(size: float):
    return lambda low, high: np.full(len(low), size)


def test_quick_meshes_look_like_each_mesh_drawn_by_itself(layer):
    each = picture(layer)
    layer.show_quick(cells_of(0.02))
    quick = picture(layer)
    assert share_that_differs(each, np.full_like(each, 255)) > 0.05
    assert share_that_differs(each, quick) < 0.02
    layer.show_each()
    assert np.array_equal(picture(layer), each)


def test_quick_meshes_move_and_the_others_are_there_when_it_is_over(layer):
    layer.show_quick(cells_of(0.02))
    before = picture(layer)
    layer.move(0.5)
    layer.show_quick(cells_of(0.02))
    moved = picture(layer)
    assert share_that_differs(before, moved) > 0.05
    layer.show_each()
    assert share_that_differs(picture(layer), moved) < 0.02


def test_what_is_hidden_stays_hidden_and_what_is_chosen_keeps_its_edges(layer):
    layer.show_quick(cells_of(0.02))
    layer.show({0, 1}, set())
    layer.show_quick(cells_of(0.02))
    without = picture(layer)
    layer.show_each()
    assert share_that_differs(picture(layer), without) < 0.005
    layer.show({1}, {0})
    layer.show_quick(cells_of(0.02))
    assert [bool(actor.GetVisibility()) for actor in layer.actors] == [True, False, False]


def test_meshes_that_are_looked_for_have_their_own_places_meanwhile(layer):
    layer.show_quick(cells_of(0.02))
    layer.move(0.5)
    with layer.each() as actors:
        assert [bool(actor.GetVisibility()) for actor in actors] == [True] * 3
        assert actors[0].GetCenter() == pytest.approx((0.0, -0.2, 0.5), abs=1e-3)
    assert not any(actor.GetVisibility() for actor in actors)


def test_pictures_of_what_rests_do_not_depend_on_the_order_of_triangles(moving_sequence):
    """What lies behind shines through: blended in that order the far side of a ball may lie over the near one."""
    points, triangles = ball(3)
    order = np.argsort(points[triangles].mean(axis=1) @ (1.0, 1.0, 1.0))
    pictures = []
    for sorted_triangles in (triangles[order], triangles[order[::-1]]):
        scene = ep.Scene()
        scene.add(ep.Mesh(points, sorted_triangles), name="ball", material=shapes.lambert(0.8), position=(2.0, 0.0, 0.0))
        frame = ep.simulate(scene, moving_sequence.radar, num_rays=500, max_bounces=1, seed=1)
        plotter = pv.Plotter(off_screen=True, window_size=SIZE)
        builder = SceneBuilder(plotter, Session(from_frame(frame)), show_legend=False, is_quick=True)
        builder.show_quick_meshes(100.0)
        assert not plotter.renderer.GetUseOIT()
        builder.show_quick_meshes(None)
        builder.rays.show_first(0)
        plotter.camera_position = "iso"
        plotter.reset_camera()
        plotter.render()
        pictures.append(plotter.screenshot(None, return_img=True).astype(int))
        plotter.close()
    assert share_that_differs(pictures[0], np.full_like(pictures[0], 255)) > 0.05
    assert np.abs(pictures[0] - pictures[1]).max() <= 1


def test_a_body_of_another_form_is_not_drawn_with_the_triangles_of_the_one_before():
    """Two balls that touch in the first frame and part: each vertex is drawn no farther away than a cell's diagonal."""
    (points, triangles), cell = ball(4), 0.2
    both = np.concatenate([triangles, triangles + len(points)])
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    layer = MeshLayer(plotter, pair_of_balls(points, points, both), np.uint8([[90, 90, 90]]), 0.0)
    layer.show_quick(cells_of(cell))
    for size, distance in ((1.0, 2.0), (1.0, 2.0), (3.0, 4.0), (1.0, 0.0)):
        scene = pair_of_balls(size * points, size * points + (0.0, distance, 0.0), both)
        assert layer.fits(scene)
        layer.take(scene, np.uint8([[90, 90, 90]]), 0.0)
        layer.show_quick(cells_of(cell))
        drawn = np.asarray(layer._quick._drawn["bodies"][1].points)
        assert farthest(scene.world_vertices(0, 0.0), drawn) <= np.sqrt(3.0) * cell * 1.001
    plotter.close()


def pair_of_balls(one, other, triangles):
    scene = ep.Scene()
    scene.add(ep.Mesh(np.concatenate([one, other]), triangles), name="balls", material="plastic")
    return scene


def test_a_stiff_body_keeps_its_triangles_wherever_it_moves():
    points, triangles = ball(4)
    shape, random = coarse_shape(np.float32(points), triangles, 0.1), np.random.default_rng(1)
    for _ in range(20):
        turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
        assert shape.fits(np.float32(points @ turn.T + random.uniform(-100.0, 100.0, 3)))
    assert not shape.fits(np.float32(3.0 * points)) and not shape.fits(np.float32(points[:-1]))
