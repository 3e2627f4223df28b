"""Codes of transmitters that send at once, and what undoes them."""
import itertools
import re
from pathlib import Path

import numpy as np
import pytest

import echopath as ep
from echopath.base.radar.chirps import chirp_period, chirps_duration
from echopath.transmit import code_signal, doppler_division
from support.radars import build_radar

C = ep.speed_of_light
REAL = ep.ChirpSequence(real=True)
ROUNDING = 1e-12      # of sums of a few hundred terms, relative to the largest
SAME_STATIC = 1e-9    # promised for scenes at rest, relative
NUM_TX, NUM_RX = 3, 4
HALF = 0.5 * C / 77.5e9


def array_radar(multiplexing="tdm", num_chirps=32, **settings):
    """Three transmitters 2 wavelengths apart, four receivers half a wavelength apart: a line of 12 elements."""
    return build_radar([(0, 4 * m * HALF, 0) for m in range(NUM_TX)], [(0, n * HALF, 0) for n in range(NUM_RX)],
                       num_chirps=num_chirps, multiplexing=multiplexing, **settings)


def plates(*speeds, radar=None, azimuths=None):
    """Paths of small balls at 3, 4, ... m that move away at those speeds."""
    scene = ep.Scene()
    for i, speed in enumerate(speeds):
        azimuth = 0.2 if azimuths is None else azimuths[i]
        out = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
        scene.add(ep.actors.sphere(0.1), name=f"ball{i}", material=ep.Material.metal(), smooth=True,
                  position=tuple((3.0 + i) * out), motion=ep.LinearMotion(velocity=tuple(speed * out)))
    return ep.trace(scene, radar or array_radar(), num_rays=2000, max_bounces=1)


@pytest.mark.parametrize("steps", [{}, {"frequency_steps": [0.0, 2e6, 5e6], "bandwidth_steps": [0.0, 3e6]}])
@pytest.mark.parametrize("code", [dict(multiplexing="ddm"), dict(multiplexing="bpm"),
                                  dict(multiplexing="cdm", code_phases=np.pi * np.eye(3, 4)[::-1])])
def test_what_receivers_have_is_the_sum_of_the_transmitters_by_their_codes(code, steps):
    """All send the same chirp in a slot, with the steps of that slot."""
    radar = array_radar(num_chirps=8, **code, **steps)
    paths = plates(3.0, radar=radar)
    slots = 8 * radar.num_slots
    alone = [ep.synthesize(paths, build_radar([transmitter], radar.receivers, num_chirps=slots, **steps))
             for transmitter in radar.transmitters]
    slot = np.arange(slots)
    phases = {"ddm": lambda m: 2 * np.pi * m * slot / 4,
              "bpm": lambda m: np.pi * ((slot % 4 & m) % 3 != 0),  # rows 0 1 2 of the matrix of order 4
              "cdm": lambda m: np.where(slot % 4 == 2 - m, np.pi, 0.0)}[radar.multiplexing]
    expected = sum(np.exp(1j * phases(m))[:, None] * cube[0] for m, cube in enumerate(alone))
    cube = ep.synthesize(paths, radar)
    assert cube.shape == (1, NUM_RX, slots, 64)
    assert np.max(np.abs(cube[0] - expected)) < 1e-6 * np.max(np.abs(expected))  # the tolerance of each synthesis


def test_parts_of_real_samples_add_up_behind_a_code_of_phases():
    """By what came before the chirps of the whole: of parts alone it would be another."""
    random = np.random.default_rng(4)
    parts, code = random.normal(size=(2, 2, 1, 6, 32)) + 0j, np.exp(1j * random.random((2, 6)))
    whole = parts.sum(axis=0)
    coded = [code_signal(part, code, REAL, whole) for part in parts]
    assert sum(coded) == pytest.approx(code_signal(whole, code, REAL), abs=1e-10)


@pytest.mark.parametrize("multiplexing", ["ddm", "bpm"])
def test_a_scene_at_rest_comes_back_as_transmitters_that_take_turns_have_it(multiplexing):
    radar = array_radar(multiplexing)
    paths = plates(0.0, 0.0, radar=radar)
    turns = ep.synthesize(paths, array_radar())
    apart = ep.demultiplex(ep.synthesize(paths, radar), radar)
    assert apart.shape == turns.shape
    assert np.max(np.abs(apart - turns)) < SAME_STATIC * np.max(np.abs(turns))


