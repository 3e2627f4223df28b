"""Corrections of channels from a reflector whose place is known: of signals written down here, and in whole scenes."""
from __future__ import annotations

import numpy as np
import pytest

import echopath as ep

CHIRPS = ep.ChirpSequence(start_frequency=77e9, bandwidth=3e8, num_samples=128, sampling_rate=5e6, num_chirps=128,
                          chirp_interval=3e-5)
WAVELENGTH = CHIRPS.wavelength
BETWEEN_BINS = 4e-3   # of the field: what a line between bins leaves of a lobe
ANGLE = 0.01          # degrees: what the ball leaves, whose near side is another one for each channel
BALL, RADIUS = np.array([3.0, 0.4, 1.0]), 0.05  # m
TRANSMITTER_ERRORS = {"transmitter_gain_db": [0.0, 0.7], "transmitter_phase": [0.0, 1.1]}
RECEIVER_ERRORS = {"receiver_gain_db": [0.0, 1.0, -0.5, 0.3], "receiver_phase": [0.2, 0.9, -0.4, 2.5]}


def make_radar(**settings) -> ep.Radar:
    """An array of 2 x 4 in a line."""
    return ep.Radar(CHIRPS, transmitters=[ep.Antenna((0, 2.0 * WAVELENGTH * m, 0)) for m in range(2)],
                    receivers=[ep.Antenna((0, 0.5 * WAVELENGTH * n, 0)) for n in range(4)], **settings)


def cube_of(radar, point, errors) -> np.ndarray:
    """The signal of a point at rest with channels [tx, rx] of these gains: the IF phase 2 pi (f0 tau + mu t tau - mu tau^2 / 2),
    at the place that the radar has in the middle of each chirp."""
    waveform, cube = radar.waveform, []
    within = np.arange(waveform.num_samples) / waveform.sampling_rate
    for tx, rx, chirp in np.ndindex(len(radar.transmitters), len(radar.receivers), waveform.num_chirps):
        place = radar.world_from_radar(radar.chirp_time(tx, chirp))
        ends = [place[:3, :3] @ antenna.position + place[:3, 3] for antenna in (radar.transmitters[tx], radar.receivers[rx])]
        legs = [np.linalg.norm(point - end) for end in ends]
        delay = sum(legs) / ep.speed_of_light
        cycles = (waveform.start_frequency + waveform.slope * (within - delay / 2)) * delay
        cube.append(errors[tx, rx] * np.exp(2j * np.pi * cycles) * np.linalg.norm(point) ** 2 / np.prod(legs))
    return np.reshape(cube, (len(radar.transmitters), len(radar.receivers), waveform.num_chirps, waveform.num_samples))


@pytest.mark.parametrize("settings", [{}, {"position": (1.0, -2.0, 0.5), "yaw": 0.3, "motion": ep.LinearMotion((3.0, 0.5, 0.0))}],
                         ids=["at rest", "that drives"])
@pytest.mark.parametrize("distance", [0.3, 30.0])
def test_corrections_of_a_point_are_the_inverse_of_the_errors(settings, distance):
    """At 0.3 m a plane wave is wrong by a quarter of a turn at the ends of the array."""
    random = np.random.default_rng(4)
    errors = random.uniform(0.5, 2.0, (2, 4)) * np.exp(2j * np.pi * random.uniform(size=(2, 4)))
    radar = make_radar(**settings)
    point = radar.world_from_radar(0.0)[:3, 3] + distance * np.array([0.8, 0.5, 0.33])
    found = ep.calibrate(cube_of(radar, point, errors), radar, point)
    level = np.sqrt(np.mean(np.abs(errors) ** 2)) * np.exp(1j * np.angle(errors[0, 0]))
    np.testing.assert_allclose(found * errors, np.full((2, 4), level), rtol=BETWEEN_BINS)


def bench() -> ep.Scene:
    scene = ep.Scene()
    scene.add(ep.actors.sphere(RADIUS), name="ball", material="metal", smooth=True, position=BALL)
    return scene


def street() -> ep.Scene:
    scene = ep.Scene()
    for place, (x, y) in enumerate([(9.0, -3.0), (12.0, 4.0), (14.0, 0.0), (16.0, -5.0)]):
        scene.add(ep.actors.sphere(0.8), name=f"target {place}", material="metal", smooth=True, position=(x, y, 1))
    scene.add(ep.actors.pedestrian(), name="walker", position=(6, 3, 0))
    scene.add(ep.actors.wall(30.0, 4.0), name="wall", material="concrete", position=(10, 25, 0))
    return scene


def bearings(cube, radar) -> np.ndarray:
    """Azimuths in degrees of the targets, each in the cell of its range where it stands still."""
    spectrum, found = ep.range_doppler(cube, radar), []
    standing = int(np.argmin(np.abs(spectrum.velocity)))
    for x, y in [(9.0, -3.0), (12.0, 4.0), (14.0, 0.0), (16.0, -5.0)]:
        cell = int(np.argmin(np.abs(spectrum.range - (np.hypot(x, y) - 0.8))))
        found.append(ep.estimate_angles(spectrum, radar, cells=[[standing, cell]]).azimuth[0])
    return np.degrees(found)


@pytest.mark.parametrize("position", [(0, 0, 1), (0.2, -0.1, 1)])
def test_angles_in_a_street_are_right_again(position):
    faulty = make_radar(position=position, receiver=ep.Receiver(**TRANSMITTER_ERRORS, **RECEIVER_ERRORS))
    to_radar = np.subtract(position, BALL)
    near_side = BALL + RADIUS * to_radar / np.linalg.norm(to_radar)
    measured, frame = (ep.simulate(scene, faulty, num_rays=8000, guard=False).cube for scene in (bench(), street()))
    corrections = ep.calibrate(ep.receive(measured, faulty, seed=None).cube, faulty, near_side)
    received = ep.receive(frame, faulty, seed=None).cube
    ideal, wrong = bearings(frame, faulty), bearings(received, faulty)
    mended = bearings(corrections[:, :, None, None] * received, faulty)
    assert np.abs(wrong - ideal).max() > 5.0
    assert np.abs(mended - ideal).max() < ANGLE


def test_noise_in_the_place_of_an_echo_is_told():
    """Of a phase with a ratio S of signal to noise the rms error is sqrt(1 / (2 S)): half a radian or more, without any."""
    radar = make_radar()
    noise = ep.add_noise(np.zeros((2, 4, CHIRPS.num_chirps, CHIRPS.num_samples), complex), radar, seed=3)
    with pytest.warns(RuntimeWarning, match=r"^calibrate: the echo stands -?\d+\.\d dB above the noise .* by some \d+\.\d\d rad"):
        ep.calibrate(noise, radar, (5, 0, 0))


def test_a_channel_without_an_echo_is_named():
    radar = make_radar()
    cube = cube_of(radar, np.array([5.0, 0.0, 0.0]), np.array([[1, 1, 1, 1], [1, 1, 0, 1]]))
    with pytest.raises(ValueError, match=r"^cube: must have an echo of the position .* s, got none in \[tx, rx\] = \[1, 2\]"):
        ep.calibrate(cube, radar, (5, 0, 0))
