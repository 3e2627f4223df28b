"""Detections: places of targets in closed form, labels of known parts, the paths behind a cell against their own signal."""
from __future__ import annotations

import csv
import dataclasses

import numpy as np
import pytest

import echopath as ep
from echopath.cli import report
from echopath.paths.resolution import Interval
from support.scenes.small_spheres import RADIUS, TARGETS, WAVELENGTH, at, nearest, radar_with, scene_of

# Cells; what remains of tones in closed form is 1e-6, a sphere's footprint and the noise at 30 dB add the rest.
PLACE = 0.05
BEARING = 0.01        # rad: a 25th of a beam of eight antennas
ROUNDING = 1e-9       # m, of places from ranges and angles
LEVEL_DB = 0.5        # of peaks between cells, over noise; 0.1 found
NOISE_DB = 1.0        # of the noise about a target 48 dB above it, of whose skirts there is some; 0.7 found
SLOT_BEARING = 5e-4   # rad; 2e-4 found: the phase left between slots made 5e-3 of a speed half a cell beside the cell's
SPEED = 0.01          # m/s: with noise 30 dB below; 0.001 found
SHIFT_LEFT = 0.005    # m: of the 18 mm by which a speed of 9 m/s shifts the range
KNOWN = Interval(1.0, 0.99, 1.01)  # W


def test_targets_are_found_once_where_they_are_and_with_their_speed(spheres):
    radar, _, spectrum = spheres
    found = ep.detect(spectrum, radar)
    assert len(found) == len(TARGETS)
    middle = 0.5 * radar.frame_duration
    step = spectrum.range[1], spectrum.velocity[1] - spectrum.velocity[0]
    for name, (distance, azimuth, speed) in TARGETS.items():
        i = nearest(found, name)
        assert found.range[i] == pytest.approx(distance + speed * middle, abs=PLACE * step[0])
        assert found.velocity[i] == pytest.approx(speed, abs=PLACE * step[1])
        assert found.azimuth[i] == pytest.approx(azimuth, abs=BEARING) and np.isnan(found.elevation[i])
        expected = at(found.range[i], found.azimuth[i]) + [0, 3.5 * WAVELENGTH / 4, 0]  # from the middle of the antennas
        np.testing.assert_allclose(found.points[i], expected, atol=ROUNDING)
    assert set(found.part) == set(found.object) == {""} and np.isnan(found.share).all()


def test_power_is_what_the_radar_equation_gives(spheres):
    """Pt G^2 lambda^2 sigma / ((4 pi)^3 R^4), sigma = pi a^2, wherever between the cells the target lies."""
    radar, _, spectrum = spheres
    found = ep.detect(spectrum, radar)
    for name, (distance, _, speed) in TARGETS.items():
        range_now = distance + speed * 0.5 * radar.frame_duration
        expected = radar.transmit_power * WAVELENGTH ** 2 * np.pi * RADIUS ** 2 / ((4 * np.pi) ** 3 * range_now ** 4)
        i = nearest(found, name)
        assert 10 * np.log10(found.power[i] / expected) == pytest.approx(0.0, abs=LEVEL_DB), name
        assert found.snr_db[i] == pytest.approx(10 * np.log10(expected / ep.noise_power(radar)), abs=NOISE_DB), name


@pytest.mark.parametrize("speed", [-16.0, -3.0, 5.0, 11.0])
def test_two_chirps_tell_velocities_between_their_two_cells(speed):
    """Each is the neighbour of the other on both sides; 11 m/s are shown less the span of the axis."""
    chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=500e6, num_samples=128, sampling_rate=10e6, num_chirps=2,
                              chirp_interval=50e-6)
    radar, span = ep.Radar(chirps, transmitters=[ep.Antenna()], receivers=[ep.Antenna()]), 2 * chirps.max_velocity()
    cube = ep.point_targets(radar, positions=[(12, 0, 0)], velocities=(speed, 0, 0), rcs=1e5)
    found = ep.detect(ep.range_doppler(ep.add_noise(cube, radar, seed=1), radar, "rect"), radar)
    strongest = found.power.argmax()
    assert np.remainder(found.velocity[strongest] - speed + 0.5 * span, span) == pytest.approx(0.5 * span, abs=0.1)
    expected = radar.transmit_power * (ep.speed_of_light / 77.25e9) ** 2 * 1e5 / ((4 * np.pi) ** 3 * 12 ** 4)
    assert 10 * np.log10(found.power[strongest] / expected) == pytest.approx(0.0, abs=0.1)


