"""Chirps that fall: echoes, maps, receivers and other radars by the phases of their carriers, and triangular modulation."""
import warnings

import numpy as np
import pytest

import echopath as ep
from echopath import _core
from echopath.spectra.noise_shape import noise_shape
from support.radars import build_radar
from support.signals.other_radars import other
from support.street import built, street_table

C = ep.speed_of_light
START, RATE, COUNT, CHIRPS = 77e9, 20e6, 64, 16
FALLING = {"bandwidth": -0.5e9, "num_samples": COUNT, "num_chirps": CHIRPS, "sampling_rate": RATE}
SLOPE = -0.5e9 * RATE / COUNT
TIME = np.arange(COUNT) / RATE
MIDDLE = 0.5 * (COUNT - 1) / RATE
CELL = C / 1e9            # m
ROUNDING = 1e-9           # rad: of products of 4e4 turns
SETTLED = 0.01            # of the signal: what the receiver promises


def waveform(**settings):
    return build_radar(**FALLING, **settings).waveform


def phasor(delay, time=TIME, slope=SLOPE):
    """What an echo of some delay (s) and amplitude 1 sends: e^{j 2 pi (f0 d + slope t d - slope d^2 / 2)}."""
    return np.exp(2j * np.pi * (START * delay + slope * (time * delay - 0.5 * delay ** 2)))


def as_real(signal, real):
    return np.sqrt(2.0) * signal.real if real else signal


@pytest.mark.parametrize("real", [False, True])
@pytest.mark.parametrize("method", ["direct", "recurrence", "nufft"])
def test_echoes_have_the_phase_of_chirps_that_fall(method, real):
    delays, amplitudes = 2.0 * np.array([1.0, 4.37, 9.1]) / C, np.array([1.0, 0.5j, -0.1 + 0.2j])
    found = _core.synthesize_echoes(waveform(real=real), delays[None], amplitudes[None], method=method, tolerance=1e-11)
    wanted = as_real((np.conj(amplitudes)[:, None] * phasor(delays[:, None])).sum(axis=0), real)
    np.testing.assert_allclose(found[3], wanted, rtol=0, atol=ROUNDING)


@pytest.mark.parametrize("real, last", [(False, 1.0), (True, 0.5)])
def test_the_band_ends_where_that_of_chirps_that_rise_does(real, last):
    delays = np.array([0.99, 1.01]) * last * RATE / abs(SLOPE)
    powers = [np.mean(np.abs(_core.synthesize_echoes(waveform(real=real), [[delay]], [[1.0]])) ** 2) for delay in delays]
    assert powers[0] > 0.5 and powers[1] == 0.0


def plane(speed, **settings):
    """Paths of a metal plane 5 m before the radar, which recedes, and its delay [chirp, sample] in s."""
    scene = ep.Scene()
    scene.add(ep.actors.plate(30.0, 30.0), name="plane", material="metal", position=(5.0, 0, 0),
              motion=ep.LinearMotion(velocity=(speed, 0, 0)))
    radar = build_radar(**FALLING, **settings)
    begin = np.arange(CHIRPS)[:, None] * radar.waveform.chirp_interval
    return ep.trace(scene, radar, num_rays=2000, max_bounces=1), 2.0 * (5.0 + speed * (begin + TIME)) / C


@pytest.mark.parametrize("real", [False, True])
@pytest.mark.parametrize("evaluate, error", [("chirps", 2.0 * np.pi * abs(SLOPE) * 2.0 * 30.0 / C * MIDDLE ** 2),
                                             ("samples", 1e-6)])
def test_a_plane_that_recedes_has_its_delay_at_each_sample(evaluate, error, real):
    """Between a linear phase over each chirp and the true one lies 2 pi slope d' (T / 2)^2. Metal turns the field round, and the
    level falls with the distance from chirp to chirp."""
    paths, delay = plane(30.0, real=real)
    found = ep.synthesize(paths, evaluate=evaluate, tolerance=1e-10)[0, 0]
    wanted = as_real(-phasor(delay), real)
    size = np.sqrt(np.mean(np.abs(found) ** 2, axis=1) / np.mean(np.abs(wanted) ** 2, axis=1))
    np.testing.assert_allclose(found / size[:, None], wanted, rtol=0, atol=1.5 * error + 1e-4)


