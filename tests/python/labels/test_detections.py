"""Detections: places of targets in closed form, labels of known parts, the paths behind a cell against their own signal."""
from __future__ import annotations

import csv
import dataclasses
import warnings

import numpy as np
import pytest

import echopath as ep
from echopath.cli import report
from echopath.detections.echo_fields import Response
from echopath.paths.resolution import Interval
from support.radars import build_radar
from support.shapes import lambert

C = ep.speed_of_light
WAVELENGTH = C / 77.5e9
POWER = 300.0  # W, for small spheres and isotropic antennas
RADIUS = 0.05  # m, of spheres that stand for points: their echo comes from the nearest point of them
# Cells; what remains of tones in closed form is 1e-6, a sphere's footprint and the noise at 30 dB add the rest.
PLACE = 0.05
TABLE = 0.006  # of the peak: straight lines between the steps of the table
NEAREST_SWEEP = 0.04  # of the peak: 0.1 rad at the ends of the frame, where it is most, averaged over the frame
MODEL = 0.1    # of fields: the third derivative of a length, and the first antennas' states for all chirps
HELD = 0.95    # of a cell's power, by the paths named
BEARING = 0.01        # rad: a 25th of a beam of eight antennas
ROUNDING = 1e-9       # m, of places from ranges and angles
LEVEL_DB = 0.5        # of peaks between cells, over noise; 0.1 found
SPEED = 0.01          # m/s: with noise 30 dB below; 0.001 found
SHIFT_LEFT = 0.005    # m: of the 18 mm by which a speed of 9 m/s shifts the range


def radar_with(receivers=8, transmitters=1, num_chirps=64, num_samples=256, chirp_interval=50e-6,
               spacing=0.5 * WAVELENGTH):
    return build_radar([(0, k * receivers * spacing, 0) for k in range(transmitters)],
                       [(0, k * spacing, 0) for k in range(receivers)], num_chirps=num_chirps, num_samples=num_samples,
                       chirp_interval=chirp_interval, transmit_power=POWER)


def at(distance, azimuth):
    return distance * np.array([np.cos(azimuth), np.sin(azimuth), 0.0])


KNOWN = Interval(1.0, 0.99, 1.01)  # W
TARGETS = {"near": (6.3, 0.35, 4.0), "middle": (11.1, -0.2, -2.5), "far": (16.4, 0.1, 0.0)}  # m, rad, m/s outward


def scene_of(targets):
    scene = ep.Scene()
    for name, (distance, azimuth, speed) in targets.items():
        scene.add(ep.actors.sphere(RADIUS), name=name, material="metal", smooth=True,
                  position=tuple(at(distance + RADIUS, azimuth)),
                  motion=ep.LinearMotion(velocity=tuple(at(speed, azimuth))))
    return scene


@pytest.fixture(scope="module")
def spheres():
    """(radar, paths, spectrum with noise) of three spheres at known places and speeds."""
    radar = radar_with()
    paths = ep.trace(scene_of(TARGETS), radar, num_rays=6000, max_bounces=1)
    return radar, paths, ep.range_doppler(ep.add_noise(ep.synthesize(paths, radar), radar, seed=1), radar)


def nearest(found, name):
    distance, _, speed = TARGETS[name]
    return int(np.argmin(np.abs(found.range - distance) + np.abs(found.velocity - speed)))


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
        assert found.snr_db[i] > 25.0
    assert set(found.part) == set(found.object) == {""} and np.isnan(found.share).all()


def test_power_is_what_the_radar_equation_gives(spheres):
    """Pt G^2 lambda^2 sigma / ((4 pi)^3 R^4), sigma = pi a^2, wherever between the cells the target lies."""
    radar, _, spectrum = spheres
    found = ep.detect(spectrum, radar)
    for name, (distance, _, speed) in TARGETS.items():
        range_now = distance + speed * 0.5 * radar.frame_duration
        expected = radar.transmit_power * WAVELENGTH ** 2 * np.pi * RADIUS ** 2 / ((4 * np.pi) ** 3 * range_now ** 4)
        assert 10 * np.log10(found.power[nearest(found, name)] / expected) == pytest.approx(0.0, abs=LEVEL_DB), name


def test_parts_label_their_own_targets(spheres):
    radar, paths, spectrum = spheres
    parts = ep.decompose(paths, radar, {name: f"T '{name}' R" for name in list(TARGETS)[:2]})
    found = ep.detect(spectrum, radar, parts=parts)
    of_maps = ep.detect(spectrum, radar, parts={name: ep.range_doppler(cube, radar) for name, cube in parts.items()})
    for name, part in zip(TARGETS, ["near", "middle", "other"]):
        i = nearest(found, name)
        assert found.part[i] == part and found.share[i] > 0.99
    assert np.array_equal(found.part, of_maps.part) and np.array_equal(found.share, of_maps.share)


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
    assert report.detections(found)[-1].split()[-1] == "0"


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


