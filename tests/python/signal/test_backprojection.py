"""Images by back-projection: of point targets whose signals are written down here, and of a traced ball."""
from __future__ import annotations

import numpy as np
import pytest

import echopath as ep

CHIRPS = ep.ChirpSequence(start_frequency=24e9, bandwidth=1e9, num_samples=32, sampling_rate=0.5e6, num_chirps=16,
                          chirp_interval=0.04)
RAIL = 0.64                       # m, straight, at 1 m/s
BETWEEN_BINS = 4e-3               # of the field: what a line between bins leaves of a lobe, and what is not linear within a chirp
NEGATIVE = 0.01                   # of the field: what the negative frequencies of real samples bring
SIDE_LOBE = 0.01                  # of the field, of another point
STEP = 0.001                      # m, of the grid across
WOBBLE = np.linspace(-0.1, 1.0, 23)
ALONG = ep.LinearMotion((0, 1, 0))
WOBBLING = ep.KeyframeMotion(WOBBLE, np.column_stack([0.03 * np.sin(9 * WOBBLE), WOBBLE, 0.02 * np.cos(7 * WOBBLE)]))


def make_radar(motion=None, num_tx=1, num_rx=1, **chirps) -> ep.Radar:
    return ep.Radar(CHIRPS.replace(**chirps), position=(0, -RAIL / 2, 1), motion=motion,
                    transmitters=[ep.Antenna((0, 0.05 * m, 0)) for m in range(num_tx)],
                    receivers=[ep.Antenna((0, 0.01 * n, 0.02)) for n in range(num_rx)])


def cube_of(radar, place_of, start_time=0.0) -> np.ndarray:
    """The signal of a point of unit amplitude that is at place_of(time): the IF phase 2 pi (f0 tau + mu t tau - mu tau^2 / 2)."""
    waveform = radar.waveform
    cube = np.empty((len(radar.transmitters), len(radar.receivers), waveform.num_chirps, waveform.num_samples), complex)
    for tx, rx, chirp, sample in np.ndindex(cube.shape):
        within = sample / waveform.sampling_rate
        time = start_time + radar.chirp_time(tx, chirp) - waveform.window_centre + within
        place = radar.world_from_radar(time)
        ends = [place[:3, :3] @ antenna.position + place[:3, 3] for antenna in (radar.transmitters[tx], radar.receivers[rx])]
        delay = sum(np.linalg.norm(place_of(time) - end) for end in ends) / ep.speed_of_light
        cycles = waveform.start_frequency * delay + waveform.slope * (within * delay - delay**2 / 2)
        cube[tx, rx, chirp, sample] = np.exp(2j * np.pi * cycles)
    return np.sqrt(2.0) * cube.real if waveform.real else cube


@pytest.mark.parametrize(("motion", "interval"), [(ALONG, 0.04), (WOBBLING, 0.04), (ep.LinearMotion((30, 9, 0)), 0.002)],
                         ids=["straight", "wobbling", "fast"])
def test_a_point_keeps_its_amplitude_whatever_way_the_radar_goes(motion, interval):
    radar, point = make_radar(motion, chirp_interval=interval), np.array([4.0, 0.4, 0.3])
    image = ep.backproject(cube_of(radar, lambda time: point), radar, point)
    assert image == pytest.approx(1.0, abs=BETWEEN_BINS)


@pytest.mark.parametrize("chirps", [{}, {"num_samples": 1, "bandwidth": 2e7}], ids=["chirps", "single samples"])
@pytest.mark.parametrize("start_time", [0.0, 0.3])
def test_keys_need_to_last_no_longer_than_the_frame(chirps, start_time):
    """From its first sample to its last one, as for the signal itself, of the radar and of what moves before it."""
    end = start_time + make_radar(**chirps).frame_duration
    keys = ep.KeyframeMotion([start_time, end], [[0.0, start_time, 0.0], [0.0, end, 0.0]], interpolation="linear")
    moved, at_rest, origin = make_radar(keys, **chirps), make_radar(**chirps), np.zeros(3)
    point = np.array([4.0, 0.4, 0.3])
    image = ep.backproject(cube_of(moved, lambda time: point, start_time), moved, point, start_time=start_time)
    assert abs(image) == pytest.approx(1.0, abs=BETWEEN_BINS)
    towards = cube_of(at_rest, lambda time: point + [0, time, 0], start_time)
    image = ep.backproject(towards, at_rest, origin, position=point, motion=keys, start_time=start_time)
    assert abs(image) == pytest.approx(1.0, abs=BETWEEN_BINS)


