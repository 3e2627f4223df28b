"""Curves of one period that are smoothed by a Gaussian: each harmonic loses what its Fourier transform says."""
import numpy as np
import pytest
from scipy import interpolate

from echopath.actors.curves import NUM_HARMONICS, SMOOTHING, PeriodicCurve, monotone_cubic

ROUNDING = 1e-12  # of phases of 40 periods and 80 harmonics
PHASES = np.array([[-3.37, 0.0, 0.123], [0.5, 0.77, 41.9]])


@pytest.mark.parametrize("harmonic", [0, 1, 8, 9, 40, NUM_HARMONICS])
def test_a_harmonic_is_damped_by_the_transform_of_the_kernel(harmonic):
    curve = PeriodicCurve.from_function(lambda phase: np.cos(2.0 * np.pi * harmonic * phase + 0.3))
    left = np.exp(-2.0 * (np.pi * SMOOTHING * harmonic) ** 2)
    expected = left * np.cos(2.0 * np.pi * harmonic * PHASES + 0.3)
    np.testing.assert_allclose(curve(PHASES), expected, rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(curve(PHASES[1, 2]), expected[1, 2], rtol=0, atol=ROUNDING)


def test_monotone_cubics_are_those_of_scipy_between_inner_knots():
    """PCHIP (Fritsch and Butland 1984), for knots that lie unevenly; at both ends ours are level."""
    random = np.random.default_rng(3)
    knots, values = np.cumsum(random.uniform(0.2, 2.0, 12)), np.cumsum(random.normal(0.3, 1.0, 12))
    at = np.linspace(knots[1], knots[-2], 101)
    assert monotone_cubic(knots, values, at) == pytest.approx(interpolate.PchipInterpolator(knots, values)(at), abs=1e-12)