def synthesised_power(paths, chosen, radar, spectrum, cell):
    """Power in W of the chosen paths alone in a cell, mean over channels."""
    mask = np.zeros(paths.num_paths, bool)
    mask[chosen] = True
    cube = ep.synthesize(paths.select(mask), radar)
    part = ep.range_doppler(cube, radar, window=spectrum.window, zero_pad=spectrum.zero_pad)
    return np.mean(np.abs(part.values[:, :, cell[0], cell[1]]) ** 2)


def expect_paths_hold(found, paths, radar, spectrum, i):
    """Synthesised alone they make the cell, and all others little of it."""
    index, share = found.paths(i)
    assert len(index) and np.all(np.diff(share) <= 0.0) and 0.99 < share.sum() <= 1.0 + 1e-12
    whole = synthesised_power(paths, np.arange(paths.num_paths), radar, spectrum, found.cells[i])
    others = np.setdiff1d(np.arange(paths.num_paths), index)
    assert synthesised_power(paths, index, radar, spectrum, found.cells[i]) == pytest.approx(whole, rel=1.0 - HELD, abs=0)
    assert synthesised_power(paths, others, radar, spectrum, found.cells[i]) < (1.0 - HELD) * whole
    return index


def test_the_paths_behind_a_detection_make_its_cell_and_the_others_do_not(spheres):
    radar, paths, spectrum = spheres
    found = ep.detect(spectrum, radar, paths=paths)
    mesh = paths.mesh_id[paths.offsets]
    for number, name in enumerate(TARGETS):
        index = expect_paths_hold(found, paths, radar, spectrum, nearest(found, name))
        assert set(mesh[index]) == {number}


@pytest.fixture(scope="module")
def movers():
    """(radar, paths, signal) of limbs, which speed up during the frame, and of a plate at 30 m/s, which shows three axes
    away and goes on by three cells of range; two transmitters in turn."""
    radar = radar_with(receivers=2, transmitters=2, num_chirps=128, chirp_interval=60e-6)
    scene = ep.Scene()
    scene.add(ep.actors.pedestrian(height=1.78, speed=1.5), name="walker", position=(8, 0, -1), yaw=np.pi)
    scene.add(ep.actors.plate(0.3, 0.3), name="plate", material=lambert(0.27), position=(14, -1, 0),
              motion=ep.LinearMotion(velocity=(30.0, 0, 0)))
    paths = ep.trace(scene, radar, num_rays=3000, max_bounces=2)
    return radar, paths, ep.synthesize(paths, radar)


@pytest.mark.parametrize("window, zero_pad", [("hann", 1), ("rect", 1), ("hann", 2),
                                              ((("chebyshev", 50), "rect"), 1)])
def test_the_paths_behind_limbs_and_folded_speeds_are_found(movers, window, zero_pad):
    radar, paths, cube = movers
    spectrum = ep.range_doppler(ep.add_noise(cube, radar, seed=2), radar, window=window, zero_pad=zero_pad)
    found = ep.detect(spectrum, radar, paths=paths)
    for i in np.argsort(-found.snr_db)[:4]:
        expect_paths_hold(found, paths, radar, spectrum, i)
    assert {"walker", "plate"} <= set(found.object)


def test_the_fields_of_all_paths_add_up_to_the_map(movers):
    """In each channel, also in the sidelobes of a window without taper, far from the echo."""
    radar, paths, cube = movers
    clean = ep.range_doppler(cube, radar, window="rect")
    found = ep.detect(ep.range_doppler(ep.add_noise(cube, radar, seed=2), radar, window="rect"), radar, paths=paths)
    exact = clean.values[:, :, found.cells[:, 0], found.cells[:, 1]].reshape(4, -1)
    model = np.array([found.echoes.fields(cell)[1].sum(axis=1) for cell in found.cells]).T
    assert np.all(np.median(np.abs(np.abs(model) / np.abs(exact) - 1.0), axis=1) < MODEL)


@pytest.mark.parametrize("seed", [1, 2])
def test_strong_echoes_are_not_noise_where_they_fade_in_single_antennas(seed):
    """Rough plates far apart enough from one antenna to the next that their random phases add up differently."""
    radar = radar_with(receivers=8, spacing=0.02)
    scene = ep.Scene()
    for k in range(12):
        scene.add(ep.actors.plate(1.0, 1.0), name=f"plate {k}", material=ep.Material(permittivity=4 - 0.2j, scattering=1.0),
                  position=tuple(at(6.0 + 2.0 * k, 1.1 - 0.2 * k)))
    paths = ep.trace(scene, radar, num_rays=10_000, max_bounces=1, seed=seed)
    spectrum = ep.range_doppler(ep.add_noise(ep.synthesize(paths, radar), radar, seed=seed), radar)
    found = ep.detect(spectrum, radar, paths=paths)
    strong = np.flatnonzero(found.snr_db > 20.0)
    assert len(strong) >= 10 and "noise" not in found.part[strong] and "" not in found.object[strong]
    assert all(len(found.paths(i)[0]) for i in strong)