@pytest.mark.parametrize("real", [False, True])
def test_what_is_farther_than_the_ranges_is_dark(real):
    """Of real samples these end at half the sampling rate."""
    radar = make_radar(real=real)
    cube = np.random.default_rng(2).normal(size=(1, 1, 16, 32)) + (0 if real else 1j)
    last = radar.waveform.max_range
    near, far = (ep.backproject(cube, radar, radar.position + [share * last, 0.0, 0.0]) for share in (0.9, 1.1))
    assert abs(near) > 0.0 and far == 0.0


@pytest.mark.parametrize("arrangement", [{"num_tx": 2, "num_rx": 2}, {"real": True, "num_samples": 64}])
def test_channels_and_real_samples_are_added_in_phase(arrangement):
    radar, point = make_radar(WOBBLING, num_chirps=4, **arrangement), np.array([4.0, 0.4, 0.3])
    image = ep.backproject(cube_of(radar, lambda time: point, 0.2), radar, [point, point + (60, 0, 0)], start_time=0.2)
    assert image == pytest.approx([1.0, 0.0], abs=NEGATIVE if radar.waveform.real else BETWEEN_BINS)


@pytest.mark.parametrize(("window", "factor"), [("rect", 0.443), ("hann", 0.721)])
def test_a_rail_resolves_what_its_length_says(window, factor):
    radar, point = make_radar(ALONG), np.array([4.0, 0.0, 1.0])
    across = np.arange(-0.06, 0.06, STEP)
    image = ep.backproject(cube_of(radar, lambda time: point), radar, point + across[:, None] * (0, 1, 0),
                           window=("hann", window))
    seen = across[np.abs(image) ** 2 > 0.5]
    assert seen[-1] - seen[0] == pytest.approx(factor * CHIRPS.wavelength * 4.0 / RAIL, rel=0, abs=2 * STEP)


def test_what_moves_and_turns_is_sharp_in_its_own_axes():
    motion, yaw, position = ep.LinearMotion((-3.0, 1.0, 0.0), (0, 0, 0.6)), 0.4, np.array([4.0, 0.0, 0.0])
    turned = np.array([[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])
    radar, bow, stern = make_radar(), np.array([0.6, 0.1, 0.5]), np.array([-0.5, 0.0, 0.5])

    def place_of(time):
        step = motion.at(time)
        return position + step[:3, 3] + step[:3, :3] @ turned @ bow

    image = ep.backproject(cube_of(radar, place_of), radar, [[bow, stern]], position=position, yaw=yaw, motion=motion)
    assert image.shape == (1, 2)
    assert image[0, 0] == pytest.approx(1.0, abs=BETWEEN_BINS)
    assert abs(image[0, 1]) < SIDE_LOBE


def test_a_ball_has_the_level_that_its_map_shows():
    scene, radar = ep.Scene(), make_radar(num_chirps=4)
    scene.add(ep.actors.sphere(0.1), name="ball", material="metal", position=(4, 0, 1), smooth=True)
    cube = ep.synthesize(ep.trace(scene, radar, num_rays=1000), radar)
    image = ep.backproject(cube, radar, [(x, 0, 1) for x in np.arange(3.88, 3.93, 0.005)])
    shown = np.abs(ep.range_doppler(cube, radar, zero_pad=16).values).max()
    assert np.abs(image).max() == pytest.approx(shown, rel=BETWEEN_BINS)


def test_cubes_that_the_radar_does_not_make_are_refused():
    radar = make_radar(num_chirps=4)
    with pytest.raises(ValueError, match=r"^cube: must be an array \[1, 1, 4, 32\] of finite numbers"):
        ep.backproject(np.full((1, 1, 4, 32), np.nan), radar, (1, 0, 0))
    with pytest.raises(ValueError, match="^radar: must be one with transmitters in turns"):
        ep.backproject(np.zeros((1, 1, 4, 32)), make_radar(num_chirps=4, frequency_steps=(0, 1e6)), (1, 0, 0))
