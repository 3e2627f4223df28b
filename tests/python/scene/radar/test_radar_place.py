"""A radar with a place sees what the same radar sees whose antennas are placed and turned in the world by hand."""
from __future__ import annotations

import numpy as np
import pytest

import echopath as ep
from echopath.base.numerics.rates import radar_rate
from echopath.base.radar.chirps import start_with_middle
from echopath.signals import same_radar
from support.radars import build_radar
from support.references import slow_lengths
from support.shapes import lambert, quad
from support.signals.placed_radar import antennas_in_world, make_radars, quaternion, turn

ROUNDING = 1e-8          # relative: phases of 1e5 rad from coordinates that were rounded on different ways
LENGTH_TOLERANCE = 1e-12  # m
SHARE_ROUNDING = 1e-9
RATE_ERROR = 1e-6        # m/s and 1/s: places that are rounded to 1e-15 m over steps of 50 us, and a little
POSITION, YAW, PITCH = (3.0, -2.0, 1.2), 0.5, 0.1
VELOCITY = (4.0, 1.5, 0.0)
LATE = 0.7               # s, start of a frame that is not the first


def test_the_middle_of_a_frame_is_halfway_from_its_first_sample_to_its_last():
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=101, sampling_rate=1e6, num_chirps=11,
                                chirp_interval=1e-3)
    radar = ep.Radar(waveform, transmitters=[ep.Antenna()], receivers=[ep.Antenna()])
    assert radar.middle_of_frame(2.0) - 2.0 == pytest.approx(0.5 * (10 * 1e-3 + 100 / 1e6), rel=1e-9)
    assert start_with_middle(radar, radar.middle_of_frame(2.0)) == pytest.approx(2.0, rel=1e-12)
    with pytest.raises(TypeError, match="start_time: "):
        radar.middle_of_frame("now")


def test_the_rate_of_a_radar_that_drives_and_turns():
    """The axes R of a radar that turns by omega have the rate omega x R, its place that of the motion's velocity."""
    spin = np.array([0.0, 0.0, 2.0])
    motion = ep.LinearMotion(velocity=VELOCITY, angular_velocity=spin)
    radar = build_radar(num_chirps=16, position=POSITION, yaw=YAW, motion=motion)
    world, rate = radar.world_from_radar(LATE), radar_rate(radar, LATE)
    assert rate[:3, 3] == pytest.approx(VELOCITY, abs=RATE_ERROR)
    assert rate[:3, :3] == pytest.approx(np.cross(spin, world[:3, :3], axisb=0, axisc=0), abs=RATE_ERROR)
    assert not radar_rate(radar.replace(motion=None), LATE).any()


@pytest.mark.parametrize("time", [-0.5, -0.5 + 1e-5, 0.0, 1.5])
def test_a_radar_has_its_velocity_up_to_the_ends_of_its_motion(time):
    ends = np.array([POSITION, POSITION + 2.0 * np.array(VELOCITY)])
    radar = build_radar(num_chirps=16, motion=ep.KeyframeMotion(times=[-0.5, 1.5], translations=ends))
    assert radar_rate(radar, time)[:3, 3] == pytest.approx(VELOCITY, abs=RATE_ERROR)


def street():
    """A mirror wall, a rough body that walks and a curved one, ahead of the placed radar."""
    scene = ep.Scene()
    wall = quad((-5, 8, -5), (40, 8, -5), (40, 8, 6), (-5, 8, 6))
    scene.add(wall, name="wall", material=ep.Material(permittivity=5 - 0.3j, scattering=0.3, mirror=True))
    scene.add(ep.actors.box((0.5, 0.6, 1.7)), name="walker", material=lambert(0.3), position=(11, 1, 0.9), yaw=0.4,
              motion=ep.LinearMotion(velocity=(-1, 0.5, 0), angular_velocity=(0, 0, 0.3)))
    scene.add(ep.actors.sphere(0.4), name="ball", material="metal", position=(10, 4, 1.5), smooth=True)
    return scene


def turning(velocity, rate, start):
    """A motion that drives and turns about z, once about the radar's own origin and once about the world's.

    The second one is for antennas that stand at POSITION: keyframes of a turn at a constant rate about that point, which
    is no straight line; so the antennas of this case stand at the origin, and the keyframes carry them to POSITION.
    """
    times = np.array([start - 1.0, start + 1.0])
    rotations = [(np.cos(rate * t / 2), 0.0, 0.0, np.sin(rate * t / 2)) for t in times]
    keys = ep.KeyframeMotion(times=times, translations=np.array(POSITION) + np.outer(times, velocity), rotations=rotations,
                             interpolation="linear")
    return ep.LinearMotion(velocity=velocity, angular_velocity=(0.0, 0.0, rate)), keys