def test_parts_label_their_own_targets(spheres):
    radar, paths, spectrum = spheres
    parts = ep.decompose(paths, radar, {name: f"T '{name}' R" for name in list(TARGETS)[:2]})
    found = ep.detect(spectrum, radar, parts=parts)
    of_maps = ep.detect(spectrum, radar, parts={name: ep.range_doppler(cube, radar) for name, cube in parts.items()})
    for name, part in zip(TARGETS, ["near", "middle", "other"]):
        i = nearest(found, name)
        assert found.part[i] == part and found.share[i] > 0.99
    assert np.array_equal(found.part, of_maps.part) and np.array_equal(found.share, of_maps.share)


@pytest.fixture(scope="module")
def beside_a_tone(spheres):
    """(cube of a tone of another radar, map of it, echoes and noise): faint beside the targets' echoes and 30 dB above the noise
    in a cell of its own."""
    radar, paths, _ = spheres
    place = 2.0 * np.pi * np.add.outer(0.25 * np.arange(radar.waveform.num_chirps), 0.6 * np.arange(radar.waveform.num_samples))
    echoes = ep.synthesize(paths, radar)
    other = np.broadcast_to(np.sqrt(1e3 * ep.noise_power(radar)) * np.exp(1j * place), echoes.shape)
    return other, ep.range_doppler(ep.add_noise(echoes + other, radar, seed=1), radar)


@pytest.mark.parametrize("with_paths", [False, True])
def test_what_no_path_makes_has_the_cells_where_it_is_the_most(spheres, beside_a_tone, with_paths):
    (radar, paths, _), (other, spectrum) = spheres, beside_a_tone
    found = ep.detect(spectrum, radar, beside={"interference": other}, paths=paths if with_paths else None)
    by_range = np.argsort(found.range)
    assert found.part[by_range].tolist() == [""] * len(TARGETS) + ["interference"]
    assert found.share[by_range[-1]] > 0.99 and np.isnan(found.share[by_range[:-1]]).all() and not found.is_noise.any()
    assert found.range.max() == pytest.approx(0.6 * radar.waveform.max_range, abs=0.1)


@pytest.mark.parametrize("with_paths, beams", [(False, False), (True, False), (True, True)])
def test_what_no_path_makes_has_its_cells_beside_labels_too(spheres, beside_a_tone, with_paths, beams):
    (radar, paths, _), (other, spectrum) = spheres, beside_a_tone
    labels = ep.annotate(paths, {"near": "T 'near' R"})
    found = ep.detect(spectrum, radar, labels=labels, beside={"interference": other}, paths=paths if with_paths else None,
                      beams=beams)
    at_the_tone = found.range > 0.5 * radar.waveform.max_range
    assert np.count_nonzero(at_the_tone) == 1 and found.part[at_the_tone] == "interference" and found.share[at_the_tone] > 0.99
    assert not found.is_noise.any() and sorted(found.object) == ["", *sorted(TARGETS)]
    assert found.part[nearest(found, "near")] == "near"