@pytest.mark.parametrize("n", [16, 15])
def test_the_response_of_a_swept_tone_is_its_slow_sum(n):
    """Also whole turns of the axis away, and in segments."""
    y, sweep = np.array([0.0, -0.37, 2.81, n + 1.3, -2 * n - 0.6]), np.array([0.0, 2.25, -2.25, 2.25, -2.25])
    place = (np.arange(n) - 0.5 * (n - 1)) / n
    terms = np.exp(-2j * np.pi * np.outer(y, place) + 1j * np.pi * np.outer(sweep, place ** 2)) / n
    parts = Response("rect", n, largest_sweep=2.25, segments=3)(y, sweep)  # its step
    np.testing.assert_allclose(parts.sum(axis=0), terms.sum(axis=1), rtol=0, atol=TABLE)
    for part, samples in zip(parts, np.array_split(np.arange(n), 3)):
        np.testing.assert_allclose(part, terms[:, samples].sum(axis=1), rtol=0, atol=TABLE)


@pytest.mark.parametrize("segments", [1, 2, 5, 32])
def test_responses_of_any_sweep_come_from_a_small_table(segments):
    """The error is that of the nearest sweep in the table, whatever the number of segments."""
    n, rng = 512, np.random.default_rng(3)
    sweep, y = rng.uniform(-32.0, 32.0, 300), rng.uniform(-20.0, 20.0, 300)
    place = (np.arange(n) - 0.5 * (n - 1)) / n
    terms = np.exp(-2j * np.pi * np.outer(y, place) + 1j * np.pi * sweep[:, None] * place ** 2) / n
    response = Response("rect", n, largest_sweep=32.0, segments=segments)
    assert response.table_bytes < 20 * 2 ** 20
    error = np.abs(response(y, sweep).sum(axis=0) - terms.sum(axis=1))
    assert error.max() < NEAREST_SWEEP + TABLE


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


def test_one_antenna_gives_no_directions(spheres):
    radar = radar_with(receivers=1)
    spectrum = ep.range_doppler(ep.add_noise(np.zeros((1, 1, 64, 256), complex), radar, seed=1), radar)
    found = ep.detect(spectrum, radar, false_alarm_rate=1e-3)
    assert len(found) and np.isnan(found.azimuth).all() and np.isnan(found.points).any()


def test_detections_do_not_depend_on_the_number_of_threads(movers):
    radar, paths, cube = movers
    spectrum = ep.range_doppler(ep.add_noise(cube, radar, seed=2), radar)
    found = []
    try:
        for count in (1, 4):
            ep.set_num_threads(count)
            found.append(ep.detect(spectrum, radar, method="os", paths=paths))
    finally:
        ep.set_num_threads(0)
    for name in ("range", "velocity", "azimuth", "power", "noise", "object"):
        np.testing.assert_array_equal(getattr(found[0], name), getattr(found[1], name))


def test_csv_holds_what_the_arrays_hold(spheres, tmp_path):
    radar, paths, spectrum = spheres
    found = ep.detect(spectrum, radar, parts=ep.decompose(paths, radar, {"near": "T 'near' R"}))
    found.to_csv(tmp_path / "points.csv")
    with open(tmp_path / "points.csv", encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) == len(found)
    for i, row in enumerate(rows):
        for name, column in (("range", "range_m"), ("velocity", "velocity_m_per_s"), ("azimuth", "azimuth_rad"),
                             ("power", "power_w"), ("snr_db", "snr_db"), ("share", "share")):
            assert float(row[column]) == getattr(found, name)[i]
        assert row["elevation_rad"] == "" and row["part"] == found.part[i]
        assert (int(row["velocity_index"]), int(row["range_index"])) == tuple(found.cells[i])


def test_a_file_that_cannot_be_written_leaves_none(spheres, tmp_path):
    radar, _, spectrum = spheres
    (tmp_path / "file").write_text("")
    with pytest.raises(ep.FileError):
        ep.detect(spectrum, radar).to_csv(tmp_path / "file" / "points.csv")