def radars_of(case, start):
    if case == "still":
        return make_radars(POSITION, YAW, PITCH)
    if case == "driving":
        return make_radars(POSITION, YAW, PITCH, motion=ep.LinearMotion(velocity=VELOCITY))
    own, in_world = turning(VELOCITY, 0.4, start)
    placed, _ = make_radars(POSITION, YAW, PITCH, motion=own)
    by_hand = ep.Radar(placed.waveform, transmitters=antennas_in_world(placed.transmitters, (0, 0, 0), YAW, PITCH),
                       receivers=antennas_in_world(placed.receivers, (0, 0, 0), YAW, PITCH), motion=in_world)
    return placed, by_hand


def difference(values, others):
    """Relative to the largest of the others."""
    values, others = np.asarray(values), np.asarray(others)
    assert np.abs(others).max() > 0
    return np.abs(values - others).max() / np.abs(others).max()


@pytest.mark.parametrize("start", [0.0, LATE])
@pytest.mark.parametrize("case", ["still", "driving", "turning"])
def test_signals_are_those_of_antennas_placed_by_hand(case, start):
    placed, by_hand = radars_of(case, start)
    cubes, lengths = [], []
    for radar in (placed, by_hand):
        paths = ep.trace(street(), radar, num_rays=4000, seed=2, start_time=start, polarization="jones")
        cubes.append(ep.synthesize(paths, radar, evaluate="chirps"))
        lengths.append(paths.lengths([start, start + placed.frame_duration], 1, 1))
    assert difference(*cubes) < ROUNDING
    np.testing.assert_allclose(lengths[0], lengths[1], rtol=0, atol=LENGTH_TOLERANCE)


@pytest.mark.parametrize("start", [0.0, LATE])
def test_lengths_count_positions_in_the_frame_of_the_placed_radar(start):
    placed, _ = radars_of("turning", start)
    paths = ep.trace(street(), placed, num_rays=500, start_time=start)
    transmitter, receiver = np.array([0.3, -0.2, 0.1]), np.array([-0.1, 0.4, 0.2])
    for time in (start, start + placed.frame_duration):
        truth = slow_lengths.lengths(paths, time, transmitter, receiver)
        np.testing.assert_allclose(paths.lengths([time], transmitter, receiver)[0], truth, rtol=0, atol=LENGTH_TOLERANCE)


def test_one_record_serves_a_radar_that_is_placed_elsewhere():
    """As for other motions: the hits are those of the first radar, all legs those of the second one."""
    placed, by_hand = radars_of("driving", 0.0)
    paths = ep.trace(street(), by_hand, num_rays=1000)
    near = [radar.replace(**changes) for radar, changes in
            ((placed, {"position": np.add(POSITION, (0.0, 0.1, 0.05))}), (by_hand, {"position": (0.0, 0.1, 0.05)}))]
    assert difference(*(ep.synthesize(paths, radar, evaluate="chirps") for radar in near)) < ROUNDING


def test_everything_that_asks_where_the_radar_is_agrees():
    placed, by_hand = radars_of("driving", LATE)
    found = []
    for radar in (placed, by_hand):
        paths = ep.trace(street(), radar, num_rays=4000, seed=2, start_time=LATE)
        sights = ep.visibility(street(), radar, time=LATE)
        report = ep.validity(paths, radar)
        found.append([ep.received_power(paths).coherent, ep.received_power(paths).diffuse,
                      np.abs(paths.amplitudes([LATE], 1, 1)).sum(), *paths.frame.transmitter, *paths.frame.receiver,
                      *(sight.visible_share for sight in sights), *(sight.transmitter.distance for sight in sights),
                      *(getattr(report.shares, share) for share in ("power", "slid", "left", "blocked", "new_surface"))])
    np.testing.assert_allclose(found[0], found[1], rtol=SHARE_ROUNDING, atol=SHARE_ROUNDING)


def test_a_speed_is_level_and_ahead_wherever_the_radar_looks_up_to():
    radar = build_radar(yaw=2.0, pitch=0.4, speed=3.0)
    np.testing.assert_allclose(radar.motion.velocity, (3 * np.cos(2.0), 3 * np.sin(2.0), 0.0), rtol=1e-15)
    np.testing.assert_allclose(radar.world_from_radar(2.0)[:3, 3], (6 * np.cos(2.0), 6 * np.sin(2.0), 0.0), rtol=1e-15)
    with pytest.raises(ValueError, match="^speed: must not be given together with motion, got 3"):
        build_radar(speed=3.0, motion=radar.motion)


def test_a_radar_that_drives_ahead_closes_in_on_what_stands_there():
    radar = build_radar(position=POSITION, yaw=YAW, speed=5.0, num_chirps=8)
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.2), name="ball", material="metal", smooth=True,
              position=np.add(POSITION, 8 * turn(YAW, 0.0)[:, 0]))
    lengths = ep.trace(scene, radar, num_rays=500).lengths([0.0, 0.1], 0, 0)
    np.testing.assert_allclose((lengths[1] - lengths[0]) / 0.1, -2 * 5.0, rtol=1e-2)  # what is met beside the axis: cosines


