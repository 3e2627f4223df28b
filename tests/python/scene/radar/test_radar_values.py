"""Radars and antennas are values: they travel, compare and are replaced in part."""
import copy
import pickle

import numpy as np
import pytest

import echopath as ep

UNIT = 1e-15  # of unit vectors and of one turn and back


def waveform(**changes):
    return ep.ChirpSequence(**{"num_samples": 256, "num_chirps": 32, **changes})


def placed_radar():
    """No argument as it is by default."""
    patterns = ep.CosinePower(2.5, peak_gain=5.0), ep.Isotropic(0.6)
    antennas = [ep.Antenna((0.1, 0.2, 0.3), yaw=0.1 + i, pitch=0.2, pattern=pattern, polarization=(0, 0.6, 0.8))
                for i, pattern in enumerate(patterns)]
    return ep.Radar(waveform(real=True), transmitters=antennas[:1], receivers=antennas, position=(1, 2, 3), yaw=0.7,
                    pitch=-0.1, motion=ep.LinearMotion(velocity=(1, 2, 3), angular_velocity=(0, 0, 0.1)),
                    transmit_power=0.5, noise_figure_db=9.0)


@pytest.mark.parametrize("travel", [copy.copy, copy.deepcopy, lambda value: pickle.loads(pickle.dumps(value))])
def test_radars_and_antennas_travel_by_value(travel):
    radar = placed_radar()
    for value in (radar, *radar.receivers):
        other = travel(value)
        assert other is not value and other == value and not other != value
        assert repr(other) == repr(value)
    np.testing.assert_array_equal(travel(radar).world_from_radar(0.3), radar.world_from_radar(0.3))


CHANGES = {"position": (1, 2, 3.5), "yaw": 0.8, "pitch": 0.1, "motion": None, "transmit_power": 0.4, "noise_figure_db": 8.0,
           "waveform": waveform(num_chirps=3), "transmitters": [ep.Antenna()], "receivers": [ep.Antenna()]}
ANTENNA_CHANGES = {"position": (1, 2, 3.5), "orientation": (0, 0, 0, 1), "yaw": 1.0, "pitch": 0.0,
                   "pattern": ep.CosinePower(3.0), "polarization": (0, 1, 0)}


@pytest.mark.parametrize("name", CHANGES)
def test_replace_changes_what_it_names_and_nothing_else(name):
    radar = placed_radar()
    changed = radar.replace(**{name: CHANGES[name]})
    assert changed != radar and radar == placed_radar()
    np.testing.assert_equal(getattr(changed, name), CHANGES[name])
    assert changed.replace(**{name: getattr(radar, name)}) == radar


@pytest.mark.parametrize("name", ANTENNA_CHANGES)
def test_replace_changes_one_argument_of_an_antenna(name):
    antenna = placed_radar().receivers[0]
    changed = antenna.replace(**{name: ANTENNA_CHANGES[name]})
    assert changed != antenna
    value, expected = getattr(changed, name), ANTENNA_CHANGES[name]
    assert value == expected if name == "pattern" else np.allclose(value, expected, rtol=0, atol=UNIT)
    for other in {"position", "pattern", "polarization"} - {name}:
        np.testing.assert_equal(getattr(changed, other), getattr(antenna, other))
    if name in ("yaw", "pitch"):
        kept = "pitch" if name == "yaw" else "yaw"
        assert getattr(changed, kept) == pytest.approx(getattr(antenna, kept), abs=UNIT)


def test_a_turn_straight_up_keeps_its_yaw():
    upward = ep.Antenna(yaw=0.5, pitch=np.pi / 2)
    assert upward.replace(pitch=0.1).yaw == pytest.approx(0.5, abs=UNIT)


def test_yaw_and_pitch_replace_no_roll():
    rolled = ep.Antenna(orientation=(np.cos(0.2), np.sin(0.2), 0, 0))
    with pytest.raises(ValueError, match="^yaw: must be replaced by an orientation .* got 0.39"):
        rolled.replace(yaw=0.1)


def test_replace_takes_a_speed_for_a_motion():
    changed = placed_radar().replace(speed=2.0)
    np.testing.assert_allclose(changed.motion.velocity, (2 * np.cos(0.7), 2 * np.sin(0.7), 0), atol=UNIT)
    with pytest.raises(TypeError, match="'position'"):
        placed_radar().replace(positon=(1, 2, 3))


def test_values_of_another_kind_are_not_equal():
    assert ep.Antenna() != 3 and placed_radar() != ep.Antenna() and ep.Antenna() != ep.Antenna(yaw=0.1)
    assert hash(placed_radar()) == hash(placed_radar()) and hash(ep.Antenna()) == hash(ep.Antenna((-0.0, 0, 0)))


def test_a_damaged_pickle_is_refused_as_a_wrong_argument_is():
    constructor, arguments, state = placed_radar().__reduce_ex__(2)[:3]
    made = constructor(*arguments)
    with pytest.raises(ValueError, match="^pitch: "):
        made.__setstate__({**state, "pitch": 7.0})
    with pytest.raises(TypeError, match="waveform"):
        made.__setstate__({})
    with pytest.raises(TypeError, match="^state: "):
        made.__setstate__(3)


def cube_of(scene, radar):
    return ep.synthesize(ep.trace(scene, radar, num_rays=200), radar)


def test_a_radar_that_travelled_sees_the_same_bits():
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.5), name="ball", material="metal", position=(9.0, 7.0, 3.0), smooth=True)
    here = cube_of(scene, placed_radar())
    other = pickle.loads(pickle.dumps(placed_radar()))
    np.testing.assert_array_equal(cube_of(scene, other), here)
    assert np.abs(here).max() > 0
