"""Simple bodies: areas, volumes and directions against closed forms."""
import numpy as np
import pytest

import echopath as ep

INSCRIBED = 0.01   # relative: a surface with its vertices on a sphere in 12 pieces a quarter turn lies that much inside
ROUNDING = 1e-12
REFLECTED = 1e-9   # of unit vectors: corners of meshes are rounded


def corners(mesh):
    """Corners [F, 3, 3] of a mesh's triangles."""
    return np.asarray(mesh.vertices)[np.asarray(mesh.triangles)]


def normals(mesh):
    """Unit normals [F, 3] on the side from which the triangles are counter-clockwise."""
    a, b, c = np.moveaxis(corners(mesh), 1, 0)
    n = np.cross(b - a, c - a)
    return n / np.linalg.norm(n, axis=1)[:, None]


def volume(mesh):
    a, b, c = np.moveaxis(corners(mesh), 1, 0)
    return np.sum(a * np.cross(b, c)) / 6.0


@pytest.mark.parametrize("edge", [None, 0.11])
def test_plate_fronts_the_radar_with_its_area(edge):
    mesh = ep.actors.plate(0.4, 0.7, edge=edge)
    assert mesh.area == pytest.approx(0.28, rel=ROUNDING, abs=0)
    np.testing.assert_allclose(normals(mesh), np.tile([-1.0, 0.0, 0.0], (len(mesh.triangles), 1)), atol=ROUNDING)
    np.testing.assert_allclose(np.ptp(mesh.vertices, axis=0), [0.0, 0.4, 0.7], atol=ROUNDING)
    np.testing.assert_allclose(np.mean(corners(mesh), axis=(0, 1))[0], 0.0, atol=ROUNDING)


def test_edge_bounds_the_grid():
    mesh = ep.actors.plate(0.4, 0.7, edge=0.11)
    assert len(mesh.triangles) == 2 * 4 * 7                      # ceil(.4 / .11) x ceil(.7 / .11)
    sides = np.linalg.norm(corners(mesh) - np.roll(corners(mesh), 1, axis=1), axis=-1)
    assert sides.max() <= np.sqrt(2.0) * 0.11


def reflect(direction, normal):
    return direction - 2.0 * np.dot(direction, normal) * normal


def test_dihedral_returns_what_comes_level():
    mesh = ep.actors.dihedral(0.3, 0.5, edge=0.1)
    assert mesh.area == pytest.approx(2 * 0.3 * 0.5, rel=ROUNDING, abs=0)
    first, second = np.unique(np.round(normals(mesh), 12), axis=0)
    assert np.dot(first, second) == pytest.approx(0.0, abs=REFLECTED)
    assert first[0] < 0 and second[0] < 0                        # both fronts are seen from -x
    level = np.array([np.cos(0.4), np.sin(0.4), 0.0])
    np.testing.assert_allclose(reflect(reflect(level, first), second), -level, atol=REFLECTED)
    assert np.max(mesh.vertices[:, 0]) <= ROUNDING    # the edge is at x = 0, the faces come towards the radar


def test_trihedral_returns_every_direction():
    mesh = ep.actors.trihedral(0.2, edge=0.07)
    assert mesh.area == pytest.approx(3 * 0.2**2 / 2, rel=ROUNDING, abs=0)
    faces = np.unique(np.round(normals(mesh), 12), axis=0)
    assert len(faces) == 3
    np.testing.assert_allclose(faces @ faces.T, np.eye(3), atol=REFLECTED)
    np.testing.assert_allclose(faces[:, 0], -1.0 / np.sqrt(3.0), atol=REFLECTED)   # symmetric about -x
    incident = np.array([0.9, 0.3, -0.2])
    back = incident
    for normal in faces:
        back = reflect(back, normal)
    np.testing.assert_allclose(back, -incident, atol=REFLECTED)


@pytest.mark.parametrize("make, expected", [
    (lambda: ep.actors.box((1.0, 2.0, 3.0)), (6.0, 22.0)),
    (lambda: ep.actors.box(0.5, edge=0.2), (0.125, 1.5)),
], ids=["plain", "divided"])
def test_box_is_closed_with_exact_volume_and_area(make, expected):
    mesh = make()
    assert mesh.is_closed
    assert (volume(mesh), mesh.area) == pytest.approx(expected, rel=ROUNDING, abs=0)


@pytest.mark.parametrize("make, expected", [
    (lambda: ep.actors.sphere(0.5), 4 / 3 * np.pi * 0.125),
    (lambda: ep.actors.sphere(0.5, edge=0.05), 4 / 3 * np.pi * 0.125),
    (lambda: ep.actors.ellipsoid((0.1, 0.2, 0.4)), 4 / 3 * np.pi * 0.008),
    (lambda: ep.actors.ellipsoid((0.4, 0.2, 0.1)), 4 / 3 * np.pi * 0.008),
    (lambda: ep.actors.capsule(0.1, 1.0), np.pi * 0.01 * 0.8 + 4 / 3 * np.pi * 0.001),
], ids=["sphere", "sphere by edge", "long ellipsoid", "flat ellipsoid", "capsule"])
def test_round_bodies_are_closed_and_fill_their_volume(make, expected):
    mesh = make()
    assert mesh.is_closed
    assert expected * (1.0 - INSCRIBED) < volume(mesh) < expected


