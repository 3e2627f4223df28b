"""A child's head beside measurements: medians of Snyder and others (UM-HSRI-77-17, 1977), mean of boys and girls, at the heights
that the British reference of 1990 gives for their ages; and the Hybrid III dummy of a child of six years (NHTSA)."""
import numpy as np
import pytest

import echopath as ep

MEASURED = [(0.911, 0.1765, 0.1335), (1.056, 0.180, 0.137), (1.186, 0.182, 0.1395), (1.303, 0.1855, 0.142),
            (1.411, 0.1855, 0.144)]  # m: body height, length and breadth of the head at 2-3, 4-5, 6-7, 8-9 and 10-11 years
DUMMY = (45.0, 6.8, 5.6)             # inches, the same
INCH = 0.0254


def vertices(actor):
    return {part.name: np.asarray(part.mesh.vertices) for part in actor.parts}


def head_of(height):
    """(length, breadth) of the head in m."""
    return np.ptp(vertices(ep.actors.child(height=height, speed=0.0, edge=0.008))["head"], axis=0)[:2]


@pytest.mark.parametrize("height, length, breadth", MEASURED)
def test_a_head_is_as_long_and_broad_as_measured(height, length, breadth):
    assert head_of(height) == pytest.approx((length, breadth), abs=0.003)


def test_a_head_is_near_that_of_the_dummy_of_a_child():
    height, length, breadth = (INCH * inches for inches in DUMMY)
    assert head_of(height) == pytest.approx((length, breadth), abs=0.01)


@pytest.mark.parametrize("height", [0.8, 1.15, 1.5])
def test_a_child_is_as_tall_as_asked_and_has_the_shorter_legs(height):
    parts = vertices(ep.actors.child(height=height, speed=0.0))
    every = np.concatenate(list(parts.values()))
    assert np.ptp(every[:, 2]) == pytest.approx(height, rel=0.003)
    grown = vertices(ep.actors.standing_person(height=height))
    assert parts["leg_left/thigh"][:, 2].max() < grown["leg_left/thigh"][:, 2].max()
    assert np.ptp(parts["head"][:, 1]) > np.ptp(grown["head"][:, 1])
    assert parts["head"][:, 2].min() < parts["neck"][:, 2].max()


@pytest.mark.parametrize("name, value", [("speed", 1.0), ("start_time", 0.0), ("duration", 9.0), ("phase", 0.3)])
def test_what_a_trajectory_says_is_said_once(name, value):
    with pytest.raises(ValueError, match=f"^{name}: must be left out beside trajectory, got {value}"):
        ep.actors.child(trajectory=ep.Trajectory([[0, 0], [5, 0]], speed=1.0), **{name: value})