@pytest.mark.parametrize("name", ["interference", "jammer"])
def test_cells_that_no_path_makes_the_most_of_are_of_no_object(spheres, name):
    """A repeater that sends ten times the echoes has 100 / 101 of their power, whatever it is called."""
    radar, paths, _ = spheres
    echoes = ep.synthesize(paths, radar)
    spectrum = ep.range_doppler(ep.add_noise(echoes + 10j * echoes, radar, seed=1), radar)
    found = ep.detect(spectrum, radar, beside={name: 10j * echoes}, paths=paths)
    assert set(found.part) == {name} and set(found.object) == {""}
    np.testing.assert_allclose(found.share, 100.0 / 101.0, atol=0.01)


def test_labels_of_cells_are_taken_over(spheres):
    """Parts by their powers, objects and ghosts by the maps of their indices."""
    radar, _, spectrum = spheres
    bare = ep.detect(spectrum, radar)
    shape = spectrum.values.shape[2:]
    power, object_map, ghost_map = np.zeros((2, *shape)), np.full(shape, -1), np.full(shape, -1)
    near, middle, _ = (tuple(bare.cells[nearest(bare, name)]) for name in TARGETS)
    for cell, shares in ((near, (0.75, 0.25)), (middle, (0.1, 0.9))):  # the third has no echo at all
        power[(slice(None), *cell)] = np.array(shares) * ep.cfar(spectrum, radar).power[cell]
    object_map[near], ghost_map[middle] = 1, 0
    looks = {"cells": 1, "power": 1.0, "peak": None, "box": None, "received": KNOWN}
    objects = [ep.ObjectLabel(name=name, status="seen", visible_share=1.0, occluders={}, **looks) for name in ("other", "car")]
    ghosts = [ep.GhostLabel(object="walker", ghost_type=2, order=3, via=("wall",), class_code=124, **looks)]
    everywhere = np.ones(shape, bool)
    labels = ep.Labels(plane="range_doppler", velocity=spectrum.velocity, azimuth=None, range=spectrum.range,
                       part_names=["a", "b"], power=power, whole=power.sum(axis=0), share=power, dominant=object_map,
                       noise_power=1.0, noise_margin_db=10.0, dynamic_range_db=60.0, above_noise=everywhere, mask=everywhere,
                       objects=objects, object_map=object_map, ghosts=ghosts, ghost_map=ghost_map, seed=1)
    found = ep.detect(spectrum, radar, labels=labels)
    by_name = {name: i for i, name in ((nearest(found, name), name) for name in TARGETS)}
    columns = ("part", "object", "ghost_type", "order", "class_code")
    assert [tuple(getattr(found, column)[by_name[name]] for column in columns) for name in TARGETS] == [
        ("a", "car", 0, 1, 111), ("b", "walker", 2, 3, 124), ("noise", "", 0, 0, 0)]
    assert found.share[by_name["near"]] == pytest.approx(0.75) and found.share[by_name["middle"]] == pytest.approx(0.9)
    with pytest.raises(ValueError, match="labels: must be of the spectrum"):
        ep.detect(spectrum, radar, labels=dataclasses.replace(labels, plane="range_azimuth"))
    with pytest.raises(TypeError, match="labels: must be Labels, got "):
        ep.detect(spectrum, radar, labels=dataclasses.asdict(labels))


def test_a_false_alarm_is_called_noise(spheres):
    radar, paths, spectrum = spheres
    parts = ep.decompose(paths, radar, {"near": "T 'near' R"})
    found = ep.detect(spectrum, radar, false_alarm_rate=0.01, paths=paths, parts=parts)
    is_noise = found.is_noise
    assert np.array_equal(is_noise, found.part == "noise") and f"{is_noise.sum()} of noise alone" in repr(found)
    assert is_noise.sum() > 30 and (~is_noise).sum() >= len(TARGETS)
    i = int(np.flatnonzero(is_noise)[0])
    assert found.object[i] == "" and found.order[i] == 0 and np.isnan(found.share[i]) and len(found.paths(i)[0]) == 0
    assert not is_noise[[nearest(found, name) for name in TARGETS]].any()


