"""What detections are written to, and which calls of detect are refused or warned of."""
from __future__ import annotations

import csv
import warnings

import numpy as np
import pytest

import echopath as ep
from echopath.detections import labelling
from support.scenes.small_spheres import radar_with


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


def test_progress_tells_of_the_paths_behind_the_cells(spheres):
    radar, paths, spectrum = spheres
    seen = {}
    found = ep.detect(spectrum, radar, paths=paths, progress=lambda stage, fraction: seen.setdefault(stage, []).append(fraction))
    for stage in ("paths of cells", "families of cells"):
        np.testing.assert_allclose(seen[stage], np.arange(1, len(found) + 1) / len(found))
    assert {"cfar", "find_peaks", "received power", "estimate_angles"} <= set(seen)


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
    for own in ("cells", "velocity", "progress"):
        with pytest.raises(TypeError, match=f"^angles: unknown keyword '{own}'"):
            ep.detect(spectrum, radar, angles={own: None})
    with pytest.raises(ValueError, match="labels: cannot be given beside parts"):
        ep.detect(spectrum, radar, parts=parts, labels=ep.annotate(paths, parts))
    with pytest.raises(ValueError, match="beside: must have other names than labels, got 'near' in both"):
        ep.detect(spectrum, radar, labels=ep.annotate(paths, parts), beside={"near": parts["near"]})
    with pytest.raises(ValueError, match="paths: must be traced with the radar"):
        other = radar_with(num_chirps=32)
        ep.detect(ep.range_doppler(np.zeros((1, 8, 32, 256), complex), other), other, paths=paths)
    with pytest.raises(ValueError, match=r"parts: must be those of one view, as parts\['view'\]"):
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


@pytest.mark.parametrize("adc, told", [
    (None, r"make the map of ep.receive\(cube"), (ep.Adc(bits=8, gain_db=0.0), "if it came .*: raise gain_db of receiver.adc"),
    (ep.Adc(bits=2, automatic_gain=True), "if it came .*: lower headroom_db of receiver.adc")])
def test_a_map_without_noise_is_told_of_by_what_its_receiver_has(spheres, adc, told):
    radar, paths, _ = spheres
    radar = radar.replace(receiver=ep.Receiver(adc=adc))
    with pytest.warns(RuntimeWarning, match=f"holds no noise of the radar .*{told}"):
        ep.detect(ep.range_doppler(ep.synthesize(paths, spheres[0]), radar), radar)


@pytest.mark.parametrize("other", [{"chirp_interval": 60e-6}, {"num_samples": 128}, {"num_chirps": 32}])
@pytest.mark.parametrize("receiver", [None, ep.Receiver(low_pass=2e6)])
def test_a_map_of_other_chirps_is_refused(spheres, other, receiver):
    with pytest.raises(ValueError, match="spectrum: must have been made with the chirps of this radar"):
        ep.detect(spheres[2], radar_with(**other).replace(receiver=receiver))


@pytest.mark.parametrize("other", [{"zero_pad": 1}, {"plane": "range_azimuth"}])
def test_labels_of_another_map_are_refused(spheres, other):
    """Also of a smaller one, in which cells of the map do not lie."""
    radar, paths, _ = spheres
    spectrum = ep.range_doppler(ep.add_noise(ep.synthesize(paths, radar), radar, seed=3), radar, zero_pad=2)
    with pytest.raises(ValueError, match=r"^labels: must be of the spectrum's cells \(128, 512\), got Labels"):
        ep.detect(spectrum, radar, labels=ep.annotate(paths, **other))


def test_a_map_whose_power_is_not_finite_is_refused():
    radar = radar_with(receivers=1)
    cube = np.array(ep.add_noise(np.zeros((1, 1, 64, 256)), radar, seed=3))
    cube[0, 0, 5, 7] = 1e200
    with pytest.raises(ValueError, match="spectrum: must have values whose power is finite, got inf"):
        ep.detect(ep.range_doppler(cube, radar), radar)


@pytest.mark.parametrize("labels, margin_db", [
    (None, 10.0), (True, 10.0), ({"noise_margin_db": 25.0}, 25.0), ({"noise": False}, -300.0)])
def test_detections_of_a_frame_have_the_noise_margin_of_its_labels(spheres, monkeypatch, labels, margin_db):
    floors = []

    def watched(*arguments, noise_floor, **others):
        floors.append(noise_floor)
        return of_cells(*arguments, noise_floor=noise_floor, **others)

    of_cells = labelling.families_of_cells
    monkeypatch.setattr(labelling, "families_of_cells", watched)
    radar, paths, _ = spheres
    frame = ep.simulate(paths.scene, radar, num_rays=500, labels=labels, detections=True, guard=False, noise_seed=1)
    wanted = ep.noise_power(radar, frame.spectrum.window) * 10.0 ** (0.1 * margin_db)
    assert floors == pytest.approx([wanted], rel=1e-12)
    ep.detect(frame.spectrum, radar, paths=paths, noise_margin_db=3.0)
    if labels is not None:
        of_frame = frame.labels["parts"]
        assert of_frame.noise_floor == (0.0 if margin_db < 0.0 else pytest.approx(wanted))
        ep.detect(frame.spectrum, radar, paths=paths, labels=of_frame)
        assert floors[2] == of_frame.noise_floor
    assert floors[1] == pytest.approx(10.0**0.3 * ep.noise_power(radar, frame.spectrum.window))


@pytest.mark.parametrize("argument", ["parts", "beside"])
def test_cubes_with_what_is_no_number_are_refused(spheres, argument):
    radar, paths, spectrum = spheres
    cube = ep.synthesize(paths, radar)
    cube[0, 3, 1, 2] = np.nan
    with pytest.raises(ValueError, match=fr"^{argument}.near: must be finite, got .nan.* = \[0, 3, 1, 2\]"):
        ep.detect(spectrum, radar, **{argument: {"near": cube}})