def test_slots_in_a_row_become_the_chirps_of_their_transmitters():
    radar = array_radar(num_chirps=4)
    cube = ep.synthesize(plates(5.0, radar=radar), radar)
    row = np.stack([cube[slot % NUM_TX, :, slot // NUM_TX] for slot in range(4 * NUM_TX)], axis=1)[None]
    np.testing.assert_array_equal(ep.demultiplex(row, radar), cube)
    np.testing.assert_array_equal(ep.demultiplex(cube, radar), cube)


def strongest(cube, radar):
    spectrum = ep.range_doppler(cube, radar)
    power = np.mean(np.abs(spectrum.values) ** 2, axis=(0, 1))
    return spectrum, np.unravel_index(power.argmax(), power.shape)


@pytest.mark.parametrize("speed", [-14.0, -3.0, 2.5, 9.0, 13.0])
def test_empty_slots_tell_velocities_beyond_a_share_of_the_axis(speed):
    """+-16.1 m/s are unambiguous, a share of four is 8.1 m/s wide."""
    radar = array_radar("ddm", num_chirps=64)
    cube = ep.demultiplex(ep.synthesize(plates(speed, radar=radar), radar), radar)
    spectrum, cell = strongest(cube, radar)
    assert spectrum.velocity[cell[0]] == pytest.approx(speed, abs=radar.waveform.velocity_resolution())
    found = ep.estimate_angles(spectrum, radar, cells=[cell])
    assert found.azimuth[0] == pytest.approx(0.2, abs=0.02)


@pytest.mark.parametrize("speed", [-3.0, 2.2])
def test_moving_targets_keep_their_azimuth_through_signs(speed):
    radar = array_radar("bpm", num_chirps=64)
    assert abs(speed) < radar.waveform.max_velocity(4)
    cube = ep.demultiplex(ep.synthesize(plates(speed, radar=radar), radar), radar)
    spectrum, cell = strongest(cube, radar)
    assert spectrum.velocity[cell[0]] == pytest.approx(speed, abs=radar.waveform.velocity_resolution(4))
    assert ep.estimate_angles(spectrum, radar, cells=[cell]).azimuth[0] == pytest.approx(0.2, abs=0.02)


@pytest.mark.parametrize("turns", [0.1037, 0.23, -0.41])
def test_moving_targets_have_no_false_ones_at_the_highest_velocity_through_signs(turns):
    """Turns of a target's phase from chirp to chirp: at half a turn it had had another of itself, 40 to 48 dB below."""
    radar = build_radar([(0, m * HALF, 0) for m in range(NUM_TX)], num_chirps=64, num_samples=16, multiplexing="bpm")
    slot = np.arange(64 * 4)
    signs = np.where(((slot % 4)[:, None] & np.arange(NUM_TX)) % 3 == 0, 1.0, -1.0)  # columns of the matrix of order 4
    received = signs.sum(axis=1) * np.exp(2j * np.pi * turns * slot / 4)
    apart = ep.demultiplex(np.broadcast_to(received[:, None], (1, 1, 256, 16)), radar)
    spectrum = ep.range_doppler(apart, radar)
    cells = np.abs(np.arange(64) - 32 - 64 * turns)
    highest = np.abs(spectrum.values[:, 0, :, 0])
    assert np.max(highest[:, cells < 1], axis=1) == pytest.approx(1.0, abs=0.16)  # a peak between the cells
    assert np.max(highest[:, 0]) < 10.0 ** (-50 / 20)


def test_noise_keeps_its_level_and_its_false_alarms_through_doppler_division():
    radar = array_radar("ddm", num_chirps=64, num_samples=128)
    noise = ep.add_noise(np.zeros((1, NUM_RX, 64, 128)), radar, seed=3)
    spectrum = ep.range_doppler(ep.demultiplex(noise, radar), radar)
    plain = ep.range_doppler(ep.add_noise(np.zeros((NUM_TX, NUM_RX, 64, 128)), radar, seed=4), radar)
    levels = [10.0 * np.log10(np.mean(np.abs(one.values) ** 2)) for one in (spectrum, plain)]
    assert levels[0] == pytest.approx(levels[1], abs=0.2)
    rate = np.mean(ep.cfar(spectrum, radar, false_alarm_rate=1e-2).mask)
    assert 0.3e-2 < rate < 3e-2


@pytest.mark.parametrize("filters", [dict(low_pass=1.5e6, low_pass_poles=8), dict(low_pass=2.5e6, low_pass_poles=8),
                                     dict(high_pass=[0.8e6, 0.8e6])], ids=["low-pass", "other low-pass", "high-passes"])
def test_noise_behind_filters_keeps_its_false_alarms_through_doppler_division(filters):
    """What noise seemed to have of targets leaked into ranges of far less noise: 26, 13 and 3 times the alarms asked for."""
    radar = array_radar("ddm", num_chirps=64, num_samples=64, bandwidth=300e6, sampling_rate=6.4e6,
                        receiver=ep.Receiver(**filters))
    cubes = [ep.receive(np.zeros((1, NUM_RX, 64, 64)), radar, seed=seed).cube for seed in range(8)]
    found = [ep.cfar(ep.range_doppler(ep.demultiplex(cube, radar), radar), radar, false_alarm_rate=1e-3) for cube in cubes]
    assert 0.3e-3 < np.mean([one.mask for one in found]) < 2e-3


@pytest.mark.parametrize("num_tx, shares, num_rx", [(3, 4, 1), (3, 4, 4), (8, 10, 2)])
def test_noise_alone_seems_to_have_a_target_at_the_rate_that_is_promised(num_tx, shares, num_rx):
    random, chirps, samples = np.random.default_rng(11), 64 * shares, 128
    taper = np.outer(*(0.54 - 0.46 * np.cos(2.0 * np.pi * np.arange(count) / count) for count in (chirps, samples)))
    noise = random.standard_normal((2, num_rx, chirps, samples))
    power = doppler_division._smoothed_power(np.fft.fft2((noise[0] + 1j * noise[1]) * taper))
    limits = doppler_division._limits_of_noise(num_tx, shares, num_rx)
    rate = np.mean(doppler_division._found(power, num_tx, shares).is_target(limits))
    assert 0.6e-2 < rate < 1.2e-2


@pytest.mark.parametrize("velocities, ranges", [(16, 64), (4, 64), (64, 16)])
def test_transmitters_have_noise_of_their_own_in_empty_cells(velocities, ranges):
    """Eight, of which each takes another cell of a share's, whether it has more velocities or more ranges."""
    cells = np.arange(velocities * ranges).reshape(1, velocities, ranges)
    taken = np.sort([doppler_division._from_nearby(cells, tx) for tx in range(8)], axis=0)
    assert np.all(np.diff(taken, axis=0) > 0)
    places = [np.stack(divmod(doppler_division._from_nearby(cells, tx)[0], ranges)) for tx in range(8)]
    for first, second in itertools.combinations(places, 2):  # beyond the lobe of a cell along one axis, which are circles
        apart = np.abs(first - second)
        assert np.minimum(apart, np.array([velocities, ranges])[:, None, None] - apart).max(axis=0).min() >= doppler_division.LOBE


def test_cells_are_weighted_one_two_one_with_their_neighbours():
    cells = np.zeros((2, 8, 8), complex)
    cells[:, 0, 3] = 3.0, 4j
    smoothed = np.roll(doppler_division._smoothed_power(cells), (1, -2), (0, 1))
    np.testing.assert_allclose(smoothed[:3, :3], 25.0 * np.outer([1, 2, 1], [1, 2, 1]))
    assert smoothed.sum() == pytest.approx(16.0 * 25.0)


def ddm_tones(radar, shares, cells, snr_db):
    """Signal [1, rx, slot, sample] of targets at cells (turns of the frame, of a chirp), each that many dB above the noise of a
    cell of one transmitter and receiver by a rectangular window."""
    num_chirps, num_samples = radar.waveform.num_chirps, radar.waveform.num_samples
    slot, sample = np.arange(num_chirps)[:, None], np.arange(num_samples)
    amplitude = np.sqrt(10.0 ** (snr_db / 10) * ep.noise_power(radar, of="sample") / (num_chirps * num_samples))
    tones = sum(np.exp(2j * np.pi * ((velocity / num_chirps + m / shares) * slot + distance * sample / num_samples))
                for velocity, distance in cells for m in range(len(radar.transmitters)))
    return amplitude * np.broadcast_to(tones, (1, len(radar.receivers), num_chirps, num_samples))


def test_strong_targets_have_no_false_ones_beside_them_at_other_velocities():
    """Eight transmitters and two receivers: one of 5000 such targets would have a false alarm at its range by the rate asked
    for. Each had had three, of noise that was alike in all channels."""
    radar = build_radar([(0, 2 * m * HALF, 0) for m in range(8)], [(0, 0, 0), (0, HALF, 0)], num_chirps=160, num_samples=64,
                        multiplexing="ddm", empty_slots=2)
    cells = [(17 * k % 160 - 80, 6 + 6 * k) for k in range(9)]
    noisy = ep.add_noise(ddm_tones(radar, 10, cells, snr_db=30.0), radar, seed=2)
    found = ep.detect(ep.range_doppler(ep.demultiplex(noisy, radar), radar), radar)
    assert sorted(map(tuple, found.cells)) == sorted((velocity + 80, distance) for velocity, distance in cells)


@pytest.mark.parametrize("chirps_of_a_share", [16, 32, 64])
def test_false_echoes_of_strong_targets_lie_as_far_below_as_the_page_on_codes_says(chirps_of_a_share):
    """The page had said 60 dB for all."""
    page = (Path(__file__).parents[3] / "python/docs/how_do_i/radars/transmit_codes.md").read_text()
    told = re.search(rf"^\| 3 \| 1 \| {chirps_of_a_share} \| (\d+) \|", page, re.MULTILINE)
    radar = array_radar("ddm", num_chirps=4 * chirps_of_a_share, num_samples=32)
    below = []
    for velocity in np.random.default_rng(1).uniform(-0.5, 0.5, 30) * radar.waveform.num_chirps:
        tones = ddm_tones(radar, 4, [(velocity, 12)], snr_db=60.0)
        power = np.mean(np.abs(ep.range_doppler(ep.demultiplex(tones, radar), radar).values[..., 12]) ** 2, axis=(0, 1))
        power = np.roll(power, len(power) // 2 - power.argmax())
        elsewhere = np.abs(np.arange(len(power)) - len(power) // 2) > 7  # cells beyond the main lobe and the near sidelobes
        below.append(10.0 * np.log10(power.max() / power[elsewhere].max()))
    assert np.median(below) == pytest.approx(int(told[1]), abs=3.0)


def test_weak_targets_of_one_receiver_are_told_by_the_noise_at_their_range():
    """Most of the targets 16 dB above the noise had had others of themselves in the shares beside their own, 15 in all."""
    radar = build_radar([(0, 2 * m * HALF, 0) for m in range(3)], num_chirps=128, num_samples=64, multiplexing="ddm")
    cells = [(17 * k % 128 - 64, 6 + 6 * k) for k in range(9)]
    noisy = ep.add_noise(ddm_tones(radar, 4, cells, snr_db=16.0), radar, seed=2)
    found = ep.detect(ep.range_doppler(ep.demultiplex(noisy, radar), radar), radar)
    assert len(found.cells) <= len(cells) + 2
    for velocity, distance in cells:  # noise moves the largest cell of a weak target to its neighbour
        assert np.min(np.max(np.abs(found.cells - (velocity + 64, distance)), axis=1)) <= 1


def test_averaging_over_a_sign_code_lowers_the_noise_by_its_length():
    radar = array_radar("bpm", num_chirps=16)
    noise = ep.demultiplex(ep.add_noise(np.zeros((1, NUM_RX, 64, 64)), radar, seed=3), radar)
    one = ep.add_noise(np.zeros((NUM_TX, NUM_RX, 16, 64)), array_radar(num_chirps=16), seed=3)
    assert 10.0 * np.log10(np.mean(np.abs(one) ** 2) / np.mean(np.abs(noise) ** 2)) == pytest.approx(6.02, abs=0.2)


RANDOM_PHASES = np.random.default_rng(1).uniform(-np.pi, np.pi, (NUM_TX, 64))
WAYS_TO_SEND = {"tdm": {}, "bpm": dict(multiplexing="bpm"), "ddm": dict(multiplexing="ddm"),
                "cdm": dict(multiplexing="cdm", code_phases=RANDOM_PHASES),
                "staggered": dict(extra_idle=(0.0, 1e-6, 2e-6)), "hopping": dict(frequency_steps=(0.0, 1e6, 5e5)),
                "wider": dict(multiplexing="ddm", bandwidth_steps=(0.0, 1e6))}


@pytest.mark.parametrize("way", WAYS_TO_SEND)
def test_frames_have_labels_detections_and_angles_however_transmitters_send(way):
    scene, azimuths = ep.Scene(), {"near": 0.2, "far": -0.15}
    for name, distance, speed in (("near", 4.0, 0.0), ("far", 7.0, 3.0)):
        out = np.array([np.cos(azimuths[name]), np.sin(azimuths[name]), 0.0])
        scene.add(ep.actors.sphere(0.2), name=name, material=ep.Material.metal(), position=tuple(distance * out), smooth=True,
                  motion=ep.LinearMotion(velocity=tuple(speed * out)))
    radar = array_radar(num_chirps=64, transmit_power=0.1, chirp_interval=40e-6, **WAYS_TO_SEND[way])
    frame = ep.simulate(scene, radar, num_rays=2000, max_bounces=1, labels=True, detections=True, parts={"far": "T 'far' R"})
    labels, found = frame.labels["parts"], frame.detections
    seen = {one.name: one for one in labels.objects}
    assert seen["near"].cells > 0 and seen["far"].peak.velocity == pytest.approx(3.0, abs=0.7)
    for name, azimuth in azimuths.items():
        strongest = max(np.flatnonzero(found.object == name), key=lambda index: found.power[index])
        assert found.azimuth[strongest] == pytest.approx(azimuth, abs=0.02)
        assert found.part[strongest] == ("far" if name == "far" else "other")
    whole = sum(frame.parts["parts"].values())
    assert np.max(np.abs(whole - frame.cube)) < ROUNDING * np.max(np.abs(whole))
    again = ep.annotate_frame(frame)["parts"]
    np.testing.assert_array_equal(again.mask, labels.mask)
    assert [one.cells for one in again.objects] == [one.cells for one in labels.objects]


@pytest.mark.parametrize("receiver", [None, ep.Receiver(transmitter_gain_db=[0.0, 6.0, -3.0], receiver_gain_db=[2.0] * 4)])
def test_what_random_codes_leave_of_other_transmitters_has_a_name(receiver):
    """In the map of transmitter m the echoes of the others are turned by the difference of both codes."""
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.2), name="ball", material="metal", smooth=True, position=(4, 0.5, 0))
    radar = array_radar(num_chirps=64, transmit_power=10.0, receiver=receiver, **WAYS_TO_SEND["cdm"])
    frame = ep.simulate(scene, radar, num_rays=2000, max_bounces=1, labels=True, detections=True)
    gains = 10.0 ** (np.array([0.0, 6.0, -3.0] if receiver else [0.0] * NUM_TX) / 20.0)
    turns = np.exp(1j * (RANDOM_PHASES - RANDOM_PHASES[:, None]))  # [m, n, slot]
    turns[np.arange(NUM_TX), np.arange(NUM_TX)] = 0.0
    expected = ep.range_doppler(np.einsum("mnk,n,nrks->mrks", turns, gains, frame.cube), radar).values
    residue = frame.beside_spectra["residue"].values
    assert np.max(np.abs(residue - expected)) < ROUNDING * np.max(np.abs(expected))
    found, labels = frame.detections, frame.labels["parts"]
    of_ball = found.object == "ball"
    assert np.count_nonzero(of_ball) == 1 and found.velocity[of_ball] == pytest.approx([0.0], abs=0.3)
    assert len(found.part) > 8 and set(found.part[~of_ball]) == {"residue"} and not found.is_noise.any()
    power = np.mean(np.abs(expected) ** 2, axis=(0, 1)) / np.mean(gains ** 2)  # labels are of echoes without errors
    of_residue = labels.mask & (labels.dominant == labels.part_names.index("residue"))
    assert of_residue.sum() > 50 and np.all(power[of_residue] > 0.1 * labels.whole[of_residue])
    assert ep.detect(frame.spectrum, radar, paths=frame.paths).is_noise.sum() > 8  # without the name they are noise


@pytest.mark.parametrize(("code", "steps"), [("ddm", dict(bandwidth_steps=(0.0, 1e8, 0.0, 2e8))),
                                             ("ddm", dict(frequency_steps=(0.0, 2e8))),
                                             ("bpm", dict(frequency_steps=(0.0, 1e8, 3e8)))], ids=str)
def test_what_codes_leave_of_chirps_that_differ_has_a_name(code, steps):
    """Echoes and residue are all of the map but its noise."""
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.2), name="ball", material="metal", smooth=True, position=(4, 0.5, 0))
    radar = array_radar(num_chirps=64, transmit_power=10.0, multiplexing=code, **steps)
    frame = ep.simulate(scene, radar, num_rays=2000, max_bounces=1, labels=True, detections=True, guard=False)
    own, residue = ep.range_doppler(frame.cube, radar).values, frame.beside_spectra["residue"].values
    rest = np.mean(np.abs(frame.spectrum.values - own - residue) ** 2)
    assert rest == pytest.approx(ep.noise_power(radar), rel=0.1) and np.max(np.abs(residue) ** 2) > 1e3 * rest
    found, labels = frame.detections, frame.labels["parts"]
    assert "residue" in found.part and not found.is_noise.any()
    assert np.any(labels.mask & (labels.dominant == labels.part_names.index("residue")))


def test_parts_of_chirps_that_differ_are_those_of_their_paths_alone():
    radar = array_radar(num_chirps=6, frequency_steps=(0.0, 2e8), bandwidth_steps=(0.0, 0.0, 3e8))
    paths = plates(1.0, -2.0, radar=radar)
    parts = ep.decompose(paths, radar, {"near": "T 'ball0' R"})
    alone = ep.synthesize(paths.select("T 'ball0' R"), radar)
    whole = ep.synthesize(paths, radar)
    assert np.max(np.abs(parts["near"] - alone)) < 1e-6 * np.max(np.abs(alone))  # the tolerance of each synthesis
    assert np.max(np.abs(sum(parts.values()) - whole)) < 1e-6 * np.max(np.abs(whole))


def test_staggered_slots_begin_later_by_the_idle_times_before_them():
    radar = build_radar(num_chirps=6, extra_idle=(1e-6, 4e-6, 0.0))
    starts = [radar.waveform.slot_start(slot) for slot in range(6)]
    assert starts == pytest.approx([0, 61e-6, 125e-6, 185e-6, 246e-6, 310e-6], rel=1e-12)
    assert radar.frame_duration == pytest.approx(310e-6 + 63 / 20e6, rel=1e-12)
    assert chirps_duration(radar) == pytest.approx(radar.waveform.slot_start(6), rel=1e-12)
    assert chirp_period(radar) == pytest.approx(370e-6 / 6, rel=1e-12)
    speed, paths = 8.0, plates(8.0, radar=radar)
    phases = np.unwrap(np.angle(ep.synthesize(paths, radar)[0, 0, :, 32]))
    even = np.unwrap(np.angle(ep.synthesize(paths, build_radar(num_chirps=6))[0, 0, :, 32]))
    late = np.array(starts) - 60e-6 * np.arange(6)
    carrier = 77e9 + radar.waveform.slope * 32 / 20e6
    assert phases - even == pytest.approx(4 * np.pi * carrier * speed / C * late, abs=2e-3)


def test_steps_of_frequency_turn_each_chirp_by_the_delay():
    steps = (0.0, 2e6, -3e6)
    radar = build_radar(num_chirps=6, frequency_steps=steps)
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.05, 0.05), name="plate", material=ep.Material.metal(), position=(5, 0, 0))
    paths = ep.trace(scene, radar, num_rays=2000, max_bounces=1)
    cube = ep.synthesize(paths, radar)[0, 0, :, 32]
    turned = np.angle(cube / cube[0]) / (2 * np.pi)
    expected = np.resize(steps, 6) * 10.0 / C
    assert np.mod(turned - expected + 0.5, 1.0) - 0.5 == pytest.approx(0.0, abs=2e-4)  # a plate has some depth of delay


