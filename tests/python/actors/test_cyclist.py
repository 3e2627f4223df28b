"""The cyclist: feet on the pedals, segments of constant length, wheels and crank that fit the speed."""
import numpy as np
import pytest

import echopath as ep
from echopath.actors.human.anthropometry import Proportions
from echopath.actors.vehicles.bicycle import Ride
from echopath.actors.vehicles.cyclist import rider_frames
from support.closed import scene_of

SPEED = 5.0
TOUCH = 0.012       # m: shoes are round, and the ball of the foot lies a little inside their soles
TIMES = np.linspace(0.0, 0.84, 13)    # s: one turn of the crank of 4.2 m


@pytest.fixture(scope="module")
def scene():
    return scene_of(ep.actors.cyclist(speed=SPEED, edge=0.04))


def vertices(scene, name, time):
    (mesh,) = [mesh.id for mesh in scene.meshes if mesh.name == f"a/{name}"]
    return scene.world_vertices(mesh, float(time))


@pytest.mark.parametrize("side", ["left", "right"])
def test_feet_stay_on_their_pedals(scene, side):
    for time in TIMES:
        foot, pedal = vertices(scene, f"rider/leg_{side}/foot", time), vertices(scene, f"bicycle/pedal_{side}", time)
        top = pedal.max(axis=0)
        over = np.abs(foot[:, 0] - pedal[:, 0].mean()) < 0.03
        assert abs(foot[over, 2].min() - top[2]) < TOUCH


def test_pedals_are_at_the_ends_of_the_crank_all_the_time(scene):
    for time in TIMES:
        bracket = np.array([SPEED * time, 0.0, 0.285])
        for side in ("left", "right"):
            middle = vertices(scene, f"bicycle/pedal_{side}", time).mean(axis=0)
            assert np.linalg.norm((middle - bracket)[[0, 2]]) == pytest.approx(0.170, abs=1e-4)
            crank = vertices(scene, "bicycle/crank", time)
            assert np.linalg.norm(crank - middle, axis=1).min() < 0.05


def test_a_turn_of_the_crank_goes_as_far_as_said(scene):
    lifted = [vertices(scene, "bicycle/pedal_left", time)[:, 2].mean() for time in (0.0, 0.42, 0.84)]
    assert lifted[0] == pytest.approx(lifted[2], abs=1e-4) == pytest.approx(lifted[1], abs=1e-4)  # level, back, level
    ahead = [vertices(scene, "bicycle/pedal_left", time)[:, 0].mean() - SPEED * time for time in (0.0, 0.42)]
    assert ahead[0] == pytest.approx(0.17, abs=1e-4) and ahead[1] == pytest.approx(-0.17, abs=1e-4)


@pytest.mark.parametrize("height", [1.5, 1.78, 1.98])
def test_legs_keep_their_lengths_and_never_straighten(height):
    body = Proportions(height)
    ride = Ride(SPEED, 2 * np.pi * SPEED / 4.2, 0.3)
    frames = rider_frames(body, ride, np.linspace(0.0, 1.0, 101))
    for side in ("left", "right"):
        hip, knee, ankle = (frames[f"leg_{side}/{name}"].origin for name in ("thigh", "shank", "foot"))
        np.testing.assert_allclose(np.linalg.norm(hip - knee, axis=1), body.thigh, rtol=1e-9)
        np.testing.assert_allclose(np.linalg.norm(knee - ankle, axis=1), body.shank, rtol=1e-9)
        assert np.linalg.norm(hip - ankle, axis=1).max() < 0.99 * (body.thigh + body.shank)
        bend = np.degrees(np.arccos(np.sum((hip - knee) * (knee - ankle), 1) / body.thigh / body.shank))
        assert 100.0 < bend.max() < 125.0    # at the top of the stroke; measured ones bend by about 110 deg


def test_hands_hold_the_bar_while_it_goes(scene):
    for time in (0.0, 0.7):
        hand, bar = vertices(scene, "rider/arm_left/hand", time), vertices(scene, "bicycle/handlebar", time)
        assert np.linalg.norm(hand[:, None] - bar[None], axis=-1).min() < 0.04   # of coarse meshes
