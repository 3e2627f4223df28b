"""Segments that lie on each other, against slow loops."""
from __future__ import annotations

import numpy as np
import pytest

from echopath_viewer.model.rays.distinct import first_of_each


def firsts(segments, place):
    """Indices of the segments whose pair of places was not there before."""
    seen = {}
    for index, (begin, end) in enumerate(segments):
        seen.setdefault(frozenset((place(begin), place(end))), index)
    return sorted(seen.values())


@pytest.fixture
def tangle():
    """600 segments between 40 points, some of which lie a little apart from each other."""
    rng = np.random.default_rng(4)
    points = rng.integers(-3, 4, (40, 3)) + rng.uniform(-0.1, 0.1, (40, 3))
    return points.astype(np.float32), rng.integers(0, 40, (600, 2))


def test_segments_between_the_same_points_are_one_in_either_direction(tangle):
    points, ends = tangle
    assert list(first_of_each(points, ends)) == firsts(points[ends], lambda point: tuple(point.tolist()))
    assert len(first_of_each(points, ends)) < 600


def test_segments_whose_ends_are_close_are_one(tangle):
    points, ends = tangle
    expected = firsts(points[ends], lambda point: tuple(round(value / 0.5) for value in point.tolist()))
    assert list(first_of_each(points, ends, 0.5)) == expected
    assert len(expected) < len(first_of_each(points, ends))


def test_segments_of_different_points_are_never_one():
    """Neighbours in the last digit, mirror images and permutations, which a poor sum of bits confuses."""
    one = np.float32(1.0)
    near = np.nextafter(one, np.float32(2.0))
    points = np.float32([[0, 0, 0], [one, 2, 3], [near, 2, 3], [one, 3, 2], [-one, 2, 3], [3, 2, one], [2, one, 3]])
    ends = [(first, second) for first in range(7) for second in range(first)]
    assert list(first_of_each(points, ends)) == list(range(21))


@pytest.mark.parametrize("cell", [0.0, 0.5])
def test_zeros_of_both_signs_are_one_point(cell):
    points = np.float32([[0, 1, 2], [3, 4, 5], [-0.0, 1, 2]])
    assert list(first_of_each(points, [(0, 1), (2, 1)], cell)) == [0]


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("cell", [0.0, 1e-9, 0.5])
def test_points_that_are_nowhere_are_told_from_others_without_a_warning(cell):
    points = np.float32([[0, 0, 0], [np.nan, 0, 0], [np.inf, 0, 0], [-np.inf, 0, 0], [3e38, 0, 0], [1, 0, 0]])
    kept = first_of_each(points, [(0, 1), (0, 3), (0, 5), (1, 0)], cell)
    assert list(kept) == [0, 1, 2]


def test_nothing_is_a_normal_case():
    assert len(first_of_each(np.zeros((0, 3)), np.zeros((0, 2), int), 0.1)) == 0


def test_segments_of_points_far_from_the_origin_are_one_only_where_these_are():
    """Single precision would take points for one that lie 0.1 m apart, 5000 km away."""
    points = np.array([[0.0, 0, 0], [5334760.0, 0, 0], [5334760.1, 0, 0], [5334760.0, 0, 0]])
    assert list(first_of_each(points, [(0, 1), (0, 2), (3, 0)])) == [0, 1]