@pytest.mark.parametrize("real", [False, True])
@pytest.mark.parametrize("speed", [6.0, -6.0])
@pytest.mark.filterwarnings("ignore:spectrum. holds no noise")
def test_maps_show_ranges_and_velocities_with_their_signs(speed, real):
    """Range and velocity couple the other way round: an echo that recedes shows nearer, by v f / |slope|."""
    paths, _ = plane(speed, real=real)
    spectrum = ep.range_doppler(ep.synthesize(paths), paths.radar, zero_pad=8)
    power = np.abs(spectrum.values[0, 0]) ** 2
    row, column = np.unravel_index(power.argmax(), power.shape)
    centre, time = paths.radar.waveform.centre_frequency, 0.5 * (CHIRPS - 1) * paths.radar.waveform.chirp_interval + MIDDLE
    assert spectrum.velocity[row] == pytest.approx(speed, abs=np.ptp(spectrum.velocity[:2]))
    assert spectrum.range[column] == pytest.approx(5.0 + speed * (time + centre / SLOPE), abs=CELL / 8)
    found = ep.detect(spectrum, paths.radar, paths=paths)
    assert found.range[found.power.argmax()] == pytest.approx(5.0 + speed * time, abs=0.02)
    cells = ep.path_cells(paths, ep.range_doppler(ep.synthesize(paths), paths.radar))
    assert cells.range == pytest.approx(spectrum.range[column], abs=CELL / 8)


@pytest.fixture(scope="module")
def street():
    """Frames of the street of chirps that fall and of those that sweep the same band upwards, and their guards."""
    scene = built(street_table())
    radars = [build_radar(receivers=[(0, 0.01, 0), (0, -0.01, 0)], num_chirps=32, num_samples=128, transmit_power=100.0,
                          **sweep)
              for sweep in ({"start_frequency": 77.2e9, "bandwidth": -2e8}, {"bandwidth": 2e8})]
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        frames = [ep.simulate(scene, radar, num_rays=6000, max_bounces=3, seed=4, labels=True) for radar in radars]
    assert not [one for one in told if "TOO MUCH" in str(one.message)]
    return frames


def test_a_street_is_labelled_as_with_chirps_that_rise(street):
    """Of the same rays, whose speckle differs: powers by object within 3 dB in the mean, cells of the same ranges."""
    falling, rising = ({label.name: label for label in frame.labels["parts"].objects if label.cells} for frame in street)
    assert len(falling.keys() & rising.keys()) > 5
    ranges = [[one[name].peak.range for name in falling.keys() & rising.keys()] for one in (falling, rising)]
    assert np.median(np.abs(np.subtract(*ranges))) < 2.0 * C / 4e8
    powers = [[one[name].peak.power for name in falling.keys() & rising.keys()] for one in (falling, rising)]
    assert abs(np.median(10.0 * np.log10(np.divide(*powers)))) < 3.0


def test_labels_of_a_street_have_the_powers_of_its_parts(street):
    """Labels add powers up on the grid of the synthesis; here each part has its own samples and transforms."""
    frame = street[0]
    seen = [label for label in frame.labels["parts"].objects if label.cells]
    parts = ep.decompose(frame.paths, parts={label.name: f"T '{label.name}{'*' * (label.name == 'bus')}' R" for label in seen})
    assert len(seen) > 5
    for label in seen:
        power = _core.mean_power(ep.range_doppler(parts[label.name], frame.radar))
        row = np.argmin(np.abs(frame.spectrum.velocity - label.peak.velocity))
        column = np.argmin(np.abs(frame.spectrum.range - label.peak.range))
        assert power[row, column] == pytest.approx(label.peak.power, rel=0.01), label.name


