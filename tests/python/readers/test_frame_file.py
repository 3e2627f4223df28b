"""Frame files: what is written is what is read, whole or not at all, and damage is noticed."""
from __future__ import annotations

import os
import re
from array import array

import h5py
import numpy as np
import pytest

import echopath as ep
from echopath import frame_file
from echopath.frame_file import h5, opening, paths as frame_paths
from echopath.paths import subset as path_subset
from echopath.paths.subset import power_of_strongest, strongest, subset
from support.radars import build_radar
from support.scenes.saved_frame import PARTS, make_radar
from support.shapes import curved_scene

SUM_TOLERANCE = 1e-12  # sums of doubles in another order
PATH_COLUMNS = ("offsets", "num_bounces", "diffuse", "weight", "stratum", "batch", "flags")
HIT_COLUMNS = ("mesh_id", "triangle_id", "u", "v")


def test_every_keyword_of_a_map_from_above_is_read_again(tmp_path):
    wave = ep.speed_of_light / 77e9
    radar = build_radar(receivers=tuple((0, 0.5 * wave * n, 0) for n in range(4)), num_chirps=16)
    angles = {"overlaps": "first", "compensate": np.False_, "velocity_gate": (np.float32(-2.0), 2.0), "combine": "sum",
              "velocity_neighbours": np.int64(2)}
    made = ep.simulate(curved_scene(), radar, num_rays=300, angles=angles, guard=False)
    ep.save_frame(made, tmp_path / "frame.h5")
    found = ep.load_frame(tmp_path / "frame.h5")
    assert found.angle_settings | {"velocity_gate": (-2.0, 2.0)} == angles
    assert_same_bits(found.range_azimuth.power, made.range_azimuth.power)


@pytest.mark.parametrize("azimuths", [range(-1, 2), array("d", [-0.5, 0.0, 0.5])], ids=["range", "array of Python"])
def test_azimuths_of_a_map_from_above_are_read_again_whatever_holds_them(tmp_path, azimuths):
    radar = build_radar(receivers=tuple((0, 0.002 * n, 0) for n in range(4)), num_chirps=4)
    made = ep.simulate(curved_scene(), radar, num_rays=100, angles={"azimuth": azimuths}, guard=False)
    ep.save_frame(made, tmp_path / "frame.h5")
    found = ep.load_frame(tmp_path / "frame.h5")
    assert found.range_azimuth.azimuth.tolist() == list(azimuths)
    assert_same_bits(found.range_azimuth.power, made.range_azimuth.power)


def assert_same_bits(one, other):
    one, other = np.asarray(one), np.asarray(other)
    assert one.dtype == other.dtype and one.shape == other.shape and one.tobytes() == other.tobytes()


def test_paths_read_back_give_the_same_bits(frame, tmp_path):
    frame.paths.save(tmp_path / "paths.h5")
    paths = ep.Paths.load(tmp_path / "paths.h5")
    assert paths.num_paths > 1000
    for name in PATH_COLUMNS + HIT_COLUMNS:
        assert_same_bits(getattr(frame.paths, name), getattr(paths, name))
    assert_same_bits(frame.paths.amplitude, paths.amplitude)
    times = [0.0, 1e-3]
    assert_same_bits(frame.paths.lengths(times), paths.lengths(times))


def test_counts_of_a_trace_are_read_under_the_names_that_older_files_have(frame, tmp_path):
    path = tmp_path / "paths.h5"
    frame.paths.save(path)
    with h5py.File(path, "r+") as file:
        attributes = file["record/frame"].attrs
        del attributes["num_unfollowed_frusta"]
        attributes["num_unfollowed_beams"] = 17
    assert ep.Paths.load(path).frame.statistics.num_unfollowed_frusta == 17
    with h5py.File(path, "r+") as file:
        del file["record/frame"].attrs["num_unfollowed_beams"]
    with pytest.raises(ep.FileError, match="'num_unfollowed_frusta'"):
        ep.Paths.load(path)


def test_paths_read_back_synthesise_the_same_bits(frame, saved):
    paths = ep.Paths.load(saved)
    assert_same_bits(ep.synthesize(frame.paths), ep.synthesize(paths))