@pytest.mark.parametrize("yaw, pitch", [(0.5, 0.1), (-2.5, -1.2), (np.pi / 2, 0.0)])
def test_yaw_and_pitch_turn_an_antenna_as_they_turn_a_radar(yaw, pitch):
    antenna = ep.Antenna(yaw=yaw, pitch=pitch)
    np.testing.assert_allclose(antenna.orientation, quaternion(yaw, pitch), atol=1e-15)
    np.testing.assert_allclose((antenna.yaw, antenna.pitch), (yaw, pitch), atol=1e-15)
    radar = build_radar(yaw=yaw, pitch=pitch)
    np.testing.assert_allclose(radar.world_from_radar(0.0)[:3, :3], turn(yaw, pitch), atol=1e-15)


@pytest.mark.parametrize("name, value", [("position", (3.0, -2.0, 1.3)), ("yaw", 0.6), ("pitch", 0.2),
                                         ("motion", ep.LinearMotion(velocity=(4.0, 1.0, 0.0)))])
def test_a_radar_at_another_place_is_another_one(name, value):
    placed, _ = radars_of("driving", 0.0)
    assert same_radar.difference(placed, placed.replace(**{name: value})) == name
    still = placed.replace(motion=None)
    assert same_radar.difference(placed, still) == "motion"
    assert same_radar.difference(still, still.replace(motion=ep.LinearMotion())) == ""


def test_yaw_is_that_of_what_a_scene_holds():
    scene = ep.Scene()
    scene.add(quad((1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1)), name="plate", material="metal", position=POSITION, yaw=YAW)
    radar = build_radar(position=POSITION, yaw=YAW)
    corner = radar.world_from_radar(0.0) @ (1, 0, 0, 1)
    np.testing.assert_allclose(scene.world_vertices(0, 0.0)[0], corner[:3], atol=1e-15)


def test_angles_and_points_count_in_the_axes_of_the_placed_radar():
    half = 0.5 * ep.speed_of_light / 77.5e9
    chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=128, sampling_rate=20e6, num_chirps=16,
                              chirp_interval=30e-6)
    receivers = [ep.Antenna((0, left * half, up * half)) for up in range(4) for left in range(8)]
    radar = ep.Radar(chirps, transmitters=[ep.Antenna()], receivers=receivers, position=POSITION, yaw=2.0, pitch=-0.3,
                     transmit_power=300.0)
    azimuth, elevation, distance, radius = 0.3, 0.15, 7.0, 0.05
    toward = np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])
    scene = ep.Scene()
    scene.add(ep.actors.sphere(radius, subdivisions=4), name="ball", material="metal", smooth=True,
              position=np.add(POSITION, turn(2.0, -0.3) @ (distance * toward)))
    paths = ep.trace(scene, radar, num_rays=4000, max_bounces=1)
    spectrum = ep.range_doppler(ep.add_noise(ep.synthesize(paths, radar), radar, seed=1), radar)
    found = ep.detect(spectrum, radar, paths=paths)
    assert len(found) == 1
    assert found.azimuth[0] == pytest.approx(azimuth, abs=0.005)    # rad, of beams of 0.25
    assert found.elevation[0] == pytest.approx(elevation, abs=0.01)  # rad, of beams of 0.5
    np.testing.assert_allclose(found.points[0], (distance - radius) * toward, atol=0.1)
    seen = ep.range_azimuth(spectrum, radar, elevation=elevation)
    strongest = np.unravel_index(seen.power.argmax(), seen.power.shape)[seen.power.shape.index(len(seen.azimuth))]
    assert seen.azimuth[strongest] == pytest.approx(azimuth, abs=0.03)  # rad: the nearest azimuth of the grid


@pytest.mark.parametrize("call", [
    lambda scene, radar, still: ep.simulate(scene, radar, num_rays=100), lambda scene, radar, still: ep.trace(scene, radar),
    lambda scene, radar, still: ep.synthesize(ep.trace(scene, still, num_rays=100), radar),
    lambda scene, radar, still: ep.decompose(ep.trace(scene, still, num_rays=100), radar, {"walker": "T 'walker' R"}),
    lambda scene, radar, still: ep.visibility(scene, radar), lambda scene, radar, still: ep.interference(radar, still),
], ids=["simulate", "trace", "synthesize", "decompose", "visibility", "interference"])
def test_a_radar_whose_motion_does_not_cover_the_time_is_named(call):
    still = build_radar(position=(0, 0, 1))
    late = still.replace(motion=ep.KeyframeMotion([1.0, 2.0], [[0, 0, 0], [1, 0, 0]]))
    with pytest.raises(ValueError, match=r"^radar: must have a motion that covers all frames: time: .*\[1, 2\] s, got"):
        call(street(), late, still)


def test_another_radar_whose_motion_does_not_cover_the_time_is_named():
    late = build_radar(position=(9, 0, 1), motion=ep.KeyframeMotion([1.0, 2.0], [[0, 0, 0], [1, 0, 0]]))
    with pytest.raises(ValueError, match="^other: must have a motion that covers all frames"):
        ep.interference(build_radar(), late)