def test_steps_of_bandwidth_change_the_beat_frequency():
    radar = build_radar(num_chirps=2, num_samples=256, bandwidth_steps=(0.0, 2.5e8))
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.05, 0.05), name="plate", material=ep.Material.metal(), position=(10, 0, 0))
    cube = ep.synthesize(ep.trace(scene, radar, num_rays=2000, max_bounces=1), radar)[0, 0]
    beats = [np.polyfit(np.arange(256), np.unwrap(np.angle(chirp)), 1)[0] * 20e6 / (2 * np.pi) for chirp in cube]
    for beat, bandwidth in zip(beats, (1e9, 1.25e9)):
        assert beat == pytest.approx(bandwidth * 20e6 / 256 * 20.0 / C, rel=1e-4)


def test_codes_travel_with_their_radars(tmp_path):
    radar = array_radar("cdm", num_chirps=8, code_phases=[[0, 1], [2, 3], [4, 5.0]], extra_idle=[1e-6, 0])
    assert radar.replace(yaw=0.1).replace(yaw=0.0) == radar
    paths = plates(1.0, radar=radar)
    paths.save(tmp_path / "frame.h5")
    back = ep.Paths.load(tmp_path / "frame.h5").radar
    np.testing.assert_array_equal(back.code_phases, radar.code_phases)
    assert back.waveform == radar.waveform and back.multiplexing == "cdm"


