"""Poles, signs, guard rails, trees and drones."""
import numpy as np
import pytest

import echopath as ep
from echopath.tracing.tessellation import coarse_meshes
from support.closed import boundary_edges, extent, joined_parts, scene_of, volume_of

RADIUS = 40.0
ARC = RADIUS * np.array([(np.sin(turn), 1.0 - np.cos(turn)) for turn in np.linspace(0.0, 0.3, 9)])  # m, to the left
MAKERS = {"pole": ep.actors.pole, "guard_rail": lambda: ep.actors.guard_rail(length=6.0),
          "bent rail": lambda: ep.actors.guard_rail(points=ARC), "tree": ep.actors.tree,
          "round": lambda: ep.actors.traffic_sign(shape="round"), "triangle": lambda: ep.actors.traffic_sign(shape="triangle"),
          "rectangle": lambda: ep.actors.traffic_sign(shape="rectangle"),
          "octagon": lambda: ep.actors.traffic_sign(shape="octagon"), "drone": ep.actors.drone}
OPEN = ("crown",)   # leaves are single facets


@pytest.mark.parametrize("name", MAKERS)
def test_each_part_is_closed_with_its_front_outside(name):
    for part in MAKERS[name]().parts:
        if part.name not in OPEN:
            assert boundary_edges(part.mesh.triangles) == [], part.name
            assert volume_of(part.mesh.vertices, part.mesh.triangles) > 0.0, part.name


@pytest.mark.parametrize("name", MAKERS)
def test_no_faces_lie_on_each_other_and_curved_parts_are_fine_enough(name):
    scene = scene_of(MAKERS[name]())
    if name != "tree":                # leaves that cross are meant
        assert scene.coplanar_overlaps() == []
    assert coarse_meshes(scene, 77e9) == []


@pytest.mark.parametrize("shape, area", [("round", np.pi * 0.3**2), ("triangle", np.sqrt(3) / 4 * 0.6**2),
                                         ("rectangle", 0.4 * 0.6), ("octagon", 2 * (np.sqrt(2) - 1) * 0.6**2)])
def test_signs_have_the_area_of_their_shape_and_face_the_radar(shape, area):
    sign = ep.actors.traffic_sign(shape=shape, size=0.6, height=2.0)
    part = sign.parts[0]
    assert volume_of(part.mesh.vertices, part.mesh.triangles) == pytest.approx(0.003 * area, rel=0.01, abs=0)
    assert part.mesh.vertices[:, 2].min() == pytest.approx(2.0) and part.mesh.vertices[:, 0].min() == 0.0


def test_a_sign_flashes_as_a_plate_of_its_area_does():
    scene = ep.Scene()
    scene.add(ep.actors.traffic_sign(shape="rectangle", size=0.3).parts[0].mesh, name="sign", material="metal")
    wavelength = ep.speed_of_light / 77e9
    found = ep.rcs(scene, frequency=77e9, incidence=(-1.0, 0.0, 0.0), num_rays=65536)
    assert 10 * np.log10(found) == pytest.approx(10 * np.log10(4 * np.pi * (0.3 * 0.2) ** 2 / wavelength**2), abs=0.3)


@pytest.mark.parametrize("radius, end", [(0.07, 0.04), (0.04, 0.04), (0.02, 0.02), (0.001, 0.001)])
def test_a_pole_is_nowhere_wider_than_at_its_foot(radius, end):
    """Unless told so, as a wire or a fence post that is named by its radius alone."""
    vertices = np.asarray(ep.actors.pole(height=1.0, radius=radius).parts[0].mesh.vertices)
    distance, is_end = np.hypot(vertices[:, 0], vertices[:, 1]), vertices[:, 2] > 0.5
    assert distance[is_end].max() == pytest.approx(end, rel=1e-12, abs=0)
    assert distance[~is_end].max() == pytest.approx(radius, rel=1e-12, abs=0)
    widened = ep.actors.pole(height=1.0, radius=radius, end_radius=0.1).parts[0].mesh.vertices
    assert np.hypot(*np.asarray(widened).T[:2]).max() == pytest.approx(0.1, rel=1e-12, abs=0)


def test_the_rail_has_the_w_profile():
    rail = ep.actors.guard_rail(length=6.0)
    size, _ = extent(rail, lambda name: name == "rail")
    np.testing.assert_allclose(size, (6.0, 0.081 + 0.003, 0.311), atol=0.004)
    assert extent(rail, lambda name: name == "posts")[1] == -0.05   # below the ground


