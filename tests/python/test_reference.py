"""The whole chain, from the scene to the IF samples, against a slow implementation of the equations in NumPy."""
import numpy as np
import pytest

import echopath as ep
from support.reference import Reference, blocked
from support.reference_scenes import array_deviation, coherent_deviation, diffuse_deviation, polarized_deviation
from support.shapes import METAL, WAVELENGTH, fields, make_radar, rectangle, scene_of

pytestmark = pytest.mark.hard

FIELD_SHARE = 0.01    # 2^16 rays, edges of shadows, and plates that partly cancel; most scenes are within 0.001
SIGNAL_SHARE = 0.01   # likewise over three chirps: edges of shadows fall between cells of 1 mm, 1 % of a plate of 0.1 m
STANDARD_ERRORS = 4.0
CORNER_DB = 0.05      # 2^16 rays on two plates of 0.1 m


@pytest.mark.parametrize("seed", range(20, 26))
def test_smooth_plates_have_the_field_and_the_samples_of_the_reference(seed):
    found = coherent_deviation(seed)
    assert found.field < FIELD_SHARE and found.cube < SIGNAL_SHARE


@pytest.mark.parametrize("seed", range(30, 33))
def test_field_vectors_are_those_of_the_reference(seed):
    found = polarized_deviation(seed)
    assert found.field < FIELD_SHARE and found.cube < SIGNAL_SHARE


def test_all_channels_of_a_moving_radar_have_the_samples_of_the_reference():
    assert array_deviation(40).cube < SIGNAL_SHARE


@pytest.mark.parametrize("seed", range(20, 26))
def test_rough_plates_have_the_mean_power_of_the_reference(seed):
    assert diffuse_deviation(seed).power < STANDARD_ERRORS


@pytest.mark.parametrize("floor", [METAL, ep.Material(permittivity=4 - 0.2j)])
@pytest.mark.parametrize("polarization", [(0.0, 0.0, 1.0), (0.0, 1.0, 0.0)])
def test_a_corner_has_both_orders_of_the_reference(floor, polarization):
    angle, side = np.radians(40.0), 0.1
    corner, across = np.array([30.0, -0.05, 0.0]), np.array([0.0, side, 0.0])
    along, up = side * np.array([-np.cos(angle), 0, -np.sin(angle)]), side * np.array([-np.sin(angle), 0, np.cos(angle)])
    scene = scene_of(floor=(rectangle(corner, along, across), floor), wall=(rectangle(corner, up, across), METAL))
    radar = make_radar((0, 0, 0), polarization=polarization)
    paths = ep.trace(scene, radar, num_rays=2 ** 16, max_bounces=2)
    double = np.asarray(paths.num_bounces) == 2
    reference = Reference(scene, radar, spacing=1e-3, trace_time=paths.frame.trace_time, corners=True)
    expected = sum(np.sum(field * np.exp(-2j * np.pi * np.mod(length / WAVELENGTH, 1.0)))
                   for length, field, _ in reference.pairs(0.0)[1][1:])  # the first pair is the direct one
    assert 20 * np.log10(abs(np.sum(fields(paths)[double]) / expected)) == pytest.approx(0.0, abs=CORNER_DB)
    assert abs(np.angle(np.sum(fields(paths)[double]) / expected)) < 0.01


def test_the_reference_sees_shadows():
    screen = np.array([[[1.0, -1, -1], [1, 1, -1], [1, 0, 1]]])
    ends = np.array([[2.0, 0, 0], [2, 3, 0], [0.5, 0, 0], [2, 0, 0]])
    own = np.array([-1, -1, -1, 0])
    assert list(blocked(np.zeros((4, 3)), ends, screen, own)) == [True, False, False, False]
