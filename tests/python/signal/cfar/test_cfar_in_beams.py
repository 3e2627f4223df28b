"""Cells tested in the beams of an array: each beam by itself, false alarms, echoes that the sum of the channels misses."""
import numpy as np
import pytest

import echopath as ep

WAVELENGTH = ep.speed_of_light / 77e9
NUM_CHIRPS, NUM_SAMPLES = 32, 64
WAVEFORM = ep.ChirpSequence(start_frequency=76.9e9, bandwidth=200e6, num_samples=NUM_SAMPLES, sampling_rate=10e6,
                            num_chirps=NUM_CHIRPS)
ROUNDING = 1e-9
SCALLOPING = 0.81  # of the power of an echo half way between beams half a beam apart: sinc^2(1/4)


def antennas(columns, rows=1, spacing=0.5):
    """Of a grid, in steps of half a wavelength at the middle of the band."""
    return [ep.Antenna((0.0, spacing * WAVELENGTH * column, spacing * WAVELENGTH * row))
            for row in range(rows) for column in range(columns)]


def turns_radar():
    """3 transmitters above each other, in turns, and 6 receivers."""
    return ep.Radar(WAVEFORM, transmitters=antennas(1, 3), receivers=antennas(6))


def noise(radar, seed):
    """Cube of unit mean power."""
    shape = (len(radar.transmitters), len(radar.receivers), NUM_CHIRPS, NUM_SAMPLES, 2)
    return np.random.default_rng(seed).normal(scale=np.sqrt(0.5), size=shape) @ [1, 1j]


def echo(radar, direction, velocity_bin, range_bin):
    """Cube of a far echo of unit power, by the phases of its way to each antenna and of its motion until each chirp."""
    toward = np.asarray(direction) / np.linalg.norm(direction)
    places = [[np.asarray(tx.position) + rx.position for rx in radar.receivers] for tx in radar.transmitters]
    turns = len(radar.transmitters)
    slots = turns * np.arange(NUM_CHIRPS) + np.arange(turns)[:, None]
    over_chirps = np.exp(2j * np.pi * velocity_bin * slots / (turns * NUM_CHIRPS))
    over_samples = np.exp(2j * np.pi * range_bin * np.arange(NUM_SAMPLES) / NUM_SAMPLES)
    steered = np.exp(-2j * np.pi / WAVELENGTH * (np.array(places) @ toward))
    return steered[:, :, None, None] * over_chirps[:, None, :, None] * over_samples


def in_cell(radar):
    """Power of unit noise in a cell of one channel."""
    return np.mean(np.abs(ep.range_doppler(noise(radar, 0), radar).values) ** 2)


def cosines(count):
    """Of antennas half a wavelength apart: those of a transform of twice as many points."""
    return np.arange(-count, count) / count if count > 1 else np.zeros(1)


@pytest.mark.parametrize("spacing", [0.5, 0.499, 0.45, 0.3])
@pytest.mark.parametrize("columns", [2, 7, 16])
def test_echoes_lose_little_between_beams_whatever_their_direction(columns, spacing):
    """Without noise, of a line, from one end to the other."""
    radar = ep.Radar(WAVEFORM, transmitters=[ep.Antenna()], receivers=antennas(columns, spacing=spacing))
    for sine in np.linspace(-1.0, 1.0, 41):
        direction = (np.sqrt(1.0 - sine**2), sine, 0.0)
        spectrum = ep.range_doppler(echo(radar, direction, 4, 20), radar)
        assert ep.cfar(spectrum, radar, beams=True).power.max() > SCALLOPING * (1.0 - 1e-3)