@pytest.mark.parametrize("real", [False, True])
def test_frequency_errors_turn_echoes_by_their_delay(real):
    """By 2 pi (c0 d + c1 (t d - d^2 / 2)), as of chirps that rise: the oscillator does not know which way it sweeps."""
    error, delay = (4e5, 0.02 * abs(SLOPE)), 21.0 * RATE / COUNT / abs(SLOPE)
    radar = build_radar(**FALLING, real=real, receiver=ep.Receiver(frequency_error=error))
    cube = np.ones((1, 1, CHIRPS, 1)) * as_real(phasor(delay), real)
    wanted = as_real(phasor(delay) * np.exp(2j * np.pi * (error[0] * delay + error[1] * delay * (TIME - 0.5 * delay))), real)
    inner = slice(COUNT // 4, -COUNT // 4)  # the signal is taken to repeat, which its ends feel
    found = ep.receive(cube, radar, seed=None).cube[0, 0, 0]
    np.testing.assert_allclose(found[inner], wanted[inner], atol=3.0 * SETTLED)


@pytest.mark.parametrize("real", [False, True])
def test_phases_of_channels_filters_and_coupling_meet_negative_beats(real):
    """A chain's phase turns the echo as it is; a filter of real parts has the conjugate gain at -f."""
    phases, delay = [0.4, -1.1], 12.37 * RATE / COUNT / abs(SLOPE)
    radar = build_radar(receivers=((0, 0, 0), (0, 0.01, 0)), **FALLING, real=real,
                        receiver=ep.Receiver(receiver_phase=phases, coupling_db=[[0, -20.0], [-30.0, 0]], coupling_delay=2e-10))
    cube = np.ones((1, 2, CHIRPS, 1)) * as_real(phasor(delay), real)
    late = np.exp(2j * np.pi * (START + SLOPE * TIME) * 2e-10)
    wanted = [as_real(phasor(delay) * (1.0 + share * late) * np.exp(1j * phase), real)
              for phase, share in zip(phases, (10 ** -1.5, 0.1))]
    np.testing.assert_allclose(ep.receive(cube, radar, seed=None).cube[0, :, 3], wanted, atol=SETTLED)
    corner, beat = 2e6, SLOPE * delay
    behind = ep.receive(cube[:, :1], build_radar(**FALLING, real=real, receiver=ep.Receiver(high_pass=[corner])), seed=None)
    gain = 1j * beat / (1j * beat + corner)
    np.testing.assert_allclose(behind.cube[0, 0, 0, 8:], as_real(gain * phasor(delay), real)[8:], atol=3.0 * SETTLED)


def test_leakage_is_an_echo_of_its_delay():
    radar = build_radar(**FALLING, transmit_power=1.0, receiver=ep.Receiver(leakage_db=[[-30.0]], leakage_delay=3e-9))
    found = ep.receive(np.zeros((1, 1, CHIRPS, COUNT)), radar, seed=None).cube[0, 0, 5]
    np.testing.assert_allclose(found, 10 ** -1.5 * phasor(3e-9), rtol=0, atol=ROUNDING)


def test_noise_behind_a_filter_is_lowest_at_the_near_end():
    """The map's own estimate of the noise by range, by the mean of many frames of noise alone."""
    radar = build_radar(**FALLING, receiver=ep.Receiver(high_pass=[3e6]))
    cubes = [ep.receive(np.zeros((1, 1, CHIRPS, COUNT)), radar, seed=seed).cube for seed in range(40)]
    maps = [ep.range_doppler(cube, radar) for cube in cubes]
    by_range = np.mean([_core.mean_power(one) for one in maps], axis=(0, 1))
    wanted = noise_shape(maps[0], radar)
    assert by_range[0] < 0.05 * by_range[30]
    np.testing.assert_allclose(by_range / by_range.sum(), wanted / wanted.sum(), rtol=0.25, atol=2e-4)


@pytest.mark.parametrize("real", [False, True])
def test_parallel_chirps_of_another_radar_are_a_tone_at_their_delay(real):
    sender = build_radar(**FALLING, position=(3, 0, 0), yaw=np.pi)
    cube = ep.interference(build_radar(**FALLING, real=real), sender)[0, 0, 2]
    power = np.abs(np.fft.fft(cube[8:] * np.hanning(COUNT - 8), 4096)) ** 2
    beat = np.fft.fftfreq(4096, 1.0 / RATE)[power.argmax()]
    assert (beat if not real else -abs(beat)) == pytest.approx(SLOPE * 3.0 / C, abs=RATE / COUNT / 2)


@pytest.mark.parametrize("real, heard", [(False, [False, True]), (True, [True, True])])
def test_of_parallel_chirps_those_of_higher_frequencies_are_heard(real, heard):
    """Beats of a radar whose chirps fall are negative: complex samples have none of a sender whose frequency is lower."""
    victim, powers = build_radar(**FALLING, real=real), []
    for apart in (-5e6, 5e6):
        sender = build_radar(**FALLING | {"start_frequency": START + apart}, position=(3, 0, 0), yaw=np.pi)
        powers.append(np.mean(np.abs(ep.interference(victim, sender)[0, 0, 2, 8:-8]) ** 2))
    assert [power > 0.5 * max(powers) for power in powers] == heard


def test_a_rising_chirp_crosses_those_that_fall_for_as_long_as_the_slopes_say():
    """Heard while the difference of the frequencies is in the band, a sampling rate wide, whose slopes add up."""
    sender = other(slope_ratio=0.5, crossing=12.8e-6)
    radar = build_radar(num_samples=512, bandwidth=-1e9, start_frequency=78e9)
    power = np.abs(ep.interference(radar, sender)[0, 0, 0]) ** 2
    level = 0.05 * (C / sender.waveform.start_frequency / (4 * np.pi * 20.0)) ** 2
    length = RATE / (abs(radar.waveform.slope) + sender.waveform.slope)
    assert np.sum(power) / RATE == pytest.approx(level * length, rel=0.1)


def test_images_by_back_projection_keep_the_amplitude_of_a_point():
    radar, point = build_radar(**FALLING), np.array([4.0, 0.4, 0.3])
    cube = np.ones((1, 1, CHIRPS, 1)) * phasor(2.0 * np.linalg.norm(point) / C)
    assert ep.backproject(cube, radar, point) == pytest.approx(1.0, abs=4e-3)


def test_gates_of_a_spectrogram_hold_their_ranges():
    paths, _ = plane(6.0)
    cube, near, far = ep.synthesize(paths), (4.0, 6.0), (7.0, 9.0)
    inside, outside = (ep.spectrogram(cube, paths.radar, window_length=8, range_gate=gate).power.max() for gate in (near, far))
    assert inside > 1e4 * outside


def test_triangles_tell_range_and_velocity_from_two_beats():
    """Two slots with one antenna: rising in the first and falling in the second (page on transmit codes)."""
    speed, rising = -20.0, build_radar(transmitters=[(0, 0, 0)] * 2, bandwidth=1e8, num_samples=COUNT, num_chirps=CHIRPS)
    falling = rising.replace(waveform=rising.waveform.replace(start_frequency=START + 1e8, bandwidth=-1e8))
    scene = ep.Scene()
    scene.add(ep.actors.plate(30.0, 30.0), name="plane", material="metal", position=(30.0, 0, 0),
              motion=ep.LinearMotion(velocity=(speed, 0, 0)))
    paths = ep.trace(scene, rising, num_rays=2000, max_bounces=1)
    beats = []
    for slot, radar in enumerate((rising, falling)):
        samples = ep.synthesize(paths, radar)[slot, 0, 0] * np.hanning(COUNT)
        power = np.abs(np.fft.fft(samples, 1 << 16))
        beats.append(np.fft.fftfreq(1 << 16, 1.0 / RATE)[power.argmax()])
    slope = rising.waveform.slope
    doppler, beat = 0.5 * (beats[0] + beats[1]), 0.5 * (beats[0] - beats[1])
    assert beat * C / (2.0 * slope) == pytest.approx(30.0 + speed * (30e-6 + MIDDLE), abs=0.05)
    assert doppler * C / (2.0 * rising.waveform.centre_frequency) == pytest.approx(speed, abs=3.0)


@pytest.mark.parametrize("wrong, told", [({"bandwidth": 0.0}, "^bandwidth: must be finite and not 0"),
                                         ({"bandwidth": -78e9}, "^bandwidth: must leave positive frequencies"),
                                         ({"bandwidth": -1e9, "frequency_steps": (0.0, -76.5e9)}, "^bandwidth: must leave"),
                                         ({"bandwidth_steps": (0.0, -2e9)}, "^bandwidth_steps: .* all rise or all fall"),
                                         ({"bandwidth": -1e9, "bandwidth_steps": (2e9,)}, "^bandwidth_steps: .* all rise")])
def test_waveforms_that_sweep_nothing_or_both_ways_are_refused(wrong, told):
    with pytest.raises(ValueError, match=told):
        ep.ChirpSequence(**wrong)


def test_what_a_falling_waveform_tells(tmp_path):
    chirps = ep.ChirpSequence(start_frequency=78e9, bandwidth=-1e9, frequency_steps=(0.0, 1e8), bandwidth_steps=(0.0, -2e8))
    assert chirps.falls and chirps.band == pytest.approx((76.9e9, 78.1e9)) and chirps.slope < 0.0
    assert chirps.range_resolution == pytest.approx(C / 2e9) and chirps.centre_frequency == pytest.approx(77.5e9)
    assert repr(chirps).startswith("ChirpSequence(78 GHz - 1 GHz, ")
    scene = ep.Scene()
    scene.add(ep.actors.plate(1.0, 1.0), name="plate", material="metal", position=(5, 0, 0))
    frame = ep.simulate(scene, build_radar(**FALLING), num_rays=500)
    frame.save(tmp_path / "frame.h5")
    assert ep.load_frame(tmp_path / "frame.h5").radar.waveform == frame.radar.waveform