def test_a_scene_read_back_has_the_same_vertices_at_all_times(frame, saved):
    scene = ep.Paths.load(saved).scene
    assert [(mesh.id, mesh.name, mesh.material_name) for mesh in scene.meshes] == [
        (mesh.id, mesh.name, mesh.material_name) for mesh in frame.scene.meshes]
    for mesh, other in zip(frame.scene.meshes, scene.meshes):
        assert mesh.material == other.material
        assert_same_bits(mesh.triangles, other.triangles)
        for time in (0.0, 0.3, 1.7):
            assert_same_bits(frame.scene.world_vertices(mesh.id, time), scene.world_vertices(mesh.id, time))


def test_a_mesh_of_several_nodes_is_written_once(saved):
    with h5py.File(saved) as file:
        assert len(file["scene/meshes"]) == 3 and len(file["scene/name"]) == 5
        assert len(file["scene/motions"]) == 2


def test_rates_of_a_smooth_curve_are_written_once_and_read_under_both_names(tmp_path):
    rates = np.array([[0.0, 1.0, 0.0], [0.5, 0.0, 2.0], [0.0, 0.0, 0.0]])
    jump = rates + [[0.0, 0.0, 0.0], [0.0, 0.25, 0.0], [0.0, 0.0, 0.0]]
    scene = ep.Scene()
    for name, after in (("smooth", rates), ("jumping", jump)):
        curve = ep.Curve([0.0, 1.0, 2.0], np.cumsum(rates, axis=0), "hermite", in_tangents=rates, out_tangents=after)
        scene.add(ep.actors.box(0.2), name=name, material="metal", motion=ep.CurveMotion(curve, period=2.0, offset=0.7))
    ep.trace(scene, build_radar(), num_rays=10).save(tmp_path / "paths.h5")
    with h5py.File(tmp_path / "paths.h5") as file:
        smooth, jumping = ({name: motion["translation"][name] for name in ("in_tangents", "out_tangents")}
                           for _, motion in sorted(file["scene/motions"].items()))
        for found, expected in ((smooth, rates), (jumping, jump)):
            np.testing.assert_array_equal(found["in_tangents"], rates)
            np.testing.assert_array_equal(found["out_tangents"], expected)
        assert smooth["in_tangents"] == smooth["out_tangents"], "two arrays of the same numbers"
        assert jumping["in_tangents"] != jumping["out_tangents"]
    read = ep.Paths.load(tmp_path / "paths.h5").scene
    assert [read[name].motion for name in ("smooth", "jumping")] == [scene[name].motion for name in ("smooth", "jumping")]


def test_a_radar_read_back_is_the_same(frame, saved):
    radar, expected = ep.Paths.load(saved).radar, frame.radar
    assert (radar.transmit_power, radar.noise_figure_db, radar.multiplexing) == (0.02, 9.0, expected.multiplexing)
    assert radar.waveform.bandwidth == expected.waveform.bandwidth
    for antenna, other in zip(expected.receivers, radar.receivers, strict=True):
        assert_same_bits(antenna.position, other.position)
        assert antenna.pattern.exponent == other.pattern.exponent
        assert antenna.pattern.peak_gain == other.pattern.peak_gain
    assert_same_bits(expected.transmitters[0].polarization, radar.transmitters[0].polarization)
    assert_same_bits(expected.motion.velocity, radar.motion.velocity)
    assert_same_bits(expected.position, radar.position)
    assert (radar.yaw, radar.pitch) == (expected.yaw, expected.pitch)
    assert radar == expected


def test_a_frame_read_back_is_the_same(frame, saved):
    other = ep.load_frame(saved)
    assert_same_bits(frame.cube, other.cube)
    assert_same_bits(frame.noisy_cube, other.noisy_cube)
    assert_same_bits(frame.spectrum.values, other.spectrum.values)
    assert frame.selections == other.selections
    assert frame.spectrum_settings == other.spectrum_settings
    names = {partition: list(cubes) for partition, cubes in other.parts.items()}
    assert names == {"route": ["direct", "wall", "other"], "body": ["fan", "other"]}
    for partition, cubes in frame.parts.items():
        assert_same_bits(frame.part_of_path[partition], other.part_of_path[partition])
        for part, cube in cubes.items():
            assert_same_bits(cube, other.parts[partition][part])


def test_a_range_azimuth_map_is_written_and_made_again(frame, saved):
    with h5py.File(saved) as file:
        for name in ("power", "azimuth", "elevation", "range"):
            assert_same_bits(file["range_azimuth"][name][...], getattr(frame.range_azimuth, name))
    other = ep.load_frame(saved)
    assert other.angle_settings == frame.angle_settings
    assert_same_bits(other.range_azimuth.power, frame.range_azimuth.power)


