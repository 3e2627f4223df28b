"""Curved surfaces whose triangles touch without common corners, are wound either way or listed twice: spheres against Mie."""
import gc
import math
import warnings

import numpy as np
import pytest

import echopath as ep
from echopath.scene import seams
from support.rcs_targets import RADIUS, SMOOTH_TOLERANCE_DB
from support.shapes import FREQUENCY, METAL, decibel, scene_of, sphere

SEEN_FROM = ((1, 0, 0), (1, -0.2, 0.3), (1, 0.05, 0.02))  # about the seam of the grid
NUM_RAYS = 1 << 13


def grid_of_angles(columns):
    """A sphere by polar angles, whose last column lies on the first one to the rounding of sines alone."""
    around, down = np.meshgrid(np.linspace(0, 2 * math.pi, columns + 1), np.linspace(0, math.pi, columns // 2 + 1), indexing="ij")
    points = RADIUS * np.stack([np.sin(down) * np.cos(around), np.sin(down) * np.sin(around), np.cos(down)], axis=-1)
    rows = columns // 2 + 1
    first = (np.arange(columns)[:, None] * rows + np.arange(rows - 1)).ravel()
    triangles = [np.column_stack([first, first + rows, first + rows + 1]), np.column_stack([first, first + rows + 1, first + 1])]
    return ep.Mesh(points.reshape(-1, 3), np.concatenate(triangles))


def with_own_corners(mesh):
    return ep.Mesh(mesh.vertices[mesh.triangles].reshape(-1, 3), np.arange(3 * len(mesh.triangles)).reshape(-1, 3))


def wound_either_way(mesh):
    triangles = np.array(mesh.triangles)
    turned = np.random.default_rng(1).random(len(triangles)) < 0.5
    triangles[turned] = triangles[turned][:, ::-1]
    return ep.Mesh(mesh.vertices, triangles)


def listed_twice(mesh):
    return ep.Mesh(mesh.vertices, np.concatenate([mesh.triangles, mesh.triangles[:, ::-1]]))


MESHES = {"a grid that closes": lambda: grid_of_angles(48),
          "corners of their own": lambda: with_own_corners(sphere((0, 0, 0), RADIUS, 4)),
          "wound either way": lambda: wound_either_way(sphere((0, 0, 0), RADIUS, 4)),
          "corners of their own, wound either way": lambda: with_own_corners(wound_either_way(sphere((0, 0, 0), RADIUS, 4))),
          "listed twice": lambda: listed_twice(sphere((0, 0, 0), RADIUS, 4))}


@pytest.mark.parametrize("kind", MESHES)
def test_seams_do_not_change_the_level_of_a_sphere(kind):
    mesh = MESHES[kind]()
    scene = scene_of(ball=(mesh, METAL, True))
    found = ep.rcs(scene, frequency=FREQUENCY, incidence=SEEN_FROM, num_rays=NUM_RAYS, max_bounces=1)
    assert np.all(np.abs(decibel(found / ep.mie_rcs(RADIUS, FREQUENCY))) < SMOOTH_TOLERANCE_DB)
    joined = scene.meshes[0].mesh
    middles, as_given = (one.vertices[one.triangles].mean(axis=1) for one in (joined, mesh))
    assert np.allclose(middles, as_given, rtol=0, atol=1e-9 * RADIUS)
    assert np.array_equal(joined.original_triangle, mesh.original_triangle)


def test_meshes_of_a_list_go_on_in_one_another():
    """Two halves of a sphere, as groups of a file are, seen where they meet; a facet behind them stays what it is."""
    ball, aside = sphere((0, 0, 0), RADIUS, 4), ep.Mesh([[-.11, 0, 0], [-.11, .01, 0], [-.11, 0, .01]], [[0, 1, 2]])
    is_left = ball.vertices[ball.triangles].mean(axis=1)[:, 1] > 0.0
    given = [ep.Mesh(ball.vertices, ball.triangles[is_left]), aside, ep.Mesh(ball.vertices, ball.triangles[~is_left])]
    named = list(zip(("left", "aside", "right"), given, strict=True))
    scene = ep.Scene()
    scene.add(named, name="ball", material="metal", smooth=True)
    scene.add(named, name="another", material="metal", smooth=True, visible=False)
    found = ep.rcs(scene, frequency=FREQUENCY, incidence=SEEN_FROM[::2], num_rays=2 * NUM_RAYS, max_bounces=1)
    assert np.all(np.abs(decibel(found / ep.mie_rcs(RADIUS, FREQUENCY))) < SMOOTH_TOLERANCE_DB)
    assert [len(mesh.mesh.triangles) for mesh in scene.meshes] == [len(mesh.triangles) for mesh in given]
    assert scene.meshes[1].mesh is aside
    assert all(one.mesh is two.mesh for one, two in zip(scene.nodes[1:4], scene.nodes[5:8], strict=True))


def test_models_without_normals_have_no_seams(tmp_path):
    ball = with_own_corners(sphere((0, 0, 0), RADIUS, 4))
    lines = [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in ball.vertices]
    side = np.where(ball.vertices[ball.triangles].mean(axis=1)[:, 1] > 0.0, "left", "right")
    lines += [f"g {group}\nf {a} {b} {c}" for group, (a, b, c) in zip(side, ball.triangles + 1, strict=True)]
    (tmp_path / "ball.obj").write_text("\n".join(lines) + "\n")
    scene = ep.Scene()
    scene.add(ep.load_model(tmp_path / "ball.obj", smooth=True), name="ball", material="metal")
    found = ep.rcs(scene, frequency=FREQUENCY, incidence=SEEN_FROM, num_rays=NUM_RAYS, max_bounces=1)
    assert np.all(np.abs(decibel(found / ep.mie_rcs(RADIUS, FREQUENCY))) < SMOOTH_TOLERANCE_DB)


def test_what_is_known_of_a_mesh_goes_with_it():
    gc.collect()
    before = len(seams._known)
    ball = sphere((0, 0, 0), RADIUS, 2)
    opened = ep.Mesh(ball.vertices, ball.triangles[1:])
    scene_of(ball=(opened, METAL, True))
    assert len(seams._known) == before + 1
    del opened
    gc.collect()
    assert len(seams._known) == before


def test_meshes_without_seams_and_flat_ones_stay_what_they_are():
    whole = sphere((0, 0, 0), RADIUS, 2)
    assert scene_of(ball=(whole, METAL, True)).meshes[0].mesh is whole
    cut = grid_of_angles(24)
    assert scene_of(ball=(cut, METAL, False)).meshes[0].mesh is cut
    opened = ep.Mesh(whole.vertices, whole.triangles[1:])
    assert scene_of(ball=(opened, METAL, True)).meshes[0].mesh is opened


def test_most_triangles_keep_their_winding():
    """On it depends which layer of a sheet is met first."""
    mesh = sphere((0, 0, 0), RADIUS, 2)
    triangles = np.array(mesh.triangles)
    triangles[:9] = triangles[:9, ::-1]
    joined = scene_of(ball=(ep.Mesh(mesh.vertices, triangles), METAL, True)).meshes[0].mesh
    corners = joined.vertices[joined.triangles]
    assert np.all(np.linalg.det(corners) > 0.0)  # outward


def test_vertices_of_a_long_rough_pipe_are_told_apart():
    """Across it there is one at each millionth of its length, so that coordinates alone tell none from the others."""
    rings, around = 301, 12
    along, angle = np.repeat(10.0 * np.arange(rings), around), np.tile(2 * math.pi * np.arange(around) / around, rings)
    angle += 1e-3 * along
    radius = 0.5 + 0.01 * np.random.default_rng(1).standard_normal(rings * around).clip(-2, 2)
    here = np.arange((rings - 1) * around).reshape(-1, around)
    beside = np.roll(here, -1, axis=1)
    triangles = np.stack([here, here + around, beside, beside, here + around, beside + around], axis=-1).reshape(-1, 3)
    pipe = ep.Mesh(np.stack([along, radius * np.cos(angle), radius * np.sin(angle)], axis=-1), triangles)
    joined = scene_of(pipe=(with_own_corners(pipe), METAL, True)).meshes[0].mesh
    assert len(joined.vertices) == rings * around
    assert np.array_equal(joined.vertices[joined.triangles], pipe.vertices[pipe.triangles])


@pytest.mark.parametrize("turn_deg, num_vertices", [(15, 6), (25, 8)])
def test_surfaces_stay_cut_where_they_turn(turn_deg, num_vertices):
    """Two squares with corners of their own that meet along y, as files with normals part them along an edge."""
    turn = math.radians(turn_deg)
    rims = [(-1, 0, 0), (0, 0, 0), (0, 0, 0), (math.cos(turn), 0, math.sin(turn))]
    roof = ep.Mesh(np.array([(x, y, z) for x, _, z in rims for y in (0, 1)], float),
                   [[0, 2, 3], [0, 3, 1], [4, 6, 7], [4, 7, 5]])
    assert len(scene_of(roof=(roof, METAL, True)).meshes[0].mesh.vertices) == num_vertices


@pytest.mark.parametrize("kind", ["a grid that closes", "corners of their own", "wound either way"])
def test_what_has_lost_its_seams_takes_frames_of_all_vertices(kind):
    mesh = MESHES[kind]()
    scene = scene_of(ball=(mesh, METAL, True))
    vertices = np.zeros((mesh.num_input_vertices, 3))
    vertices[mesh.original_vertex] = mesh.vertices
    scene["ball"].motion = ep.VertexSequence(times=[0.0, 1.0], vertices=[vertices, 2.0 * vertices])
    assert np.linalg.norm(scene.world_vertices(0, 1.0), axis=1) == pytest.approx(2.0 * RADIUS, rel=1e-9, abs=0)


def test_facets_too_coarse_are_told_where_they_have_corners_of_their_own():
    for subdivisions, told in ((2, True), (5, False)):
        scene = scene_of(ball=(with_own_corners(sphere((0, 0, 0), RADIUS, subdivisions)), METAL))
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            ep.rcs(scene, frequency=FREQUENCY, incidence=(1, 0, 0), num_rays=10)
        assert any(one.category is ep.TessellationWarning for one in caught) == told
