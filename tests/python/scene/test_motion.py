"""Motions as Python sees them."""
import math

import numpy as np
import pytest
from scipy import interpolate

import echopath as ep

ROUNDING = 1e-12  # m: of a few operations on metres


def quaternion_about_z(angle):
    return np.array([math.cos(angle / 2), 0.0, 0.0, math.sin(angle / 2)])


def matrix_about_z(angle):
    cos, sin = math.cos(angle), math.sin(angle)
    return np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])


def test_linear_motion_moves_and_turns_right_handed():
    motion = ep.LinearMotion(velocity=(1, 2, 3), angular_velocity=(0, 0, math.pi / 4))
    pose = motion.at(2.0)
    np.testing.assert_allclose(pose[:3, 3], (2, 4, 6), atol=ROUNDING)
    np.testing.assert_allclose(pose[:3, :3], matrix_about_z(math.pi / 2), atol=ROUNDING)
    assert pose[3].tolist() == [0, 0, 0, 1]
    assert motion.span == (-math.inf, math.inf)
    assert len(motion.breakpoints) == 0


def test_keyframes_are_read_as_w_x_y_z():
    motion = ep.KeyframeMotion(times=[0, 1], rotations=[quaternion_about_z(0.0), quaternion_about_z(1.0)],
                               interpolation="linear")
    np.testing.assert_allclose(motion.at(0.25)[:3, :3], matrix_about_z(0.25), atol=ROUNDING)


def test_cubic_keyframes_reproduce_a_cubic():
    times = np.array([0.0, 0.1, 0.4, 0.5, 1.0])
    curve = np.polynomial.Polynomial([1.0, -2.0, 0.5, 3.0])
    motion = ep.KeyframeMotion(times=times, translations=np.outer(curve(times), [1.0, 2.0, -1.0]))
    for time in np.linspace(0, 1, 33):
        np.testing.assert_allclose(motion.at(time)[:3, 3], curve(time) * np.array([1.0, 2.0, -1.0]), atol=ROUNDING)


def test_keyframes_give_back_what_they_were_made_from():
    times, translations = [0.0, 0.5, 2.0], [[0, 0, 0], [1, 0, 0], [1, 2, 3]]
    rotations = [quaternion_about_z(angle) for angle in (0.1, 0.2, 0.7)]
    motion = ep.KeyframeMotion(times=times, translations=translations, rotations=rotations, interpolation="linear")
    assert motion.times.tolist() == times
    assert motion.translations.tolist() == translations
    assert np.array_equal(motion.rotations, rotations)
    assert motion.interpolation == "linear"
    assert motion.span == (0.0, 2.0)
    assert motion.breakpoints.tolist() == [0.5]
    again = ep.KeyframeMotion(times=motion.times, translations=motion.translations, rotations=motion.rotations)
    assert np.array_equal(again.rotations, motion.rotations)
    assert ep.KeyframeMotion(times=times, translations=translations).rotations.shape == (0, 4)


def test_cubic_is_the_default_and_has_no_breakpoints():
    motion = ep.KeyframeMotion(times=[0, 1, 2], translations=np.zeros((3, 3)))
    assert motion.interpolation == "cubic"
    assert len(motion.breakpoints) == 0


def test_monotone_keys_along_a_line_are_followed_as_by_scipy():
    """PCHIP (Fritsch and Butland 1984), from the first key to the last, for keys that lie unevenly and turn back and rest."""
    random = np.random.default_rng(3)
    way = np.array([2.0, -1.0, 2.0]) / 3.0
    for _ in range(50):
        times = np.cumsum(random.uniform(0.1, 2.0, 7))
        along = np.cumsum(random.choice([0.0, 1.0], 7) * random.normal(0.3, 1.0, 7))
        motion = ep.KeyframeMotion(times, np.outer(along, way), interpolation="monotone")
        at = np.linspace(times[0], times[-1], 101)
        found = np.array([motion.at(time)[:3, 3] for time in at])
        np.testing.assert_allclose(found, np.outer(interpolate.PchipInterpolator(times, along)(at), way), rtol=0, atol=ROUNDING)


def test_vertex_sequence_of_a_rotating_point_follows_the_circle():
    times = np.linspace(0, 1, 101)
    circle = np.stack([np.cos(3 * times), np.sin(3 * times), 0 * times], axis=-1)
    sequence = ep.VertexSequence(times=times, vertices=np.stack([circle, 2 * circle], axis=1))
    assert sequence.num_vertices == 2
    error = sequence.at(0.505) - np.outer([1, 2], [math.cos(1.515), math.sin(1.515), 0])
    assert np.abs(error).max() < 2 * 5 / 384 * (3 / 100) ** 4  # Hall and Meyer's bound for cubic splines, radius 2
    assert np.array_equal(sequence.vertices[:, 0], circle)


@pytest.mark.parametrize("call, words", [
    (lambda: ep.LinearMotion(velocity=(math.nan, 0, 0)), ["velocity", "finite"]),
    (lambda: ep.LinearMotion(velocity=(1, 2)), ["velocity", "[3]"]),
    (lambda: ep.KeyframeMotion(times=[0, 1]), ["translations"]),
    (lambda: ep.KeyframeMotion(times=[1, 0], translations=np.zeros((2, 3))), ["times", "ascending"]),
    (lambda: ep.KeyframeMotion(times=[0, 1], translations=np.zeros((3, 3))), ["translations", "got 3"]),
    (lambda: ep.KeyframeMotion(times=[0, 1], translations=np.zeros((2, 2))), ["translations", "[N, 3]"]),
    (lambda: ep.KeyframeMotion(times=[0, 1], rotations=[[1, 0, 0, 0], [1, 1, 0, 0]]), ["rotations", "1.41"]),
    (lambda: ep.KeyframeMotion(times=[0, 1], translations=np.zeros((2, 3)), interpolation="cubi"), ["interpolation"]),
    (lambda: ep.KeyframeMotion(times=[0, 1], translations=np.zeros((2, 3))).at(1.5), ["time", "1.5"]),
    (lambda: ep.VertexSequence(times=[0, 1], vertices=np.zeros((3, 4, 3))), ["vertices", "got 3"]),
    (lambda: ep.VertexSequence(times=[0, 1], vertices=np.zeros((2, 4))), ["vertices", "[T, V, 3]"]),
])
def test_bad_values_are_refused_by_name(call, words):
    with pytest.raises(ValueError) as caught:
        call()
    for word in words:
        assert word in str(caught.value)


@pytest.mark.parametrize("call, nearest", [
    (lambda: ep.LinearMotion(velocty=(1, 0, 0)), "'velocity'"),
    (lambda: ep.KeyframeMotion(times=[0, 1], translation=np.zeros((2, 3))), "'translations'"),
    (lambda: ep.VertexSequence(times=[0, 1], vertices=np.zeros((2, 1, 3)), interpol="linear"), "'interpolation'"),
])
def test_unknown_keywords_name_the_nearest_right_one(call, nearest):
    with pytest.raises(TypeError, match=nearest):
        call()


def test_reprs_are_short():
    assert repr(ep.LinearMotion((1, 0, 0))) == "LinearMotion(velocity=(1, 0, 0) m/s, angular_velocity=(0, 0, 0) rad/s)"
    motion = ep.KeyframeMotion(times=[0, 2], translations=np.zeros((2, 3)))
    assert repr(motion) == "KeyframeMotion(2 times, 0 to 2 s, cubic)"
    assert repr(ep.VertexSequence(times=[0, 2], vertices=np.zeros((2, 5, 3)))) == \
        "VertexSequence(5 vertices, 2 times, 0 to 2 s, cubic)"