def test_sphere_has_its_vertices_on_the_surface_and_20_n2_triangles():
    mesh = ep.actors.sphere(2.0, subdivisions=7)
    assert len(mesh.triangles) == 20 * 7**2
    np.testing.assert_allclose(np.linalg.norm(mesh.vertices, axis=1), 2.0, rtol=ROUNDING)
    by_edge = ep.actors.sphere(2.0, edge=0.3)
    assert np.linalg.norm(corners(by_edge) - np.roll(corners(by_edge), 1, axis=1), axis=-1).max() <= 0.3


def test_round_bodies_have_their_vertices_on_the_surface():
    axes = np.array([2.2, 0.9, 0.7])
    mesh = ep.actors.ellipsoid(axes, edge=0.1)
    np.testing.assert_allclose(np.sum((mesh.vertices / axes) ** 2, axis=1), 1.0, rtol=ROUNDING)
    capsule = ep.actors.capsule(0.1, 1.0).vertices
    from_axis = capsule - np.outer(np.clip(capsule[:, 2], -0.4, 0.4), [0, 0, 1])
    np.testing.assert_allclose(np.linalg.norm(from_axis, axis=1), 0.1, rtol=ROUNDING)


def test_ground_looks_up_and_wall_towards_the_street():
    ground = ep.actors.ground((4.0, 2.0), z=-0.3)
    np.testing.assert_allclose(normals(ground), [[0, 0, 1]] * 2, atol=ROUNDING)
    np.testing.assert_allclose(ground.vertices[:, 2], -0.3)
    assert ground.area == pytest.approx(8.0)
    wall = ep.actors.wall(5.0, 3.0)
    np.testing.assert_allclose(normals(wall), [[0, -1, 0]] * 2, atol=ROUNDING)
    assert (wall.vertices.min(axis=0).tolist(), wall.vertices.max(axis=0).tolist()) == ([-2.5, 0, 0], [2.5, 0, 3])


def test_an_actor_has_a_list_of_its_own():
    parts = [ep.Part("hand", ep.actors.plate(0.1, 0.1), "skin")]
    actor = ep.Actor(parts)
    parts.append("head")
    assert [part.name for part in actor.parts] == ["hand"] and ep.Actor(tuple(actor.parts)) == actor


@pytest.mark.parametrize("make, message", [
    (lambda: ep.actors.plate(-1.0, 1.0), "width: must be a finite number from 1e-09 to 1000000000 m, got -1.0"),
    (lambda: ep.actors.plate(1.0, float("nan")), "height: must be a finite number from 1e-09 to 1000000000 m, got nan"),
    (lambda: ep.actors.box((1.0, 2.0)), r"size: must be an array \[\] or \[3\] of real numbers"),
    (lambda: ep.actors.sphere(1.0, subdivisions=0), "subdivisions: must be a whole number from 1 to 500, got 0"),
    (lambda: ep.actors.sphere(1.0, edge=0.1, subdivisions=3), "must not be given together"),
    (lambda: ep.actors.capsule(0.5, 0.6), "length: must be at least twice the radius"),
    (lambda: ep.actors.capsule(0.05, 5000.0),
     "length: must be small enough beside the smallest radius, 0.05 m, for less than 20000000 triangles, got 5000"),
    (lambda: ep.actors.capsule(1e-9, 1.0, edge=0.01), "length: must be small enough beside the smallest radius, 1e-09 m"),
    (lambda: ep.actors.capsule(0.1, 100.0, edge=0.001), "edge: must be long enough for less than 20000000 triangles"),
    (lambda: ep.actors.ellipsoid((1e-4, 1.0, 1.0)), r"semi_axes: must be small enough beside .*0.0001 m.*, got \[0.0001, 1.0"),
    (lambda: ep.Part("hand", np.eye(3), "skin"), r"mesh: must be a Mesh, got an array \[3, 3\] of float64"),
    (lambda: ep.Part(5, ep.actors.plate(1, 1), "skin"), "name: must be text, got 5"),
    (lambda: ep.actors.ground(10.0, edge=1e-6), "edge: must be long enough"),
    (lambda: ep.actors.sphere(0.3, subdivisions=501), "subdivisions: must be a whole number from 1 to 500"),
    (lambda: ep.actors.trihedral(64.0, edge=0.02), "edge: must be long enough for less than 20000000 triangles"),
    (lambda: ep.actors.wall("5", 1.0), "length: must be a finite number from 1e-09 to 1000000000 m, got '5'"),
])
def test_bad_sizes_name_argument_rule_and_value(make, message):
    with pytest.raises((TypeError, ValueError), match=message):
        make()


def test_unknown_keyword_names_the_nearest_right_one():
    with pytest.raises(TypeError, match="unknown keyword 'egde', the nearest right one is 'edge'"):
        ep.actors.plate(1.0, 1.0, egde=0.1)


def test_actor_refuses_equal_and_empty_names():
    part = ep.actors.Part("a/b", ep.actors.plate(1.0, 1.0), "clothing")
    with pytest.raises(ValueError, match="^parts: must be of different names, got 'a/b'"):
        ep.actors.Actor([part, part])
    with pytest.raises(ValueError, match="^parts: must be of names without empty steps, got 'a//b'"):
        ep.actors.Actor([ep.actors.Part("a//b", part.mesh, "clothing")])
