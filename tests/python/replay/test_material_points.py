"""What replay keeps exactly, and what one retained point costs: laws and numbers of material points."""
import numpy as np
import pytest

import echopath as ep
from support import shapes
from support.slides import ROUGH, TRANSMITTER, one_path

WAVENUMBER = 2 * np.pi * shapes.FREQUENCY / ep.speed_of_light   # rad/m
EXACT = 1e-9                # rad
NOTE_TOLERANCE = 0.02       # relative: the numbers of the note have two or three digits, its formulas are of second order
AMPLITUDE_TOLERANCE = 3e-3  # relative and rad: 2^14 rays on the sphere
TURNED_TOLERANCE = 1e-2     # likewise after 0.3 rad: part of the half that is lit then has no hits; seeds from .001 to .008
SAME_LENGTH = 1e-12  # m: rounding of lengths of some metres


def test_displaced_receiver_equals_a_fresh_trace_of_the_same_rays():
    """Single bounces: lengths to 1e-9 rad and amplitudes, for displacements far beyond any array."""
    scene = shapes.scene_of(ball=(shapes.sphere((6, 0, 0), 0.5, 4), ROUGH),
                            plate=(shapes.plate((9, 2, 0), (-1, -0.5, 0), 1.0), shapes.METAL))
    paths = ep.trace(scene, shapes.make_radar(TRANSMITTER), num_rays=4000, max_bounces=1)
    for receiver in ((0.0, 0.02, 0.0), (0.0, -0.3, 0.2), (-1.0, 0.5, 0.5)):
        radar = shapes.make_radar(TRANSMITTER, receiver)
        fresh = ep.trace(scene, radar, num_rays=4000, max_bounces=1)
        here, there = same_hits(paths, fresh)
        assert len(here) > 0.9 * fresh.num_paths > 1000
        lengths = paths.lengths([0.0], receiver=receiver)[0, here], fresh.lengths([0.0])[0, there]
        assert np.abs(WAVENUMBER * (lengths[0] - lengths[1])).max() < EXACT
        assert np.abs(lengths[1] - legs(fresh, receiver)[there]).max() < SAME_LENGTH


def same_hits(first, second):
    """Indices of the paths over the same hits."""
    rows = [np.asarray(paths.hits)[paths.offsets].tolist() for paths in (first, second)]
    where = {(tuple(row), int(bits)): k for k, (row, bits) in enumerate(zip(rows[0], first.diffuse))}
    keys = [(tuple(row), int(bits)) for row, bits in zip(rows[1], second.diffuse)]
    there = [k for k, key in enumerate(keys) if key in where]
    return [where[keys[k]] for k in there], there


def legs(paths, receiver):
    points = paths.points(0.0)[paths.offsets]
    return np.linalg.norm(points - TRANSMITTER, axis=1) + np.linalg.norm(points - np.asarray(receiver), axis=1)


def near_point(radius, distance, motion):
    """A record of the one point of a ball that is next to the radar; the centre is at `distance` and the motion about it."""
    scene = ep.Scene()
    scene.add(shapes.sphere((0, 0, 0), radius, 4), name="ball", material=ROUGH, position=(distance, 0, 0), motion=motion)
    return one_path(scene, shapes.make_radar(TRANSMITTER), [(distance - radius, 0.0, 0.0)])


def phase_of_retained_point(radius, distance, motion, centre):
    """By how much the retained point is farther than the one next to the radar by now, there and back; 1 s after time 0."""
    paths = near_point(radius, distance, motion)
    start, now = paths.lengths([0.0, 1.0])[:, 0]
    nearest = [2 * (np.linalg.norm(c) - radius) for c in ((distance, 0, 0), centre)]
    return WAVENUMBER * ((now - start) - (nearest[1] - nearest[0]))


@pytest.mark.parametrize("radius, expected", [(0.1, 0.016), (1.0, 0.179), (5.0, 1.61)])
def test_a_retained_point_of_a_ball_that_moves_aside(radius, expected):
    distance, shift = 10.0, 0.1
    motion = ep.LinearMotion(velocity=(0, shift, 0))
    error = phase_of_retained_point(radius, distance, motion, (distance, shift, 0))
    assert error == pytest.approx(WAVENUMBER * shift**2 * radius / (distance * (distance - radius)), rel=NOTE_TOLERANCE,
                                  abs=0)
    assert error == pytest.approx(expected, rel=NOTE_TOLERANCE, abs=0)


@pytest.mark.parametrize("radius, expected", [(0.1, 0.41), (1.0, 4.5)])
def test_a_retained_point_of_a_ball_that_turns(radius, expected):
    distance, angle = 10.0, 0.05
    motion = ep.LinearMotion(angular_velocity=(0, 0, angle))
    error = phase_of_retained_point(radius, distance, motion, (distance, 0, 0))
    assert error == pytest.approx(WAVENUMBER * radius * angle**2 * distance / (distance - radius), rel=NOTE_TOLERANCE, abs=0)
    assert error == pytest.approx(expected, rel=NOTE_TOLERANCE, abs=0)


def test_all_points_of_a_turning_ball_keep_its_echo():
    """Interference selects the new point of reflection. Frozen weights would lose 0.2, 0.3, 0.7 and 3.8 % of the amplitude;
    replayed ones lose nothing."""
    scene = ep.Scene()
    scene.add(shapes.sphere((0, 0, 0), 0.1, 6), name="ball", material=shapes.METAL, smooth=True, position=(20, 0, 0),
              motion=ep.LinearMotion(angular_velocity=(0, 0, 1.0)))
    paths = ep.trace(scene, shapes.make_radar(TRANSMITTER), num_rays=2**14, max_bounces=1)
    times = paths.frame.trace_time + np.array([0.0, 0.02, 0.05, 0.1, 0.3])  # 1 rad/s
    cycles = np.mod(paths.lengths(times) * (shapes.FREQUENCY / ep.speed_of_light), 1.0)
    echo = np.sum(paths.amplitudes(times) * np.exp(-2j * np.pi * cycles), axis=1)
    change = np.abs(echo / echo[0] - 1.0)
    assert change[:-1].max() < AMPLITUDE_TOLERANCE and change[-1] < TURNED_TOLERANCE
