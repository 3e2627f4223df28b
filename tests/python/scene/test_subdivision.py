"""Subdivision surfaces against the bicubic B-splines that they are, and bodies of full lattice cells."""
import numpy as np
import pytest

from echopath.actors.lattice import cage_of, refined, rounded_box
from echopath.actors.subdivision import Cage, on_limit, subdivided, triangulated
from support.closed import boundary_edges, volume_of

ROUNDING = 1e-12
SIZE = 7   # control points of a side


def parabola():
    """Control points (i, j, i^2 + i j) of a regular grid of quads."""
    i, j = np.meshgrid(np.arange(SIZE), np.arange(SIZE), indexing="ij")
    vertices = np.stack([i, j, i**2 + i * j], axis=-1).reshape(-1, 3).astype(float)
    index = np.arange(SIZE**2).reshape(SIZE, SIZE)
    quads = np.stack([index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]], axis=-1).reshape(-1, 4)
    return Cage(vertices, quads, ["all"] * len(quads), np.empty((0, 2), int))


@pytest.mark.parametrize("levels", [0, 1, 2])
def test_a_regular_cage_becomes_the_bicubic_b_spline(levels):
    """A uniform cubic B-spline with control values i^2 is x^2 + 1/3 (Marsden's identity), with i j it is x y."""
    cage = parabola()
    for _ in range(levels):
        cage = subdivided(cage)
    x, y, z = on_limit(cage).vertices.T
    inside = (x > 1.0) & (x < SIZE - 2.0) & (y > 1.0) & (y < SIZE - 2.0)
    assert inside.sum() >= 9 * 4**levels / 2
    np.testing.assert_allclose(z[inside], (x**2 + 1.0 / 3.0 + x * y)[inside], atol=1e-9)


@pytest.mark.parametrize("levels", [0, 2])
def test_borders_are_cubic_b_splines_of_the_border_alone(levels):
    cage = parabola()
    for _ in range(levels):
        cage = subdivided(cage)
    x, y, z = on_limit(cage).vertices.T
    border = (np.abs(y) < ROUNDING) & (x > 1.0) & (x < SIZE - 2.0)
    np.testing.assert_allclose(z[border], x[border] ** 2 + 1.0 / 3.0, atol=1e-9)


def box_cage(label):
    points = rounded_box((0, 0, 0), (2.0, 1.0, 1.0), 0.2, (3, 2, 2))
    return cage_of(points, np.ones(np.array(points.shape[:3]) - 1, bool), label)


def test_a_box_of_cells_is_closed_with_its_front_outside_and_rounded():
    cage = refined(box_cage(lambda face: ("skin", "body")), 2)
    triangles = triangulated(cage.quads, cage.vertices)
    assert boundary_edges(triangles) == []
    assert 0.9 * 2.0 < volume_of(cage.vertices, triangles) < 2.0
    np.testing.assert_allclose(np.ptp(cage.vertices, axis=0), (2.0, 1.0, 1.0), atol=1e-9)   # flat middles stay in place
    corner = np.linalg.norm(cage.vertices - [2.0, 1.0, 1.0], axis=1).min()
    assert 0.03 < corner < 0.2


def test_edges_between_sheets_stay_sharp():
    cage = refined(box_cage(lambda face: ("top", "lid") if (face.axis, face.side) == (2, 1) else ("skin", "body")), 2)
    rim = cage.vertices[np.abs(cage.vertices[:, 2] - 1.0) < 1e-9]
    assert np.ptp(rim[:, 0]) > 2.0 - 1e-9   # the lid's edge is not rounded away, its corners in the plane are


def test_an_empty_cell_is_a_notch():
    points = np.stack(np.meshgrid(*[np.arange(4.0)] * 3, indexing="ij"), axis=-1)
    full = np.ones((3, 3, 3), bool)
    full[1, 0, 0] = False
    cage = cage_of(points, full, lambda face: ("skin", "outer" if face.outer else "notch"))
    triangles = triangulated(cage.quads, cage.vertices)
    assert boundary_edges(triangles) == []
    assert volume_of(cage.vertices, triangles) == pytest.approx(26.0)
    assert [name for _, name in cage.labels].count("notch") == 4
