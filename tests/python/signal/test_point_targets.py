"""Ideal point targets: against the phase of every sample by the definition of the IF signal, and against traced spheres."""
import sys

import numpy as np
import pytest

import echopath as ep

SPEED_OF_LIGHT = 299792458.0
WAVEFORM = ep.ChirpSequence(start_frequency=76.5e9, bandwidth=500e6, num_samples=64, sampling_rate=5e6, num_chirps=24)
FANS = {"transmitters": [ep.Antenna((0, 0, 0), pattern=ep.CosinePower(2)), ep.Antenna((0, 0.008, 0), pattern=ep.CosinePower(2))],
        "receivers": [ep.Antenna((0, 0.002 * k, 0.01), pattern=ep.GaussianBeam(azimuth=1.5, elevation=0.6)) for k in range(3)]}
POSITIONS = np.array([[8.0, 3.0, 0.5], [5.0, -6.0, 1.0], [0.8, 0.1, -0.05]])
VELOCITIES = np.array([[-9.0, 2.0, 0.0], [15.0, 0.0, 0.0], [0.3, -0.2, 0.1]])
RCS, PHASES = np.array([1.0, 30.0, 0.001]), np.array([0.3, -1.0, 2.0])
LINEAR = 1e-3     # of the largest sample: 2 pi slope (2 v / c) (T / 2)^2 of 15 m/s, what a chirp misses that takes tones
SPHERE = 0.1      # dB, of a metal sphere of 80 wavelengths and the curvature of its facets


def signal(radar, place_of, chirp_times, level_of=lambda i, j: 1.0):
    """[tx, rx, chirp, sample] by the phase of every sample; place_of: function of the time [N, 3] m."""
    waveform, t = radar.waveform, np.arange(radar.waveform.num_samples) / radar.waveform.sampling_rate
    f0, slope = waveform.start_frequency, waveform.slope
    wavelength = SPEED_OF_LIGHT / (f0 + 0.5 * waveform.bandwidth)
    cube = np.zeros((len(radar.transmitters), len(radar.receivers), waveform.num_chirps, len(t)), complex)
    for i, tx in enumerate(radar.transmitters):
        for chirp in range(waveform.num_chirps):
            for n, instant in enumerate(t):
                time = chirp_times(i, chirp) + instant
                frame, places = radar.world_from_radar(time), place_of(time)
                d_out, sent = way_to(places, tx, frame)
                for j, rx in enumerate(radar.receivers):
                    d_back, heard = way_to(places, rx, frame)
                    delay = (d_out + d_back) / SPEED_OF_LIGHT
                    level = np.sqrt(radar.transmit_power * RCS / (4 * np.pi) ** 3) * wavelength / (d_out * d_back)
                    fields = np.conj(level * np.exp(1j * PHASES) * sent * heard)
                    turns = f0 * delay + slope * instant * delay - 0.5 * slope * delay**2
                    cube[i, j, chirp, n] = np.sum(fields * np.exp(2j * np.pi * turns))
    return cube


def way_to(places, antenna, world_from_radar):
    """(lengths in m, fields by the pattern) of the ways between an antenna and places [N, 3]."""
    turned = world_from_radar[:3, :3]
    way = places - (turned @ antenna.position + world_from_radar[:3, 3])
    length = np.sqrt(np.einsum("ij,ij->i", way, way))
    return length, antenna.pattern.field(way / length[:, None] @ turned)


def starts(waveform, slots):
    """Function of transmitter and chirp: s, of its first sample, in turns."""
    return lambda tx, chirp: (chirp * slots + tx) * waveform.chirp_interval


def assert_is(cube, expected):
    np.testing.assert_allclose(cube, expected, atol=LINEAR * np.abs(expected).max())


@pytest.mark.parametrize("start_time", [0.0, 0.1])
def test_samples_have_the_phase_of_the_definition(start_time):
    radar = ep.Radar(WAVEFORM, **FANS)
    cube = ep.point_targets(radar, POSITIONS, RCS, velocities=VELOCITIES, phases=PHASES, start_time=start_time)
    times = starts(WAVEFORM, 2)
    assert_is(cube, signal(radar, lambda time: POSITIONS + VELOCITIES * time, lambda tx, chirp: start_time + times(tx, chirp)))