@pytest.mark.parametrize("keywords, told", [
    (dict(multiplexing="cdm"), "code_phases: must be given for cdm"),
    (dict(code_phases=[[0.0]]), "code_phases: must be given for cdm"),
    (dict(multiplexing="cdm", code_phases=[[0.0]]), "code_phases: must have one row for each transmitter"),
    (dict(multiplexing="ddm", empty_slots=0), "empty_slots: must be"),
    (dict(extra_idle=(-1e-6,)), "extra_idle: must be finite and not negative"),
    (dict(frequency_steps=(-80e9,)), "frequency_steps: must"),
])
def test_bad_codes_are_refused_by_name(keywords, told):
    with pytest.raises(ValueError, match=f"^{told}"):
        array_radar(**keywords)


def test_what_cannot_be_taken_apart_is_refused():
    with pytest.raises(ValueError, match="^cube: must be of the shape"):
        ep.demultiplex(np.zeros((1, NUM_RX, 31, 64)), array_radar("bpm"))


def test_chirps_that_do_not_fit_a_code_are_refused_when_the_radar_is_made():
    with pytest.raises(ValueError, match="^waveform.num_chirps: must be a multiple of .* = 4, got 30"):
        array_radar("ddm", num_chirps=30)
    with pytest.raises(ValueError, match="^waveform.num_chirps: must be a multiple of .* = 5, got 32"):
        array_radar("ddm").replace(empty_slots=2)
    for code in (dict(multiplexing="ddm"), dict(multiplexing="cdm", code_phases=np.full((3, 2), 0.5))):
        with pytest.raises(ValueError, match="^waveform.real: must be False with a code of phases"):
            array_radar(real=True, **code)
    assert array_radar("cdm", real=True, code_phases=np.pi * np.eye(3)).waveform.real
    assert array_radar("bpm", num_chirps=30, real=True).num_slots == 4