def test_nothing_found_is_a_well_shaped_result(spheres, tmp_path):
    radar, paths, _ = spheres
    empty = ep.range_doppler(np.zeros((1, 8, 64, 256), complex), radar)
    found = ep.detect(empty, radar, paths=paths, parts=ep.decompose(paths, radar, {}))
    assert len(found) == 0 and found.points.shape == (0, 3) and found.cells.shape == (0, 2)
    assert repr(found) == "Detections(0)"
    found.to_csv(tmp_path / "none.csv")
    assert len((tmp_path / "none.csv").read_text().splitlines()) == 1


def test_the_text_counts_the_parts(spheres):
    radar, paths, spectrum = spheres
    assert "1 near" in repr(ep.detect(spectrum, radar, parts=ep.decompose(paths, radar, {"near": "T 'near' R"})))


def test_unknown_keywords_name_the_nearest_right_one(spheres):
    radar, paths, spectrum = spheres
    for call, word, nearest_right in (
            (lambda **words: ep.detect(spectrum, radar, **words), "false_alarm", "false_alarm_rate"),
            (lambda **words: ep.detect(spectrum, radar, **words), "path", "paths"),
            (lambda **words: ep.detect_frame(None, **words), "max_peak", "max_peaks"),
            (lambda **words: ep.detect_frame(None, **words), "guard_ranges", "guard_range"),
            (lambda **words: ep.families(paths, **words), "object", "objects"),
            (lambda **words: ep.visibility(None, radar, **words), "num_direction", "num_directions")):
        with pytest.raises(TypeError, match=f"unknown keyword '{word}', the nearest right one is '{nearest_right}'"):
            call(**{word: 1})


@pytest.mark.parametrize("objects", [{"a": 3}, {3: "near"}, [3], 5, "near", {"a": ["near", None]}, [["near"]]])
def test_objects_that_are_no_globs_are_named(spheres, objects):
    with pytest.raises(TypeError, match="objects: .*got"):
        ep.families(spheres[1], objects)


def test_bad_arguments_are_named(spheres):
    radar, paths, spectrum = spheres
    parts = ep.decompose(paths, radar, {"near": "T 'near' R"})
    with pytest.raises(TypeError, match="labels: must be Labels"):
        ep.detect(spectrum, radar, labels=object())
    with pytest.raises(ValueError, match="labels: cannot be given beside parts"):
        ep.detect(spectrum, radar, parts=parts, labels=ep.annotate(paths, parts))
    with pytest.raises(ValueError, match="paths: must be traced with the radar"):
        other = radar_with(num_chirps=32)
        ep.detect(ep.range_doppler(np.zeros((1, 8, 32, 256), complex), other), other, paths=paths)
    with pytest.raises(ValueError, match="parts: must be those of one view"):
        ep.detect(spectrum, radar, parts={"view": parts})
    with pytest.raises(ValueError, match="parts: maps must be as"):
        ep.detect(spectrum, radar, parts={name: ep.range_doppler(cube, radar, zero_pad=2) for name, cube in parts.items()})
    with pytest.raises(ValueError, match="false_alarm_rate"):
        ep.detect(spectrum, radar, false_alarm_rate=2.0)
    found = ep.detect(spectrum, radar)
    with pytest.raises(ValueError, match="paths"):
        found.paths(0)
    with pytest.raises(IndexError, match="i: must be"):
        ep.detect(spectrum, radar, paths=paths).paths(99)


def test_a_map_without_noise_is_told_of(spheres):
    """Echoes of the three, as `synthesize` gives them; with noise there is no word."""
    radar, paths, noisy = spheres
    with pytest.warns(RuntimeWarning, match=r"spectrum: holds no noise of the radar .* ep.add_noise\(cube, radar\)") as told:
        ep.detect(ep.range_doppler(ep.synthesize(paths, radar), radar), radar)
    assert [warning.filename for warning in told] == [__file__]  # the line that called, not one behind it
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ep.detect(noisy, radar)
        ep.detect(ep.range_doppler(ep.add_noise(np.zeros((1, 8, 64, 256)), radar, seed=3), radar, zero_pad=2), radar)


@pytest.mark.parametrize("other", [{"chirp_interval": 60e-6}, {"num_samples": 128}, {"num_chirps": 32}])
def test_a_map_of_other_chirps_is_refused(spheres, other):
    with pytest.raises(ValueError, match="spectrum: must have been made with the chirps of this radar"):
        ep.detect(spheres[2], radar_with(**other))


def test_a_map_that_is_not_finite_is_refused():
    radar = radar_with(receivers=1)
    cube = np.array(ep.add_noise(np.zeros((1, 1, 64, 256)), radar, seed=3))
    cube[0, 0, 5, 7] = np.nan
    with pytest.raises(ValueError, match="spectrum: must have values whose power is finite, got nan"):
        ep.detect(ep.range_doppler(cube, radar), radar)