def test_targets_move_as_a_function_tells_and_radars_turn():
    def places(time):
        turn = 20.0 * time
        return POSITIONS + np.array([[np.cos(turn), np.sin(turn), 0.0], [0.0, 0.0, np.sin(turn)], [0.0, 0.0, 0.0]])

    motion = ep.KeyframeMotion([0.0, 1.0], [(0.0, 0.0, 0.0), (8.0, 1.0, 0.0)], [(1, 0, 0, 0), (np.cos(0.5), 0, 0, np.sin(0.5))])
    radar = ep.Radar(WAVEFORM, **FANS, motion=motion, yaw=0.2, position=(0.0, -1.0, 0.0))
    cube = ep.point_targets(radar, places, RCS, phases=PHASES)
    assert_is(cube, signal(radar, places, starts(WAVEFORM, 2)))


@pytest.mark.parametrize("changes", [{"num_chirps": 1}, {"extra_idle": (0.0, 2e-3, 1e-5)}])
def test_single_chirps_and_uneven_trains_have_the_motion_within_each_chirp(changes):
    waveform = WAVEFORM.replace(**changes)
    radar = ep.Radar(waveform, transmitters=FANS["transmitters"][:1], receivers=FANS["receivers"][:1])
    idle, speed = waveform.extra_idle or (0.0,), np.array([-15.0, 0.0, 0.0])

    def begin(tx, chirp):
        return chirp * waveform.chirp_interval + sum(idle[k % len(idle)] for k in range(chirp))

    assert_is(ep.point_targets(radar, POSITIONS, RCS, velocities=speed, phases=PHASES),
              signal(radar, lambda time: POSITIONS + speed * time, begin))


def test_real_samples_are_the_real_part():
    radar = ep.Radar(WAVEFORM, **FANS)
    cube = ep.point_targets(radar, POSITIONS, RCS, velocities=VELOCITIES)
    real = ep.point_targets(radar.replace(waveform=WAVEFORM.replace(real=True)), POSITIONS, RCS, velocities=VELOCITIES)
    np.testing.assert_allclose(real, np.sqrt(2.0) * cube.real, atol=1e-6 * np.abs(cube).max())


@pytest.mark.parametrize("multiplexing", ["bpm", "ddm"])
def test_transmitters_at_once_come_apart_again(multiplexing):
    """Targets at rest, which the codes do not smear: each channel as of a radar with this transmitter alone."""
    radar = ep.Radar(WAVEFORM, **FANS, multiplexing=multiplexing)
    apart = ep.demultiplex(ep.point_targets(radar, POSITIONS, RCS), radar)
    for i, transmitter in enumerate(radar.transmitters):
        alone = ep.point_targets(radar.replace(transmitters=[transmitter], multiplexing="tdm"), POSITIONS, RCS)
        np.testing.assert_allclose(apart[i:i + 1], alone, atol=1e-5 * np.abs(alone).max())


def test_steps_of_frequency_are_those_of_each_chirp():
    stepped = WAVEFORM.replace(frequency_steps=(0.0, 40e6))
    radar = ep.Radar(stepped, transmitters=FANS["transmitters"][:1], receivers=FANS["receivers"][:1])
    cube = ep.point_targets(radar, POSITIONS, RCS)
    for first, offset in ((0, 0.0), (1, 40e6)):
        plain = radar.replace(waveform=WAVEFORM.replace(start_frequency=WAVEFORM.start_frequency + offset))
        np.testing.assert_array_equal(cube[:, :, first::2], ep.point_targets(plain, POSITIONS, RCS)[:, :, first::2])


@pytest.mark.parametrize("timing", [{"num_chirps": 1}, {"extra_idle": (0.0, 40e-6, 5e-6)}])
def test_ways_change_within_chirps_that_are_alone_or_unevenly_apart(timing):
    waveform = WAVEFORM.replace(chirp_interval=15e-6, **timing)
    cube = ep.point_targets(ep.Radar(waveform, **FANS), POSITIONS, RCS, velocities=VELOCITIES, phases=PHASES)
    idle = np.resize(waveform.extra_idle or [0.0], 2 * waveform.num_chirps)
    begins = 15e-6 * np.arange(2 * waveform.num_chirps) + np.cumsum(idle) - idle
    assert_is(cube, signal(ep.Radar(waveform, **FANS), lambda time: POSITIONS + VELOCITIES * time,
                           lambda tx, chirp: begins[2 * chirp + tx]))


