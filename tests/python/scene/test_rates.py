"""Rates of what moves, by differences, against derivatives that are known."""
import numpy as np
import pytest

from echopath.base.numerics.rates import STEP, rate_of, step_within

RADIUS = 0.3  # m


@pytest.mark.parametrize("turns, error", [(50.0, 1e-5), (300.0, 0.01)])
def test_the_rate_of_what_turns_is_that_of_a_circle(turns, error):
    """A wheel at some 340 km/h to 0.01 mm/s, and a rotor that bends within a step without a jump."""
    def place(time):
        return RADIUS * np.array([np.cos(2 * np.pi * turns * time), np.sin(2 * np.pi * turns * time)])

    for time in (0.0, 0.0031, 0.7):
        expected = 2 * np.pi * turns * np.array([-1.0, 1.0]) * place(time)[::-1]
        assert np.abs(rate_of(place, time, STEP) - expected).max() < error


@pytest.mark.parametrize("after", [-1.9, -1.4, -0.6, -0.1, 0.1, 0.6, 1.4, 1.9])
def test_beside_a_jump_the_rate_is_that_of_its_own_side(after):
    """Of what goes at 3 m/s and begins anew at 2 s, at 5 m/s; times are so many steps behind that."""
    def place(time):
        return np.array([3.0 * time if time < 2.0 else 5.0 * (time - 2.0), 1.0])

    assert rate_of(place, 2.0 + after * STEP, STEP) == pytest.approx([3.0 if after < 0 else 5.0, 0.0], abs=1e-6)


def test_steps_stay_within_the_frame():
    assert step_within(1.0) == STEP and step_within(0.0) == STEP and step_within(4e-5) == pytest.approx(1e-5)