@pytest.mark.parametrize("columns, rows", [(8, 1), (1, 5), (4, 3)])
@pytest.mark.parametrize("method", ["ca", "os"])
def test_cells_are_those_of_each_beam_by_itself(columns, rows, method):
    radar = ep.Radar(WAVEFORM, transmitters=[ep.Antenna()], receivers=antennas(columns, rows))
    one = ep.Radar(WAVEFORM, transmitters=[ep.Antenna()], receivers=[ep.Antenna()])
    cube = noise(radar, 1) + 0.2 * echo(radar, (1.0, 0.3, 0.1), 5, 20) + 3.0 * echo(radar, (1.0, -0.5, -0.3), 6, 24)
    u, w = (array.ravel() for array in np.meshgrid(cosines(columns), cosines(rows)))
    steps = [0.5 / count if count > 1 else 0.0 for count in (columns, rows)]
    seen = np.hypot(np.maximum(np.abs(u) - steps[0], 0.0), np.maximum(np.abs(w) - steps[1], 0.0)) <= 1.0
    places = np.array([rx.position for rx in radar.receivers]) / WAVELENGTH
    rate, best = 1e-2, {}
    for column, row in zip(u[seen], w[seen]):
        weights = np.exp(2j * np.pi * (column * places[:, 1] + row * places[:, 2])) / len(places)
        of_beam = np.einsum("n,tncs->tcs", weights, cube)[:, None]
        found = ep.cfar(ep.range_doppler(of_beam, one), one, method=method, false_alarm_rate=rate / seen.sum())
        for cell, level in zip(map(tuple, found.cells.tolist()), found.noise):
            best[cell] = max(best.get(cell, (0.0, 0.0)), (found.power[cell], level))
    found = ep.cfar(ep.range_doppler(cube, radar), radar, method=method, false_alarm_rate=rate, beams=True)
    assert found.num_beams == seen.sum() and len(best) > 10
    assert [tuple(cell) for cell in found.cells.tolist()] == sorted(best)
    np.testing.assert_allclose(found.power[tuple(found.cells.T)], [best[cell][0] for cell in sorted(best)], rtol=ROUNDING)
    np.testing.assert_allclose(found.noise, [best[cell][1] for cell in sorted(best)], rtol=ROUNDING)


UNEVEN = [ep.Antenna((0, y * WAVELENGTH, 0)) for y in (0, 0.5, 1.4, 2.6, 4.2)]


@pytest.mark.parametrize("radar", [
    turns_radar(), ep.Radar(WAVEFORM, transmitters=antennas(1), receivers=antennas(8)),
    ep.Radar(WAVEFORM, transmitters=antennas(1), receivers=UNEVEN)], ids=["rectangle in turns", "line", "uneven line"])
@pytest.mark.parametrize("rate", [1e-2, 1e-3])
def test_false_alarms_are_as_many_as_asked_for_at_most(radar, rate):
    counts = [len(ep.cfar(ep.range_doppler(noise(radar, seed), radar), radar, false_alarm_rate=rate, beams=True))
              for seed in range(40)]
    expected = rate * 40 * NUM_CHIRPS * NUM_SAMPLES
    chance = 3.0 / np.sqrt(expected)  # neighbouring cells correlate: 3 of these are some 2 standard errors
    assert 0.8 - chance < np.sum(counts) / expected < 1.0 + chance


def test_the_power_of_an_echo_is_kept_and_its_place_found():
    """Without noise, between the cells, in turns of transmitters, also across the end of the axis of velocity."""
    radar, power = turns_radar(), 4e-9
    step = ep.range_doppler(noise(radar, 0), radar).range[1]
    for velocity_bin, direction in ((3.3, (1.0, 0.0, 0.0)), (-15.8, (1.0, 0.35, 0.2)), (15.3, (1.0, -0.8, 0.1))):
        cube = np.sqrt(power) * echo(radar, direction, velocity_bin, 20.4)
        found = ep.cfar(spectrum := ep.range_doppler(cube, radar), radar, beams=True)
        peaks = ep._core.find_peaks(spectrum, radar, found)
        strongest = np.argmax(peaks["power"])
        assert SCALLOPING ** 2 * power < peaks["power"][strongest] < power * (1 + 1e-6)
        assert peaks["range"][strongest] == pytest.approx(20.4 * step, rel=1e-6)
        resolution = WAVELENGTH / (2.0 * NUM_CHIRPS * 3 * WAVEFORM.chirp_interval)
        assert peaks["velocity"][strongest] == pytest.approx(velocity_bin * resolution, abs=1e-4 * resolution)
        with pytest.warns(RuntimeWarning, match="holds no noise"):
            found = ep.detect(spectrum, radar, beams=True)
        strongest = np.argmax(found.power)
        assert found.azimuth[strongest] == pytest.approx(np.arctan2(direction[1], direction[0]), abs=1e-3)
        assert found.elevation[strongest] == pytest.approx(np.arctan2(direction[2], np.hypot(*direction[:2])), abs=1e-3)


