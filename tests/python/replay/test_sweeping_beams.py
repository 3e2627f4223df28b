"""Narrow beams that sweep over a target within a frame, or that a target crosses: an echo of a few chirps among hundreds, whose
amplitude follows from the radar equation by the gains at each chirp."""
import numpy as np
import pytest

import echopath as ep

CHIRPS, TURN_TIME = 360, 0.25          # in a turn; s
WIDTH, TALL = np.radians(2.0), np.radians(20.0)
BALL, DISTANCE = 0.2, 20.0             # m
WAVEFORM = ep.ChirpSequence(start_frequency=76e9, bandwidth=75e6, num_samples=16, sampling_rate=5e6, num_chirps=CHIRPS,
                            chirp_interval=TURN_TIME / CHIRPS)
SEEN = 1e-3                            # of the largest amplitude: below it, the table of the pattern is read, not the law
ERROR = 0.002                          # of the largest amplitude: steps of the table of gains, and points of reflection that stay


def radar_with(**motion) -> ep.Radar:
    beam = ep.GaussianBeam(azimuth=WIDTH, elevation=TALL)
    antennas = [ep.Antenna(pattern=beam)]
    return ep.Radar(WAVEFORM, transmitters=antennas, receivers=antennas, **motion)


def ball_at(azimuth: float, **motion) -> ep.Scene:
    scene = ep.Scene()
    scene.add(ep.actors.sphere(BALL), name="ball", material="metal", smooth=True, **motion,
              position=(DISTANCE * np.cos(azimuth), DISTANCE * np.sin(azimuth), 0.0))
    return scene


def level_of_chirps(scene, radar, evaluate: str) -> np.ndarray:
    """Amplitude [chirp] over the largest."""
    paths = ep.trace(scene, radar, num_rays=500)
    level = np.sqrt(np.mean(np.abs(ep.synthesize(paths, radar, evaluate=evaluate)[0, 0]) ** 2, axis=1))
    return level / level.max()


def level_in_beam(off) -> np.ndarray:
    """The same of a beam whose gain falls to a half at half its width, from the angles off its axis, rad [chirp]."""
    level = 2.0 ** -(2.0 * off / WIDTH) ** 2  # of the power one way, so of the amplitude both ways
    return level / level.max()


@pytest.mark.parametrize("evaluate", ["interpolated", "chirps", "samples"])
@pytest.mark.parametrize("azimuth_deg", [-169.0, -56.3, 0.0, 33.3, 90.0, 171.7])
def test_a_radar_that_turns_sees_a_ball_when_it_looks_there(azimuth_deg, evaluate):
    """All nodes of few saw the ball beside the beam, before: it had no echo at all."""
    radar = radar_with(motion=ep.LinearMotion(angular_velocity=(0.0, 0.0, 2.0 * np.pi / TURN_TIME)))
    azimuth = np.radians(azimuth_deg)
    times = np.array([radar.chirp_time(0, chirp) for chirp in range(CHIRPS)])
    off = (2.0 * np.pi * times / TURN_TIME - azimuth + np.pi) % (2.0 * np.pi) - np.pi
    expected = level_in_beam(off)
    found = level_of_chirps(ball_at(azimuth), radar, evaluate)
    assert np.abs(found - expected).max() < ERROR
    assert found[expected < SEEN].max() < SEEN


def test_a_ball_that_crosses_a_narrow_beam_is_heard_in_it_alone():
    speed = 40.0  # m/s: 10 m within the frame, 14 widths of the beam
    scene = ball_at(0.0)
    radar = radar_with()
    times = np.array([radar.chirp_time(0, chirp) for chirp in range(CHIRPS)])
    place = speed * (times - 0.37 * TURN_TIME)  # m to the left
    scene["ball"].position = (DISTANCE, -0.37 * speed * TURN_TIME, 0.0)
    scene["ball"].motion = ep.LinearMotion(velocity=(0.0, speed, 0.0))
    found = level_of_chirps(scene, radar, "interpolated")
    off = np.arctan2(place, DISTANCE)
    expected = level_in_beam(off) * np.cos(off) ** 2
    assert np.abs(found - expected / expected.max()).max() < ERROR


def error_of_nodes(scene, radar) -> float:
    """Largest error of the signal with few nodes, over the largest of that which is evaluated in every chirp."""
    paths = ep.trace(scene, radar, num_rays=1000)
    exact = ep.synthesize(paths, radar, evaluate="chirps")
    return np.abs(ep.synthesize(paths, radar) - exact).max() / np.abs(exact).max()


@pytest.mark.parametrize("frame_time, width_deg", [(0.25, 0.5), (0.1, 2.0), (0.05, 0.5)])
def test_a_ball_that_crosses_the_beam_of_a_receiver_far_from_the_transmitter_is_heard(frame_time, width_deg):
    """Seen from the transmitter, 99 m away, it hardly moves; before the receiver, 4 m away, it had no echo."""
    waveform = WAVEFORM.replace(chirp_interval=frame_time / CHIRPS, bandwidth=80e6, num_samples=64)
    beam = ep.GaussianBeam(azimuth=np.radians(width_deg), elevation=TALL)
    radar = ep.Radar(waveform, transmitters=[ep.Antenna()], receivers=[ep.Antenna((95.0, 0.0, 0.0), pattern=beam)])
    scene = ep.Scene()
    scene.add(ep.actors.sphere(BALL), name="ball", material="metal", smooth=True, position=(99.0, -40.0 * frame_time / 2.6, 0.0),
              motion=ep.LinearMotion(velocity=(0.0, 40.0, 0.0)))
    assert error_of_nodes(scene, radar) < 1e-4


@pytest.mark.parametrize("what", ["floor", "wall"])
def test_places_of_large_triangles_are_seen_when_a_narrow_beam_passes_them(what):
    """Their corners are 30 m away, and sweep through the beam far more slowly than what lies right before the radar."""
    surface, angles, beam = {
        "floor": (ep.actors.ground(60.0, edge=60.0), {"pitch": -np.radians(40)}, {"azimuth": TALL, "elevation": WIDTH}),
        "wall": (ep.actors.wall(60.0, 4.0, edge=60.0), {"yaw": np.radians(90)}, {"azimuth": 1.5 * WIDTH, "elevation": TALL}),
    }[what]
    scene = ep.Scene()
    scene.add(surface, name=what, material=ep.Material(permittivity=5.0, scattering=0.6),
              position=(0.0, 0.0 if what == "floor" else 2.0, 0.0))
    antennas = [ep.Antenna(pattern=ep.GaussianBeam(**beam), **angles)]
    radar = ep.Radar(WAVEFORM.replace(chirp_interval=0.1 / CHIRPS), position=(0.0, 0.0, 1.0), transmitters=antennas,
                     receivers=antennas, motion=ep.LinearMotion(velocity=(30.0, 0.0, 0.0)))
    assert error_of_nodes(scene, radar) < 1e-4
