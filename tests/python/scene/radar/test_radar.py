"""Waveforms, antennas and radars: their axes, what they refuse by name, and how they print."""
import numpy as np
import pytest

import echopath as ep
from echopath.base.radar.antennas import mixes_polarisations
from echopath.base.radar.velocities import ambiguity_of, folded

C = 299792458.0
LAST_DIGIT = 1e-3        # of published figures with five digits
ROUNDING = 1e-12         # relative
UNIT = 1e-15             # of unit vectors and of one quotient


def reference(**changes):
    fields = dict(start_frequency=77e9, bandwidth=1e9, num_samples=512, sampling_rate=20e6, num_chirps=128,
                  chirp_interval=30e-6)
    return ep.ChirpSequence(**{**fields, **changes})


def test_waveform_axes_are_those_of_the_reference_radar():
    waveform = reference()
    assert waveform.range_resolution == pytest.approx(0.14990, abs=0.01 * LAST_DIGIT)
    assert waveform.max_range == pytest.approx(76.747, abs=LAST_DIGIT)
    assert waveform.velocity_resolution() == pytest.approx(0.5037, abs=0.1 * LAST_DIGIT)
    assert waveform.max_velocity() == pytest.approx(32.236, abs=LAST_DIGIT)
    assert waveform.max_velocity(num_slots=2) == pytest.approx(32.236 / 2, abs=LAST_DIGIT)
    assert waveform.wavelength == pytest.approx(C / 77.5e9, rel=UNIT, abs=0)
    assert waveform.slope == pytest.approx(1e9 / 25.6e-6)
    assert reference(real=True).max_range == pytest.approx(76.747 / 2, abs=LAST_DIGIT)


def test_fields_read_back_as_given():
    motion = ep.LinearMotion(velocity=(1, 0, 0))
    antenna = ep.Antenna((0, 0.01, 1), orientation=(0.6, 0, 0, 0.8), pattern=ep.CosinePower(2.0, peak_gain=5.0),
                         polarization=(0, 1, 0))
    radar = ep.Radar(reference(real=True), transmitters=[antenna], receivers=[ep.Antenna((1, 2, 3)), antenna],
                     transmit_power=0.5, noise_figure_db=9.0, motion=motion)
    assert radar.waveform.real and radar.waveform.num_samples == 512
    assert (radar.transmit_power, radar.noise_figure_db, radar.multiplexing) == (0.5, 9.0, "tdm")
    assert radar.motion is motion
    assert len(radar.receivers) == 2
    back = radar.transmitters[0]
    np.testing.assert_array_equal(back.position, (0, 0.01, 1))
    np.testing.assert_array_equal(back.orientation, (0.6, 0, 0, 0.8))
    np.testing.assert_array_equal(back.polarization, (0, 1, 0))
    assert (back.pattern.kind, back.pattern.exponent, back.pattern.peak_gain) == ("cosine_power", 2.0, 5.0)
    assert ep.CosinePower(2.0).peak_gain == 6.0
    assert (ep.Antenna().pattern.kind, ep.Isotropic(0.3).peak_gain) == ("isotropic", 0.3)


def test_unit_vectors_are_made_unit_once():
    antenna = ep.Antenna(polarization=(0, 0.6, 0.8 + 1e-8), orientation=(1 + 1e-8, 0, 0, 0))
    assert np.linalg.norm(antenna.polarization) == pytest.approx(1, abs=UNIT)
    again = ep.Antenna(polarization=antenna.polarization, orientation=antenna.orientation)
    np.testing.assert_array_equal(again.polarization, antenna.polarization)
    np.testing.assert_array_equal(again.orientation, antenna.orientation)


def test_chirp_times_of_slots():
    radar = ep.Radar(reference(), transmitters=[ep.Antenna()] * 2, receivers=[ep.Antenna()])
    assert radar.chirp_time(tx=1, chirp=3) == pytest.approx(7 * 30e-6 + 511 / 40e6, rel=ROUNDING, abs=0)
    with pytest.raises(IndexError, match="chirp"):
        radar.chirp_time(0, 128)


@pytest.mark.parametrize("field, value", [("start_frequency", 0), ("bandwidth", 0), ("num_samples", 0),
                                          ("sampling_rate", np.inf), ("num_chirps", 0), ("chirp_interval", 20e-6)])
def test_bad_waveform_names_the_field(field, value):
    with pytest.raises(ValueError, match=f"^{field}: .*got"):
        reference(**{field: value})


def test_bad_radar_names_the_field():
    one = [ep.Antenna()]
    with pytest.raises(ValueError, match="^transmitters: "):
        ep.Radar(reference(), transmitters=[], receivers=one)
    with pytest.raises(ValueError, match="^transmit_power: "):
        ep.Radar(reference(), transmitters=one, receivers=one, transmit_power=-1)
    with pytest.raises(ValueError, match="^multiplexing: "):
        ep.Radar(reference(), transmitters=one, receivers=one, multiplexing="fdm")
    with pytest.raises(ValueError, match="^polarization: "):
        ep.Antenna(polarization=(0, 0, 1.1))
    with pytest.raises(ValueError, match="^orientation: "):
        ep.Antenna(orientation=(1, 1, 0, 0))
    with pytest.raises(ValueError, match="^peak_gain: "):
        ep.CosinePower(1.0, peak_gain=0.0)
    with pytest.raises(TypeError, match="'num_chirps'"):
        ep.ChirpSequence(num_chirp=3)
    with pytest.raises(TypeError, match="'receivers'"):
        ep.Radar(reference(), transmitters=one, receivers=one, recievers=one)


