"""Arrays wider than the ways to what they see: no path is left out whose launch cell is dark to some antennas alone."""
import numpy as np
import pytest

import echopath as ep
from support.radars import build_radar

RELATIVE = 1e-6  # of the strongest sample: what interpolation between nodes may err


def paths_of(transmitters, receivers, num_rays):
    """A ball that comes nearer in front, a wall that follows behind, both within a metre."""
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.3), name="ball", material="metal", position=(0.6, 0.0, 0.0), smooth=True,
              motion=ep.LinearMotion((1.0, 0.2, 0.0)))
    scene.add(ep.actors.plate(4.0, 4.0), name="wall", material="metal", position=(-0.6, 0.0, 0.0),
              motion=ep.LinearMotion((0.5, 0.0, 0.0)))
    radar = build_radar(transmitters, receivers, num_samples=32, num_chirps=32)
    return ep.trace(scene, radar, num_rays=num_rays, max_bounces=3), radar


@pytest.mark.parametrize("width", [0.3, 2.0, 8.0])
@pytest.mark.parametrize("side", ["transmitters", "receivers"])
def test_every_channel_of_a_wide_array_has_the_echo_of_each_chirp(width, side):
    alone, apart = [(0.0, 0.0, 0.0)], [(0.0, 0.0, 0.0), (0.0, width, 0.0)]
    num_rays = 10_000 if width < 4.0 else 30_000  # few of those of an antenna far aside meet the ball
    paths, radar = paths_of(*((apart, alone) if side == "transmitters" else (alone, apart)), num_rays)
    for some in (paths, paths.select("T 'ball' 'wall' R"), paths.select("T 'wall' 'ball' R")):
        assert some.num_paths > 0
        found, expected = ep.synthesize(some, radar), ep.synthesize(some, radar, evaluate="chirps")
        assert np.abs(found - expected).max() < RELATIVE * np.abs(expected).max()


@pytest.mark.parametrize("step", [0.02, -0.02])
def test_transmitters_beyond_the_first_group_have_the_echo_of_each_chirp(step):
    """64 channels are replayed at a time: the last ones have phases and amplitudes of their own. step: m"""
    paths, radar = paths_of([(0.0, 0.66 - 33 * step + step * i, 0.0) for i in range(67)], [(0.0, 0.0, 0.0)], 2000)
    found, expected = ep.synthesize(paths, radar), ep.synthesize(paths, radar, evaluate="chirps")
    assert np.abs(expected[66] - expected[2]).max() > 0.1 * np.abs(expected).max()
    assert np.abs(found - expected).max() < RELATIVE * np.abs(expected).max()


def near_bumper(distance, material):
    """What `validity` says of a plane before a transmitter and receivers 4 mm and 10 cm beside it, which stand still."""
    scene = ep.Scene()
    scene.add(ep.actors.plate(2.0, 2.0), name="bumper", material=material, position=(distance, 0.0, 0.0))
    radar = build_radar([(0.0, 0.0, 0.0)], [(0.0, 0.004, 0.0), (0.0, 0.1, 0.0)], num_samples=32, num_chirps=4)
    paths = ep.trace(scene, radar, num_rays=20_000, max_bounces=1)
    assert paths.num_paths == 1
    return ep.validity(paths), paths


SLAB, THICKNESS = 2.6 - 0.02j, 2.5e-3  # m


def slab_reflection(frequency, incidence):
    """Airy's sum over the bounces in a slab, of a field across the plane of incidence."""
    across, within = np.cos(incidence), np.sqrt(SLAB - np.sin(incidence) ** 2)
    face = (across - within) / (across + within)
    turn = np.exp(-4j * np.pi * frequency / ep.speed_of_light * THICKNESS * within)
    return abs(face * (1.0 - turn) / (1.0 - face**2 * turn))


def test_validity_tells_where_an_array_near_a_sheet_has_one_coefficient_for_all_of_it():
    """The record keeps that between the mean antennas: at the far receiver the bumper reflects otherwise."""
    report, paths = near_bumper(0.03, ep.Material(layers=[ep.Layer(THICKNESS, SLAB)]))
    frequency = paths.radar.waveform.start_frequency
    kept, true = (slab_reflection(frequency, np.arctan2(aside / 2.0, 0.03)) for aside in (0.052, 0.1))
    for receiver, aside in enumerate((0.004, 0.1)):
        length = np.hypot(0.06, aside)
        endless = ep.speed_of_light / frequency * np.sqrt(paths.radar.transmit_power) / (4.0 * np.pi * length)
        assert abs(paths.amplitudes([0.0], 0, receiver)[0, 0]) / endless == pytest.approx(kept, rel=1e-3)
    assert abs(kept - true) > 0.3 * max(kept, true)
    assert report.turned_share == pytest.approx(1.0) and not report.ok
    (warning,) = report.warnings
    assert "reflect otherwise" in warning and "parts of the array by themselves" in warning


@pytest.mark.parametrize(("distance", "material"), [(3.0, ep.Material(layers=[ep.Layer(THICKNESS, SLAB)])), (0.03, "metal")])
def test_validity_is_content_with_a_far_sheet_and_with_near_metal(distance, material):
    assert near_bumper(distance, material)[0].ok


def test_validity_tells_where_the_field_in_the_plane_of_incidence_alone_is_reflected_otherwise():
    """At Brewster's angle glass reflects nothing of it to the mean antennas; the receivers lie to both sides of that angle."""
    permittivity, distance = 4.0, 0.03
    places = distance * np.array([-1.8, 4.0 * np.sqrt(permittivity) + 1.8])
    level = [ep.Antenna((0.0, aside, 0.0), polarization=(0.0, 1.0, 0.0)) for aside in (0.0, *places)]
    scene = ep.Scene()
    scene.add(ep.actors.plate(2.0, 2.0), name="window", material=ep.Material(permittivity=permittivity),
              position=(distance, 0.0, 0.0))
    radar = build_radar(level[:1], level[1:], num_samples=32, num_chirps=4)
    paths = ep.trace(scene, radar, num_rays=20_000, max_bounces=1)
    wavelength = ep.speed_of_light / radar.waveform.start_frequency
    for receiver, aside in enumerate(places):
        endless = wavelength * np.sqrt(radar.transmit_power) / (4.0 * np.pi * np.hypot(2.0 * distance, aside))
        assert abs(paths.amplitudes([0.0], 0, receiver)[0, 0]) < 1e-3 * endless
    report = ep.validity(paths)
    assert report.turned_share == pytest.approx(1.0) and not report.ok