def test_what_is_beyond_the_axis_of_range_is_not_heard():
    radar = ep.Radar(WAVEFORM, **FANS)
    np.testing.assert_array_equal(ep.point_targets(radar, [[30.0, 0.0, 0.0]], 1.0), 0.0)


@pytest.mark.parametrize("timing", [{"num_chirps": 24}, {"num_chirps": 1}, {"extra_idle": (0.0, 2e-6)}])
def test_no_targets_are_silent_in_every_train_of_chirps(timing):
    radar = ep.Radar(WAVEFORM.replace(**timing), **FANS)
    cube = ep.point_targets(radar, np.zeros((0, 3)), 1.0)
    np.testing.assert_array_equal(cube, np.zeros((2, 3, radar.waveform.num_chirps, 64)))


def calls_of(radar):
    """How many functions a point target calls."""
    kinds = []
    sys.setprofile(lambda frame, kind, argument: kinds.append(kind))
    try:
        ep.point_targets(radar, [[8.0, 3.0, 0.5]], 1.0, velocities=(5, 0, 0))
    finally:
        sys.setprofile(None)
    return sum(kind in ("call", "c_call") for kind in kinds)


def test_further_receivers_call_nothing_for_each_chirp():
    receivers = [ep.Antenna((0, 0.002 * k, 0)) for k in range(12)]
    radar = ep.Radar(WAVEFORM.replace(num_chirps=256), transmitters=[ep.Antenna()], receivers=receivers[:2])
    assert calls_of(radar.replace(receivers=receivers)) - calls_of(radar) < 10 * radar.waveform.num_chirps


def test_a_point_target_is_as_loud_as_a_sphere_of_its_cross_section():
    radius = 0.3
    radar = ep.Radar(WAVEFORM.replace(num_samples=128), **FANS)
    scene = ep.Scene()
    scene.add(ep.actors.sphere(radius), name="ball", material="metal", position=(20.0, 2.0, 0.5), smooth=True)
    traced = ep.simulate(scene, radar, num_rays=20_000, noise_seed=None)
    ahead = np.array([20.0, 2.0, 0.5])
    front = ahead * (1.0 - radius / np.linalg.norm(ahead))  # the echo comes from the front, as loud as from the middle
    point = ep.point_targets(radar, [front], np.pi * radius**2)
    ratio = np.mean(np.abs(traced.cube) ** 2) / np.mean(np.abs(point) ** 2)
    assert abs(10.0 * np.log10(ratio)) < SPHERE + 20.0 * np.log10(np.linalg.norm(ahead) / np.linalg.norm(front)) * 2
    coherence = abs(np.vdot(traced.cube, point)) / np.sqrt(np.vdot(traced.cube, traced.cube).real * np.vdot(point, point).real)
    assert coherence > 0.999


def test_wrong_targets_are_refused():
    radar = ep.Radar(WAVEFORM, **FANS)
    crossed = radar.replace(receivers=[ep.Antenna(polarization=(0, 1, 0))])
    for call, complaint in (
            (lambda: ep.point_targets(radar, POSITIONS, [1.0, 2.0]), "^rcs: must be one number, or one for each of 3 positions"),
            (lambda: ep.point_targets(radar, POSITIONS, -1.0), "^rcs: must be in m.2, 0 or more"),
            (lambda: ep.point_targets(radar, POSITIONS, 1.0, velocities=np.zeros((2, 3))), "^velocities: must be .3., or a row"),
            (lambda: ep.point_targets(radar, lambda time: POSITIONS, 1.0, velocities=(1, 0, 0)), "^velocities: must be left out"),
            (lambda: ep.point_targets(radar, lambda time: [1.0, 2.0], 1.0), r"^positions\(0\): must be an array"),
            (lambda: ep.point_targets(radar, lambda time: POSITIONS[:2 if time else 3], 1.0), r"^positions\(.*\): must be 3 "),
            (lambda: ep.point_targets(radar, [[0.0, 0.0, 0.0]], 1.0), "^positions: must be away from the antennas"),
            (lambda: ep.point_targets(crossed, POSITIONS, 1.0), "^radar: must be one whose antennas have one polarisation"),
            (lambda: ep.point_targets(radar, [1.0, 2.0, 3.0], 1.0), "^positions: must be an array")):
        with pytest.raises(ValueError, match=complaint):
            call()