WRONG = ["abc", b"abc", object(), {}, set(), [[]], (1, 2), np.zeros((2, 2)), np.nan, np.inf, -np.inf, 1j, "\ud800", 1e400,
         [np.nan] * 3, ("a", "b", "c"), np.array("x"), int, lambda: 0, ep.Isotropic()]
NUMBERS_FIT = ("yaw", "pitch", "transmit_power", "noise_figure_db", "speed")


@pytest.mark.parametrize("name", ["waveform", "transmitters", "receivers", "position", "motion", "multiplexing", *NUMBERS_FIT])
@pytest.mark.parametrize("value", WRONG, ids=lambda value: type(value).__name__)
def test_a_wrong_argument_of_a_radar_is_named(name, value):
    arguments = {"waveform": reference(), "transmitters": [ep.Antenna()], "receivers": [ep.Antenna()], name: value}
    with pytest.raises((ValueError, TypeError), match=rf"^{name}(\[\d+\])?: .*got"):
        ep.Radar(arguments.pop("waveform"), **arguments)


@pytest.mark.parametrize("name", ["position", "yaw", "pitch", "orientation", "pattern", "polarization"])
@pytest.mark.parametrize("value", [value for value in WRONG if not isinstance(value, ep.AntennaPattern)],
                         ids=lambda value: type(value).__name__)
def test_a_wrong_argument_of_an_antenna_is_named(name, value):
    with pytest.raises((ValueError, TypeError), match=rf"^{name}: .*got"):
        ep.Antenna(**{name: value})


@pytest.mark.parametrize("name, value", [("yaw", 0.1), ("pitch", 0.1)])
def test_a_direction_is_given_once(name, value):
    with pytest.raises(ValueError, match=f"^{name}: must not be given together with orientation, got 0.1"):
        ep.Antenna(orientation=(1, 0, 0, 0), **{name: value})
    with pytest.raises(ValueError, match="^pitch: must be from -pi/2 to pi/2 rad, got 10"):
        ep.Antenna(pitch=10.0)


@pytest.mark.parametrize("far", [1e13, 1e20, 1e300])
def test_what_is_out_of_range_is_named(far):
    with pytest.raises(ValueError, match=r"^position: .*1e\+?12 m"):
        ep.Radar(reference(), transmitters=[ep.Antenna()], receivers=[ep.Antenna()], position=(0, far, 0))
    with pytest.raises(ValueError, match=r"^position: .*1e\+?12 m"):
        ep.Antenna((0, 0, -far))


def test_a_radar_that_drives_out_of_range_is_refused():
    radar = ep.Radar(reference(), transmitters=[ep.Antenna()], receivers=[ep.Antenna()], speed=2.9e8,
                     position=(1e12 - 1e5, 0, 0))
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.5), name="ball", material="metal", position=(9, 0, 0), smooth=True)
    with pytest.raises(ValueError, match=r"^radar: antennas must lie within 1e12 m"):
        ep.trace(scene, radar, num_rays=100)


def test_representations_tell_what_they_are():
    placed = ep.Radar(reference(), transmitters=[ep.Antenna()], receivers=[ep.Antenna()], position=(1, 2, 3), yaw=0.7,
                      pitch=-0.1, speed=3)
    turned = ep.Antenna((0.1, 0.2, 0.3), yaw=0.1, pitch=0.2)
    radar = ep.Radar(reference(), transmitters=[ep.Antenna()], receivers=[ep.Antenna(pattern=ep.CosinePower(2))])
    assert "77 GHz" in repr(radar) and "1 receiver," in repr(radar)
    assert "CosinePower" in repr(radar.receivers[0])
    assert "at (1, 2, 3) m, yaw 0.7 rad, pitch -0.1 rad" in repr(placed) and "moving" in repr(placed)
    assert "(0.1, 0.2, 0.3) m, yaw 0.1 rad, pitch 0.2 rad" in repr(turned)
    assert "rolled" in repr(ep.Antenna(orientation=(0, 1, 0, 0)))


def three_in_turns():
    return ep.Radar(reference(), transmitters=[ep.Antenna((0, 0.01 * k, 0)) for k in range(3)], receivers=[ep.Antenna()])


def test_velocities_look_the_same_that_turn_the_phase_by_a_whole_turn_from_chirp_to_chirp():
    """lambda / (2 T) with T between chirps of a transmitter, or between slots where folds were tried."""
    radar = three_in_turns()
    assert ambiguity_of(radar) == pytest.approx(radar.waveform.wavelength / (2 * 3 * 30e-6))
    assert ambiguity_of(radar, folds=1) == pytest.approx(radar.waveform.wavelength / (2 * 30e-6))
    velocities = np.array([-13.0, -4.9, 0.0, 4.9, 5.1, 27.0])
    assert folded(velocities, 10.0) == pytest.approx([-3.0, -4.9, 0.0, 4.9, -4.9, -3.0])
    for none_or_all in (np.inf, 0.0):
        assert np.array_equal(folded(velocities, none_or_all), velocities)


@pytest.mark.parametrize("polarization, is_mixed", [
    ((0, 0, -1), False), ((0, 0.06, 0.9981983), False), ((0, 1, 0), True), ((0, 0.6, 0.8), True)])
def test_channels_of_antennas_with_another_polarisation_are_mixed(polarization, is_mixed):
    """Of one end or the other; a sign is none, as an antenna turned by half a turn about its boresight has."""
    pair = [ep.Antenna(), ep.Antenna((0, 0.01, 0), polarization=polarization)]
    for ends in ({"transmitters": pair}, {"receivers": pair}):
        assert mixes_polarisations(three_in_turns().replace(**ends)) == is_mixed
    assert not mixes_polarisations(three_in_turns().replace(receivers=pair[1:]))  # one pair, such as VH