def test_labels_say_which_part_a_path_is_in(frame):
    for part, paths in enumerate(frame.paths.partition(PARTS["route"]).values()):
        chosen = np.flatnonzero(frame.part_of_path["route"] == part)
        assert_same_bits(paths.offsets, frame.paths.offsets[chosen])


def test_paths_left_out_are_counted_with_their_power(frame, tmp_path):
    power = np.abs(frame.paths.amplitude) ** 2
    min_power = float(np.quantile(power, 0.9))
    missing = frame.paths.save(tmp_path / "strong.h5", min_power=min_power)
    kept = ep.Paths.load(tmp_path / "strong.h5")
    assert missing == frame_file.left_out(tmp_path / "strong.h5")
    assert missing.num_paths == np.count_nonzero(power < min_power) > 0
    assert kept.num_paths + missing.num_paths == frame.paths.num_paths
    kept_power = np.abs(kept.amplitude) ** 2
    assert kept_power.min() >= min_power
    assert kept_power.sum() + missing.power == pytest.approx(power.sum(), rel=SUM_TOLERANCE, abs=0.0)


def test_labels_of_a_file_are_those_of_the_paths_it_holds(frame, tmp_path):
    min_power = float(np.median(np.abs(frame.paths.amplitude) ** 2))
    ep.save_frame(frame, tmp_path / "strong.h5", min_power=min_power)
    other = ep.load_frame(tmp_path / "strong.h5")
    expected = other.paths.partition(PARTS["route"])["wall"].num_paths
    assert np.count_nonzero(other.part_of_path["route"] == 1) == expected


def test_a_subset_has_exactly_the_hits_that_its_paths_use(frame):
    keep = np.random.default_rng(5).random(frame.paths.num_paths) < 0.3
    some = subset(frame.paths, keep)
    offsets, num_bounces = frame.paths.offsets[keep], frame.paths.num_bounces[keep]
    used = sorted({int(hit) for begin, count in zip(offsets, num_bounces) for hit in range(begin, begin + count)})
    assert_same_bits(some.hits, frame.paths.hits[used])
    for old, new, count in zip(offsets, some.offsets, num_bounces):
        assert used[new:new + count] == list(range(old, old + count))


def test_power_is_that_of_the_amplitudes(frame):
    amplitude = frame.paths.amplitude
    np.testing.assert_allclose(frame.paths.power, amplitude.real**2 + amplitude.imag**2, rtol=SUM_TOLERANCE, atol=0.0)


def test_a_subset_has_the_lengths_and_amplitudes_of_its_paths(frame):
    keep = np.arange(frame.paths.num_paths) % 3 == 0
    some = subset(frame.paths, keep)
    assert_same_bits(some.amplitude, frame.paths.amplitude[keep])
    assert_same_bits(some.lengths([0.0]), frame.paths.lengths([0.0])[:, keep])
    assert len(some.mesh_id) < len(frame.paths.mesh_id)


def test_the_strongest_paths_fill_the_budget_but_never_exceed_it():
    power = np.array([1.0, 5.0, 3.0, 3.0, 2.0])
    assert np.count_nonzero(power >= power_of_strongest(power, 5)) == 5
    assert np.count_nonzero(power >= power_of_strongest(power, 3)) == 3
    assert np.count_nonzero(power >= power_of_strongest(power, 2)) == 1  # the two equal ones go together


@pytest.mark.parametrize("block", [3, 1000])
def test_the_strongest_paths_are_those_of_a_sort(monkeypatch, block):
    monkeypatch.setattr(path_subset, "BLOCK", block)
    power = np.random.default_rng(9).lognormal(-60.0, 9.0, 400)
    power[::7] = 0.0
    descending = np.argsort(-power)
    for count in (1, 17, 300):
        assert power_of_strongest(power, count) == power[descending[count - 1]]
        assert strongest(power, count).tolist() == descending[:count].tolist()


def test_names_that_hold_a_nul_are_refused(tmp_path):
    with pytest.raises(ValueError, match="title: must not hold a NUL character, got 'a.x00b'"):
        with h5.writing(tmp_path / "frame.h5") as file:
            h5.write_texts(file, "title", ["a\0b"])