def test_a_part_may_be_called_noise(spheres, tmp_path):
    """It is told from noise by is_noise: in the paths behind it, the table and the report."""
    radar, paths, spectrum = spheres
    found = ep.detect(spectrum, radar, paths=paths, parts=ep.decompose(paths, radar, {"noise": "T 'near' R"}))
    i = nearest(found, "near")
    assert found.part[i] == "noise" and not found.is_noise.any() and len(found.paths(i)[0]) and "1 noise" in repr(found)
    found.to_csv(tmp_path / "points.csv")
    with open(tmp_path / "points.csv", encoding="utf-8", newline="") as stream:
        assert [row["is_noise"] for row in csv.DictReader(stream)] == ["0"] * len(found)
    assert report.detections(found, {})[-1].split()[-1] == "0"


def test_objects_and_ghosts_are_those_of_the_paths():
    """A metal wall beside a sphere: the direct echo, the pair over the wall one way, and the echo over it both ways."""
    radar = radar_with(num_samples=512)
    scene = scene_of({"ball": (10.0, 0.0, 0.0)})
    scene.add(ep.actors.wall(40, 6), name="wall", material=ep.materials["metal"].replace(mirror=True), position=(15, 3, 0))
    paths = ep.trace(scene, radar, num_rays=20_000, max_bounces=3)
    spectrum = ep.range_doppler(ep.add_noise(ep.synthesize(paths, radar), radar, seed=1), radar)
    found = ep.detect(spectrum, radar, paths=paths, objects=["ball"])
    image = np.hypot(10.0 + RADIUS, 6.0) - RADIUS  # m, distance of the sphere's mirror image
    for distance, ghost_type, order in ((10.0, 0, 1), (0.5 * (10.0 + image), None, 2), (image, 2, 3)):
        i = int(np.argmin(np.abs(found.range - distance)))
        assert found.range[i] == pytest.approx(distance, abs=0.08)  # m: half a cell, the pair's points of reflection differ
        assert found.object[i] == "ball" and found.order[i] == order
        assert ghost_type is None or found.ghost_type[i] == ghost_type
    assert found.ghost_type[np.argmin(np.abs(found.range - 0.5 * (10.0 + image)))] in (1, 2)


@pytest.mark.parametrize("parts", [None, {"late": "T 'late' R"}])
def test_what_a_renewed_frame_sees_before_and_after_its_middle_is_detected_as_itself(parts):
    """A screen goes past before a ball, and hides it when the frame is traced."""
    radar, scene = radar_with(), scene_of({"seen": (11.0, 0.3, 0.0), "late": (6.3, -0.3, 0.0)})
    speed = 1.0 / radar.frame_duration
    scene.add(ep.actors.plate(0.3, 0.3), name="screen", material="wood", position=at(3.0, -0.3) - (0.0, 0.5, 0.0), yaw=np.pi,
              motion=ep.LinearMotion((0.0, speed, 0.0)))
    frame = ep.simulate(scene, radar, num_rays=3000, max_bounces=1, parts=parts, retrace="always", keyframes=8, detections=True,
                        guard=False)
    found = frame.detections
    assert frame.paths.select("T 'late' R").num_paths == 0
    for name, distance in (("seen", 11.0), ("late", 6.3)):
        near = np.abs(found.range - distance) < 0.3  # m, two cells
        assert near.any() and np.all(found.object[near] == name) and not found.is_noise[near].any()
        assert parts is None or np.all(found.part[near] == ("late" if name == "late" else "other"))


def test_several_targets_of_a_cell_have_directions_of_their_own():
    radar = radar_with(receivers=16)
    targets = {"left": (10.0, 0.4, 0.0), "right": (10.0, -0.4, 0.0)}
    paths = ep.trace(scene_of(targets), radar, num_rays=4000, max_bounces=1)
    spectrum = ep.range_doppler(ep.add_noise(ep.synthesize(paths, radar), radar, seed=1), radar)
    found = ep.detect(spectrum, radar, angles={"max_peaks": 2, "peak_range_db": 6.0})
    assert len(found) == 2 and np.array_equal(found.cells[0], found.cells[1])
    np.testing.assert_allclose(sorted(found.azimuth), [-0.4, 0.4], atol=2 * BEARING)