def test_a_map_of_what_receivers_have_names_what_takes_it_apart():
    for code in ("ddm", "bpm"):
        radar = array_radar(code, num_chirps=16)
        cube = ep.synthesize(plates(0.0, radar=radar), radar)
        with pytest.raises(ValueError, match=r"^cube: .* ep.demultiplex\(cube, radar\)"):
            ep.range_doppler(cube, radar)
        assert ep.range_doppler(ep.demultiplex(cube, radar), radar).values.shape[0] == NUM_TX


def test_a_radar_says_what_its_transmitters_and_its_receiver_do():
    assert "ddm" not in repr(array_radar()) and "receiver with" not in repr(array_radar())
    told = repr(array_radar("ddm", receiver=ep.Receiver(iq_gain_db=1.0)))
    assert ", ddm, receiver with faults" in told


def test_frames_of_codes_and_faults_come_back_from_files_and_alone(tmp_path):
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.2), name="ball", material=ep.Material.metal(), smooth=True, position=(5, 0.5, 0),
              motion=ep.LinearMotion(velocity=(3.0, 0, 0)))
    faults = ep.Receiver(phase_noise=dict(offsets=[1e4, 1e6], levels=[-70, -90]), transmitter_gain_db=[0, 1.0, -1.0],
                         leakage_db=np.full((NUM_TX, NUM_RX), -50.0), leakage_delay=1e-9, adc=dict(bits=12, automatic_gain=True))
    radar = array_radar("bpm", num_chirps=8, receiver=faults)
    sequence = ep.Sequence(scene, radar, frames=2, interval=0.05, num_rays=1000, max_bounces=1, guard=False)
    first, second = list(sequence)
    np.testing.assert_array_equal(sequence[1].noisy_cube, second.noisy_cube)
    assert not np.array_equal(first.noisy_cube, second.noisy_cube)
    ep.save_frame(second, tmp_path / "second.h5")
    back = ep.load_frame(tmp_path / "second.h5")
    assert back.radar == radar
    np.testing.assert_array_equal(back.coded_cube, second.coded_cube)
    np.testing.assert_array_equal(back.received.codes, second.received.codes)
    np.testing.assert_array_equal(back.spectrum.values, second.spectrum.values)
    # The error of a transmitter's gain is there after its code is undone, and the ideal signal has none.
    quiet = ep.receive(second.coded_cube, radar.replace(receiver=None), seed=None).cube
    apart = ep.demultiplex(quiet, radar)
    ratio = np.sum(np.abs(apart) ** 2, axis=(1, 2, 3)) / np.sum(np.abs(second.cube) ** 2, axis=(1, 2, 3))
    assert 10 * np.log10(ratio) == pytest.approx([0.0, 1.0, -1.0], abs=0.1)