def test_a_bent_rail_has_that_profile_all_along_its_line():
    """Its front on the arc, to the right; posts behind it, as upright and as wide as those of a straight one."""
    bent, straight = ep.actors.guard_rail(points=ARC), ep.actors.guard_rail(length=0.3 * RADIUS)
    for part, same in zip(bent.parts, straight.parts, strict=True):
        (x, y, z), old = np.asarray(part.mesh.vertices).T, np.asarray(same.mesh.vertices)
        behind = RADIUS - np.hypot(x, y - RADIUS)
        assert [behind.min(), behind.max()] == pytest.approx([old[:, 1].min(), old[:, 1].max()], abs=1e-4)
        assert [z.min(), z.max()] == [old[:, 2].min(), old[:, 2].max()]
        along = RADIUS * np.arctan2(x, RADIUS - y)
        assert [along.min(), along.max()] == pytest.approx([0.0, 0.3 * RADIUS], abs=0.06)
    one, other = (np.asarray(actor.parts[1].mesh.vertices)[24:48] for actor in (bent, straight))
    apart, other_apart = (np.sort(np.linalg.norm(post[:, None] - post, axis=2).ravel()) for post in (one, other))
    np.testing.assert_allclose(apart, other_apart, atol=1e-12)


def test_a_rail_along_straight_points_is_the_straight_one():
    for part, same in zip(ep.actors.guard_rail(points=[(-3.0, 0.0), (0.0, 0.0), (3.0, 0.0)]).parts,
                          ep.actors.guard_rail(length=6.0).parts, strict=True):
        np.testing.assert_allclose(part.mesh.vertices, same.mesh.vertices, atol=1e-12)


@pytest.mark.parametrize("keywords, told", [
    ({"points": ARC, "length": 3.0}, "^length: cannot be given beside points, which say how long the rail is, got 3"),
    ({"points": [(0, 0), (1, 0), (0.8, 0.1)]}, "^points: must be those of a line of at most 10000 m that nowhere bends"),
    ({"points": [(0, 0), (9000, 0), (20000, 5)]}, "^points: must be those of a line of at most 10000 m"),
    ({"points": [(0, 0)]}, "^points: must be 2 to ")])
def test_rails_of_no_line_are_refused(keywords, told):
    with pytest.raises(ValueError, match=told):
        ep.actors.guard_rail(**keywords)


def test_a_tree_is_the_same_for_its_seed_alone():
    first, again, other = (np.asarray(ep.actors.tree(seed=s).parts[2].mesh.vertices) for s in (4, 4, 5))
    np.testing.assert_array_equal(first, again)
    assert not np.array_equal(first, other)


def test_rotors_turn_as_fast_as_asked_and_neighbours_against_each_other():
    scene = scene_of(ep.actors.drone(rotor_rpm=6000.0))
    turns = {}
    for mesh in scene.meshes:
        if "rotor" in mesh.name:
            quarter = [scene.world_vertices(mesh.id, t) for t in (0.0, 0.0025)]    # a quarter of a turn of 10 ms
            center = 0.5 * (quarter[0].min(axis=0) + quarter[0].max(axis=0))
            tip = np.argmax(np.linalg.norm((quarter[0] - center)[:, :2], axis=1))
            a, b = ((points[tip] - center)[:2] for points in quarter)
            turns[mesh.name] = np.degrees(np.arctan2(a[0] * b[1] - a[1] * b[0], a @ b))
    signs = [turns[f"a/rotor_{name}"] for name in ("front_left", "front_right", "rear_left", "rear_right")]
    np.testing.assert_allclose(np.abs(signs), 90.0, atol=1.5)
    assert np.sign(signs).tolist() == [1.0, -1.0, -1.0, 1.0]


def test_crown_fills_its_ellipsoid():
    vertices = np.asarray(ep.actors.tree(height=8.0, crown_radius=2.5).parts[2].mesh.vertices)
    assert vertices[:, 2].min() > 0.3 * 8.0 and vertices[:, 2].max() < 8.3
    assert np.hypot(vertices[:, 0], vertices[:, 1]).max() < 2.5 + 0.3
    assert joined_parts(ep.actors.tree(), lambda name: name == "trunk")[0][:, 2].min() == -0.05