def test_folds_give_the_velocity_and_the_range_without_its_shift():
    radar = radar_with(receivers=4, transmitters=3, num_samples=512, chirp_interval=60e-6)  # +-5.4 m/s
    speed = 9.0
    paths = ep.trace(scene_of({"ball": (9.0, 0.1, speed)}), radar, num_rays=3000, max_bounces=1)
    spectrum = ep.range_doppler(ep.add_noise(ep.synthesize(paths, radar), radar, seed=1), radar)
    found = ep.detect(spectrum, radar, angles={"folds": 1})
    i = int(found.power.argmax())
    assert found.velocity[i] == pytest.approx(speed, abs=SPEED)
    assert found.range[i] == pytest.approx(9.0 + speed * 0.5 * radar.frame_duration, abs=SHIFT_LEFT)


@pytest.mark.parametrize("method", ["bartlett", "capon"])
@pytest.mark.parametrize("folds", [0, 1])
@pytest.mark.parametrize("beside", [0.0, 0.25, 0.49, 0.75])
@pytest.mark.parametrize("extra_idle", [(), (2e-6, 24e-6, 0.0)], ids=["even", "staggered"])
def test_targets_that_move_between_slots_are_where_they_are_whatever_their_speed_in_the_cell(extra_idle, beside, folds, method):
    """Between even slots a target turns by 2 pi beside / (3 * 16) more than its cell's middle, as half a wavelength would."""
    radar = radar_with(receivers=4, transmitters=3, num_chirps=16, chirp_interval=25e-6)
    radar = radar.replace(waveform=radar.waveform.replace(extra_idle=extra_idle))
    radar = radar.replace(transmit_power=1e3 * radar.transmit_power)  # what noise adds to directions is below the tolerance
    speed = (3 + beside) * radar.waveform.velocity_resolution(3) + 2 * folds * radar.waveform.max_velocity(3)
    paths = ep.trace(scene_of({"ball": (12.0, 0.35, speed)}), radar, num_rays=3000, max_bounces=1)
    spectrum = ep.range_doppler(ep.add_noise(ep.synthesize(paths, radar), radar, seed=1), radar)
    before = spectrum.values.copy()
    found = ep.detect(spectrum, radar, angles={"folds": folds, "method": method})
    x, y, _ = at(12.0, 0.35) - [0.0, 0.5 * 5.5 * 0.5 * WAVELENGTH, 0.0]  # from the middle of the virtual array
    i = int(found.power.argmax())
    assert found.azimuth[i] == pytest.approx(np.arctan2(y, x), abs=SLOT_BEARING)
    assert found.velocity[i] == pytest.approx(speed, abs=SPEED) and np.array_equal(spectrum.values, before)


def test_transmitters_that_send_at_once_have_no_slots_to_turn():
    """Half a cell beside a cell's middle, divided by Doppler."""
    turns = radar_with(receivers=4, transmitters=3, num_chirps=16, chirp_interval=25e-6)
    radar = turns.replace(multiplexing="ddm")
    speed = 2.49 * radar.waveform.velocity_resolution(radar.num_slots)
    paths = ep.trace(scene_of({"ball": (12.0, 0.35, speed)}), radar, num_rays=3000, max_bounces=1)
    cube = ep.demultiplex(ep.add_noise(ep.synthesize(paths, radar), radar, seed=1), radar)
    spectrum = ep.range_doppler(cube, radar)
    found = ep.detect(spectrum, radar)
    of_cells = ep.estimate_angles(spectrum, radar, cells=found.cells)
    assert len(found) and np.array_equal(found.azimuth, of_cells.azimuth)