@pytest.mark.parametrize("num_tx, empty, num_chirps", [(3, 1, 32), (2, 2, 16), (2, 1, 15)])
def test_what_looks_at_one_antenna_takes_any_radar_that_sends_at_once(num_tx, empty, num_chirps, tmp_path):
    """Its chirps are whole turns of all transmitters, and not of one."""
    radar = build_radar([(0, 4 * m * HALF, 0) for m in range(num_tx)], [(0, 0, 0), (0, HALF, 0)], num_chirps=num_chirps,
                        num_samples=64, multiplexing="ddm", empty_slots=empty, transmit_power=1.0)
    in_turn = build_radar(radar.transmitters, radar.receivers, num_chirps=num_chirps, num_samples=64, transmit_power=1.0)
    still, turns = plates(0.0, radar=radar), plates(0.0, radar=in_turn)
    assert np.array_equal(still.power, turns.power)
    assert ep.received_power(still).power == ep.received_power(turns).power > 0.0
    paths = plates(3.0, radar=radar)
    assert ep.validity(paths, radar).num_paths == paths.num_paths
    paths.save(tmp_path / "paths.h5")
    frame = ep.simulate(paths.scene, radar, num_rays=2000, max_bounces=1, labels=True, detections=True, truth=True,
                        retrace="invalid", keyframes=0)
    assert set(frame.detections.object) == {"ball0"}