def test_long_settings_come_back(tmp_path):
    """Attributes beyond 64 KiB are kept elsewhere in the file."""
    text = "x" * 100_000
    with h5.writing(tmp_path / "long.h5") as file:
        h5.write_attribute(file, "settings", text)
    with opening.reading(tmp_path / "long.h5") as file:
        assert h5.read_attribute(file, "settings", str) == text


@pytest.mark.hard
def test_an_interrupted_write_leaves_the_old_file_alone(frame, saved, monkeypatch):
    before = saved.read_bytes()

    def interrupt(*arguments, **keywords):
        raise KeyboardInterrupt

    monkeypatch.setattr(frame_paths, "write_texts", interrupt)
    with pytest.raises(KeyboardInterrupt):
        ep.save_frame(frame, saved)
    assert saved.read_bytes() == before
    assert [path.name for path in saved.parent.iterdir()] == ["frame.h5"]


@pytest.mark.hard
def test_a_folder_that_cannot_be_made_is_a_file_error(frame, tmp_path):
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(ep.FileError, match="cannot be written"):
        frame.paths.save(tmp_path / "file" / "frame.h5")


def test_a_negative_power_is_refused(frame, tmp_path):
    with pytest.raises(ValueError, match="min_power: must be a finite number of at least 0 W, got -1.0"):
        frame.paths.save(tmp_path / "frame.h5", min_power=-1.0)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.hard
def test_an_empty_scene_is_written_and_read(tmp_path):
    paths = ep.trace(ep.Scene(), make_radar(), num_rays=100)
    paths.save(tmp_path / "empty.h5")
    assert ep.Paths.load(tmp_path / "empty.h5").num_paths == 0


def test_columns_of_curved_and_polarised_paths_come_back(tmp_path):
    radar = make_radar()
    paths = ep.trace(curved_scene(), radar, num_rays=200000, max_bounces=2, polarization="jones")
    assert paths.jones.shape == (paths.num_paths, 2, 2) and np.abs(paths.jones).max() > 0
    assert paths.curved_cell.shape == (paths.num_paths, 7) and np.abs(paths.curved_cell).max() > 0
    paths.save(tmp_path / "frame.h5")
    again = ep.Paths.load(tmp_path / "frame.h5")
    assert np.array_equal(again.jones, paths.jones) and np.array_equal(again.curved_cell, paths.curved_cell)
    assert again.frame.polarization == "jones" and again.scene.nodes[0].smooth
    assert np.array_equal(again.amplitude, paths.amplitude)


def test_a_record_alone_is_shown_and_saved_as_paths_alone(saved, tmp_path):
    record = tmp_path / "record.h5"
    ep.Paths.load(saved).save(record)
    frame = ep.load_frame(record)
    assert "cube=None" in repr(frame)
    with pytest.raises(ValueError, match="^frame: must be a frame with its signals .frame.paths.save"):
        ep.save_frame(frame, tmp_path / "other.h5")
    assert not (tmp_path / "other.h5").exists()


def test_a_link_stays_a_link_to_the_file_that_is_written(frame, tmp_path):
    """As where results are to lie on a larger disk."""
    (tmp_path / "large").mkdir()
    link = tmp_path / "frame.h5"
    link.symlink_to("large/frame.h5")
    for _ in range(2):  # the file is not there at first
        frame.paths.save(link)
        assert link.is_symlink() and [one.name for one in (tmp_path / "large").iterdir()] == ["frame.h5"]
    assert ep.Paths.load(link).num_paths == frame.paths.num_paths


def test_a_link_to_where_nothing_can_be_written_is_told_with_its_target(frame, tmp_path):
    (tmp_path / "disk").write_text("a file, no folder")
    link = tmp_path / "frame.h5"
    link.symlink_to("disk/frame.h5")
    told = re.escape(f"{link}: cannot be written (a link to {(tmp_path / 'disk' / 'frame.h5').resolve()}: ")
    with pytest.raises(ep.FileError, match=told):
        frame.paths.save(link)
    assert link.is_symlink()


def test_no_file_takes_the_place_of_a_pipe(frame, tmp_path):
    pipe = tmp_path / "here.h5"
    os.mkfifo(pipe)
    before = pipe.stat().st_mode
    with pytest.raises(ep.FileError, match="here.h5: cannot be written .*, not a file"):
        frame.paths.save(pipe)
    assert pipe.stat().st_mode == before and list(tmp_path.iterdir()) == [pipe]
