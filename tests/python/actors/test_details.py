"""Details of trajectories: what follows one moves in itself for a while alone, and takes less time to be made."""
import functools
import math
import pickle

import numpy as np
import pytest

import echopath as ep
from echopath.actors.following import Repeated
from support.drives import WALK

DRIVE = ep.Trajectory([(0, 0), (25, 0), (25, 25)], turn_radius=8.0, speed=7.0, stops=[(0, 0.3), (10, 0.5), (math.inf, 0)])
TIMES = np.arange(0.0, 8.0, 0.5)
HEADED = ep.Trajectory(np.stack([5.0 * TIMES, 0.1 * TIMES**2], axis=-1), times=TIMES, yaw=0.05 * TIMES)  # as of a file
BEGIN, END = 2.1, 3.4   # s
INSIDE, BEFORE, AFTER = np.linspace(BEGIN, END, 27), np.linspace(0.6, BEGIN, 5), np.linspace(END, 6.0, 5)
SAME = 2e-5             # m: wheels follow to 3 micrometres, and keys lie elsewhere
LIMBS = 1e-3            # m: keys of limbs lie elsewhere
ACTORS = {"car": (ep.actors.car, DRIVE, SAME), "headed car": (ep.actors.car, HEADED, SAME),
          "truck": (ep.actors.truck, DRIVE, SAME), "bicycle": (ep.actors.bicycle, DRIVE, SAME),
          "cyclist": (ep.actors.cyclist, HEADED, LIMBS), "pedestrian": (ep.actors.pedestrian, WALK, LIMBS),
          "dog": (ep.actors.dog, WALK, LIMBS)}


def vertices(actor, motion, times):
    """[T, V, 3] m, in the axes of the trajectory, of all of an actor."""
    scene = ep.Scene()
    scene.add(actor, name="a")
    posed = np.array([np.concatenate([scene.world_vertices(mesh.id, float(time)) for mesh in scene.meshes]) for time in times])
    frames = np.array([motion.at(float(time)) for time in times])
    return np.einsum("tvi,tij->tvj", posed - frames[:, None, :3, 3], frames[:, :3, :3])


@pytest.mark.parametrize("name", ACTORS)
def test_what_follows_moves_in_itself_in_the_details_alone(name):
    make, way, tolerance = ACTORS[name]
    short = way.detailed(BEGIN, END)
    whole, detailed = make(trajectory=way), make(trajectory=short)
    assert detailed.motion == way and short.details == (BEGIN, END) and way.details == (way.begin, way.end)
    moves = np.ptp(vertices(whole, way, INSIDE), axis=0).max()
    assert moves > 0.05 and np.abs(vertices(whole, way, INSIDE) - vertices(detailed, way, INSIDE)).max() < tolerance
    for times in (BEFORE, AFTER):
        assert np.ptp(vertices(detailed, way, times), axis=0).max() < 1e-9 < np.ptp(vertices(whole, way, times), axis=0).max()


def test_details_are_kept_by_copies_and_shifted_along():
    short = DRIVE.detailed(BEGIN, END)
    assert pickle.loads(pickle.dumps(short)).details == short.replace(pitch=True).details == (BEGIN, END)
    assert short.shifted(2.0).details == pytest.approx((BEGIN + 2.0, END + 2.0))
    assert short == DRIVE and pickle.loads(pickle.dumps(short)) == DRIVE
    assert DRIVE.detailed(-5.0, 1.0).details == (0.0, 1.0) and DRIVE.detailed(90.0, 99.0).details == (DRIVE.end, DRIVE.end)


@functools.cache
def whole_drive(actor):
    return actor(trajectory=DRIVE)


@pytest.mark.parametrize("details", [(-9.0, -8.0), (90.0, 99.0), (DRIVE.end, DRIVE.end + 1.0), (3.0, 3.0)])
@pytest.mark.parametrize("actor", [ep.actors.car, ep.actors.truck, ep.actors.cyclist])
def test_details_beside_the_way_are_none(actor, details):
    """Held as at the nearer end: a vehicle that has come to its place before or behind."""
    made = actor(trajectory=DRIVE.detailed(*details))
    at = min(max(details[0], DRIVE.begin), DRIVE.end)
    expected = vertices(whole_drive(actor), DRIVE, [at])
    assert np.abs(vertices(made, DRIVE, [0.5, at, 5.0]) - expected).max() < 0.01


def test_wheels_of_one_side_ask_for_times_that_the_other_did_not():
    """Of the cubics of the one none is left to be checked again, of the other some are."""
    repeated = Repeated(lambda times: np.stack([times, times**2]))
    assert repeated.anew()(np.zeros(0)).shape == (2, 0)
    np.testing.assert_array_equal(repeated.anew()(np.array([3.0, 1.0])), [[3.0, 1.0], [9.0, 1.0]])


@pytest.mark.parametrize("arguments, words", [
    ((3.0, 2.0), "end: must be a finite number from 3 to"), ((math.nan, 2.0), "begin: must be"), (("a", 2.0), "begin: must be")])
def test_wrong_details_are_named(arguments, words):
    with pytest.raises((TypeError, ValueError), match=f"^{words}"):
        DRIVE.detailed(*arguments)