def sent_at_once(radar, turn: float):
    """(signal [1, rx, chirp, S] of a tone that turns by so many rad a chirp, [tx, rx, chirp, S] of each transmitter alone)."""
    shares = len(radar.transmitters) + radar.empty_slots
    chirps, samples = np.arange(radar.waveform.num_chirps)[:, None], np.arange(radar.waveform.num_samples)
    factors = np.exp(1j * np.arange(NUM_TX))[:, None, None, None]
    apart = factors * np.exp(1j * (turn * chirps + 1.3 * samples))[None, None] * np.ones((1, NUM_RX, 1, 1))
    shifts = np.exp(2j * np.pi * np.arange(NUM_TX)[:, None] * chirps[:, 0] / shares)
    return np.sum(apart * shifts[:, None, :, None], axis=0)[None], apart


@pytest.mark.parametrize("turn", np.linspace(0.05, 6.2, 9))
def test_four_chirps_to_a_share_are_enough_for_transmitters_to_come_apart(turn):
    radar = array_radar("ddm", num_chirps=4 * (NUM_TX + 1), num_samples=32)
    signal, apart = sent_at_once(radar, turn)
    window = np.outer(np.hanning(16), np.hanning(32))
    found, true = (np.fft.fft2(cube * window) for cube in (ep.demultiplex(signal, radar), apart))
    assert np.abs(found - true).max() < 0.03 * np.abs(true).max()


def test_fewer_chirps_to_a_share_are_told():
    radar = array_radar("ddm", num_chirps=3 * (NUM_TX + 1), num_samples=32)
    rule = r"radar.waveform.num_chirps: should be 16 or more, 4 for each of 4 shares .* got 12"
    with pytest.warns(RuntimeWarning, match=rule) as told:
        ep.demultiplex(sent_at_once(radar, 1.0)[0], radar)
    assert told[0].filename == __file__