def test_weak_echoes_are_found_in_beams_alone():
    """32 channels: an echo at the noise of a channel is 15 dB above that of a beam, less what it loses between beams; the sum of
    the channels would have to rise by less than the threshold of 1e-6, 2.6 dB above its noise."""
    radar = ep.Radar(WAVEFORM, transmitters=antennas(1, 4), receivers=antennas(8))
    level, found = np.sqrt(in_cell(radar)), {True: 0, False: 0}
    random = np.random.default_rng(3)
    for seed in range(20):
        direction = (1.0, *random.uniform(-0.8, 0.8, 2))
        spectrum = ep.range_doppler(noise(radar, 100 + seed) + level * echo(radar, direction, 7, 30), radar)
        for beams in found:
            cells = ep.cfar(spectrum, radar, beams=beams).cells
            found[beams] += any(abs(v - (NUM_CHIRPS // 2 + 7)) <= 1 and abs(r - 30) <= 1 for v, r in cells.tolist())
    assert found[True] >= 15 and found[False] <= 10


def test_clutter_from_elsewhere_does_not_hide_an_echo():
    """Strong echoes fill the training cells of a weak one, 30 degrees beside it."""
    radar = ep.Radar(WAVEFORM, transmitters=[ep.Antenna()], receivers=antennas(16))
    level = np.sqrt(in_cell(radar))
    cube = noise(radar, 7) + 4.0 * level * echo(radar, (1.0, 0.0, 0.0), 7, 30)
    for distance in (24, 27, 33, 36):
        cube = cube + 300.0 * level * echo(radar, (1.0, -np.tan(np.radians(30.0)), 0.0), 7, distance)
    spectrum, cell = ep.range_doppler(cube, radar), [NUM_CHIRPS // 2 + 7, 30]
    assert cell not in ep.cfar(spectrum, radar).cells.tolist()
    assert cell in ep.cfar(spectrum, radar, beams=True).cells.tolist()
    found = ep.detect(spectrum, radar, beams=True)
    weak = np.flatnonzero((found.cells == cell).all(axis=1))
    assert len(weak) == 1


def test_detections_of_a_frame_in_beams_know_who_made_them():
    """A sphere that one channel hears below its noise, by the radar equation, and by the array above it."""
    radar = ep.Radar(WAVEFORM, transmitters=antennas(1, 12), receivers=antennas(16), transmit_power=0.02, noise_figure_db=12.0)
    scene, radius, distance = ep.Scene(), 0.6, 30.0
    scene.add(ep.actors.sphere(radius), name="ball", material=ep.Material.metal(), position=(distance, 4.0, 0.0), smooth=True)
    frame = ep.simulate(scene, radar, num_rays=20_000, detections={"beams": True}, noise_seed=3)
    received = 0.02 * WAVELENGTH**2 * np.pi * radius**2 / ((4 * np.pi) ** 3 * (distance**2 + 16.0) ** 2)
    assert 0.2 < received / ep._core.cell_noise_power(radar, "hann") < 0.4
    found = frame.detections
    assert found.object.tolist() == ["ball"] and not found.is_noise[0]
    assert found.azimuth[0] == pytest.approx(np.arctan2(4.0, distance), abs=0.02)
    assert len(ep.detect_frame(frame)) == 0


def test_keywords_of_a_frame_ask_for_beams():
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.5), name="ball", material="metal", position=(20.0, 2.0, 0.0), smooth=True)
    radar = ep.Radar(WAVEFORM, transmitters=antennas(1), receivers=antennas(4), transmit_power=1.0)
    frame = ep.simulate(scene, radar, num_rays=2000, detections={"beams": True, "false_alarm_rate": 1e-4}, noise_seed=1)
    spectrum = frame.spectrum
    alone = ep.detect(spectrum, radar, beams=True, false_alarm_rate=1e-4)
    np.testing.assert_array_equal(frame.detections.cells, alone.cells)
    np.testing.assert_array_equal(frame.detections.noise, alone.noise)
    assert not np.array_equal(ep.detect(spectrum, radar, false_alarm_rate=1e-4).noise[:1], alone.noise[:1])


def test_arrays_of_too_many_beams_and_rates_too_small_are_refused():
    scattered = np.random.default_rng(1).uniform(-1.0, 1.0, (5, 2))  # m: hundreds of wavelengths
    wide = ep.Radar(WAVEFORM, transmitters=antennas(1), receivers=[ep.Antenna((0.0, *place)) for place in scattered])
    with pytest.raises(ValueError, match="^radar: must have an array of at most 131,072 beams to test cells in all of them, got"):
        ep.cfar(ep.range_doppler(noise(wide, 1), wide), wide, beams=True)
    line = ep.Radar(WAVEFORM, transmitters=antennas(1), receivers=antennas(8))
    with pytest.raises(ValueError, match="^false_alarm_rate: must be at least 1.6e-14 for the 16 beams of the array, got"):
        ep.cfar(ep.range_doppler(noise(line, 1), line), line, beams=True, false_alarm_rate=1e-15)
    for radar, keywords in ((wide, {}), (line, {"false_alarm_rate": 1e-15})):  # before the trace, of all channels
        with pytest.raises(ValueError, match="^(radar|false_alarm_rate): must "):
            ep.simulate(ep.Scene(), radar, num_rays=100, detections={"beams": True, **keywords},
                        progress=lambda stage, fraction: pytest.fail(stage))
