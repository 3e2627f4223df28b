"""The whole chain, from the scene to the IF samples, against a slow implementation of the equations in NumPy."""
import numpy as np
import pytest

import echopath as ep
from support.references.reference import Reference
from support.references.reference_cells import blocked
from support.references.reference_scenes import (
    array_deviation,
    coherent_deviation,
    curved_deviation,
    curved_diffuse_deviation,
    diffuse_deviation,
    polarized_deviation,
    two_mirror_deviation,
    two_mirror_diffuse_deviation,
)
from support.shapes import METAL, WAVELENGTH, fields, make_radar, rectangle, scene_of, sphere

pytestmark = pytest.mark.hard

# 2^16 rays, shared out by what each plate misses; edges of shadows, and plates that partly cancel; most are within 0.001
FIELD_SHARE = 0.015
SIGNAL_SHARE = 0.01   # likewise over two chirps: edges of shadows fall between cells of 1 mm, 1 % of a plate of 0.1 m
RETURN_SHARE = 3e-3   # 2500 rays that reach a plate of 20 mm over two planes: most scenes are within 0.001
STANDARD_ERRORS = 4.0
CORNER_DB = 0.05      # 2^16 rays on two plates of 0.1 m
SPHERE_SHARE = 1e-3   # of its radius and area: edges of 0.3 radii, whose curved triangles are right to the fourth power
CORNER_PHASE = 1e-3        # rad: what cells of 1 mm leave; 2e-4 found
NORMAL_ERROR = 2e-3        # of a unit vector: interpolated normals of facets of 0.1 rad; 9e-4 found


@pytest.mark.parametrize("seed", range(20, 24))
def test_smooth_plates_have_the_field_and_the_samples_of_the_reference(seed):
    found = coherent_deviation(seed)
    assert found.field < FIELD_SHARE and found.cube < SIGNAL_SHARE


@pytest.mark.parametrize("seed", range(30, 33))
def test_field_vectors_are_those_of_the_reference(seed):
    found = polarized_deviation(seed)
    assert found.field < FIELD_SHARE and found.cube < SIGNAL_SHARE


def test_all_channels_of_a_moving_radar_have_the_samples_of_the_reference():
    assert array_deviation(40).cube < SIGNAL_SHARE


@pytest.mark.parametrize("seed", [11, 12, 14])
def test_bent_panels_have_the_field_and_the_samples_of_the_reference(seed):
    found = curved_deviation(seed)
    assert found.field < FIELD_SHARE and found.cube < SIGNAL_SHARE


@pytest.mark.parametrize("seed", [2, 15])
def test_returns_over_two_mirrors_have_the_field_and_the_samples_of_the_reference(seed):
    found = two_mirror_deviation(seed)
    assert found.field < RETURN_SHARE and found.cube < RETURN_SHARE


@pytest.mark.parametrize("seed", [94, 95])
def test_rough_panels_have_the_mean_power_of_the_reference(seed):
    assert curved_diffuse_deviation(seed).power < STANDARD_ERRORS


@pytest.mark.parametrize("seed", [80, 94])
def test_rough_plates_between_two_mirrors_have_the_mean_power_of_the_reference(seed):
    assert two_mirror_diffuse_deviation(seed).power < STANDARD_ERRORS


@pytest.mark.parametrize("seed", range(20, 24))
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
    paths = ep.trace(scene, radar, num_rays=2 ** 16, max_bounces=2, polarization="scalar")
    double = np.asarray(paths.num_bounces) == 2
    reference = Reference(scene, radar, spacing=1e-3, trace_time=paths.frame.trace_time, corners=True)
    expected = sum(np.sum(field * np.exp(-2j * np.pi * np.mod(length / WAVELENGTH, 1.0)))
                   for length, field, _ in reference.pairs(0.0)[1][1:])  # the first pair is the direct one
    assert 20 * np.log10(abs(np.sum(fields(paths)[double]) / expected)) == pytest.approx(0.0, abs=CORNER_DB)
    assert abs(np.angle(np.sum(fields(paths)[double]) / expected)) < CORNER_PHASE


def test_the_reference_sees_shadows():
    screen = np.array([[[1.0, -1, -1], [1, 1, -1], [1, 0, 1]]])
    ends = np.array([[2.0, 0, 0], [2, 3, 0], [0.5, 0, 0], [2, 0, 0]])
    own = np.array([-1, -1, -1, 0])
    assert list(blocked(np.zeros((4, 3)), ends, screen, own)) == [True, False, False, False]


def test_cells_of_the_reference_lie_on_the_sphere_that_a_smooth_mesh_stands_for():
    centre, radius = np.array([5.0, 1.0, -2.0]), 0.4
    reference = Reference(scene_of(ball=(sphere(centre, radius, 2), METAL, True)), make_radar((0, 0, 0)), spacing=0.01,
                          trace_time=0.0)
    cells = reference.cells(0.0)
    assert np.linalg.norm(cells.points - centre, axis=1) == pytest.approx(radius, rel=SPHERE_SHARE)
    assert cells.areas.sum() == pytest.approx(4 * np.pi * radius**2, rel=SPHERE_SHARE)
    assert np.linalg.norm(cells.normals - (cells.points - centre) / radius, axis=1).max() < NORMAL_ERROR