@pytest.mark.parametrize("real, beat, speed, expected", [
    (False, -0.3, 0.0, 0.0), (False, 0.3, 0.0, 0.3), (False, 0.0, 4.0, 0.0), (False, 254.7, 0.0, 254.7),
    (True, 0.0, 4.0, 0.0), (True, 5.3, 0.0, 5.3)])
def test_no_detection_is_nearer_than_the_antennas(real, beat, speed, expected):
    """Tones in closed form; beat and expected range in cells, a speed in m/s shifts an echo by carrier * speed / slope."""
    radar = radar_with(receivers=4)
    chirps = radar.waveform.replace(real=real)
    radar = radar.replace(waveform=chirps)
    sample, chirp = np.arange(chirps.num_samples), np.arange(chirps.num_chirps)[:, None]
    turns = beat * sample / chirps.num_samples + 2.0 * speed / WAVELENGTH * chirp * chirps.chirp_interval
    tone = 1e-3 * np.exp(2j * np.pi * turns)
    cube = np.broadcast_to(tone.real if real else tone, (1, 4, *tone.shape))
    spectrum = ep.range_doppler(ep.add_noise(cube, radar, seed=1), radar)
    found = ep.detect(spectrum, radar)
    i = int(found.power.argmax())
    assert abs(found.velocity[i]) == pytest.approx(speed, abs=SPEED) and found.range.min() >= 0.0
    assert found.range[i] == pytest.approx(expected * spectrum.range[1], abs=PLACE * spectrum.range[1])


def test_one_antenna_gives_no_directions():
    radar = radar_with(receivers=1)
    spectrum = ep.range_doppler(ep.add_noise(np.zeros((1, 1, 64, 256), complex), radar, seed=1), radar)
    found = ep.detect(spectrum, radar, false_alarm_rate=1e-3)
    assert len(found) and np.isnan(found.azimuth).all() and np.isnan(found.points).any()
    with pytest.raises(ValueError, match="^detections: must have azimuths, which the radar's antennas cannot tell"):
        ep.track([found], [0.0])


def test_a_fast_radar_finds_what_stands_where_it_is_by_the_turns_of_its_transmitters():
    """-25 m/s cos(azimuth), beyond the +-13 m/s of three transmitters in turns, of which the map shows another."""
    drive, bearings = 25.0, {"left": 0.7, "ahead": 0.1, "right": -0.5}
    radar = radar_with(receivers=4, transmitters=3, num_chirps=32, chirp_interval=25e-6).replace(speed=drive)
    scene = scene_of({name: (8.0 + 3.0 * k, azimuth, 0.0) for k, (name, azimuth) in enumerate(bearings.items())})
    frame = ep.simulate(scene, radar, num_rays=1_000, detections={"folds": 1}, guard=False)
    for found in (frame.detections, ep.detect_frame(frame, folds=1)):
        assert sorted(found.object) == sorted(bearings)
        for name, azimuth in bearings.items():
            i = list(found.object).index(name)
            assert found.velocity[i] == pytest.approx(-drive * np.cos(azimuth), abs=0.2)
            assert found.azimuth[i] == pytest.approx(azimuth, abs=0.02)  # it comes nearer by 3 cm until the middle of the frame
    axes = frame.plot()  # points are on the map, whose velocities end before theirs
    shown = np.concatenate([points.get_offsets()[:, 1] for points in axes.collections])
    echoes = np.sort(frame.spectrum.velocity[frame.detections.cells[:, 0]])
    np.testing.assert_allclose(np.sort(shown), echoes, atol=0.5 * (frame.spectrum.velocity[1] - frame.spectrum.velocity[0]))
    for call in (lambda: ep.detect_frame(frame, folds=2), lambda: ep.simulate(scene, radar, detections={"folds": 2})):
        with pytest.raises(ValueError, match="^folds: must be 0, or less than half of the 3 slots in which .*, got 2"):
            call()
