"""Frame files: what is written is what is read, whole or not at all, and damage is noticed."""
from __future__ import annotations


import h5py
import numpy as np
import pytest

import echopath as ep
from echopath import frame_file
from echopath.frame_file import h5, paths as frame_paths
from echopath.paths import subset as path_subset
from echopath.paths.subset import power_of_strongest, strongest, subset
from support.frame_edits import edited
from support.radars import build_radar
from support.shapes import curved_scene, lambert, quad

SUM_TOLERANCE = 1e-12  # sums of doubles in another order
PATH_COLUMNS = ("offsets", "num_bounces", "diffuse", "weight", "stratum", "batch", "flags")
HIT_COLUMNS = ("mesh_id", "triangle_id", "u", "v")
PARTS = {"route": {"direct": "T . R", "wall": "T .* 'wall' .* R"}, "body": {"fan": "T .* 'fan' .* R"}}


def fan():
    """Three sheets on one edge: a non-manifold mesh that waves."""
    vertices = np.array([[0, 0, 0], [0, 0, 1], [1, 0, 0], [0, 1, 0], [-1, 0, 0.0]])
    frames = np.stack([vertices, vertices * [1, 1, 1.1], vertices * [1, 1.2, 1], vertices])
    sequence = ep.VertexSequence(times=[-1.0, 0.0, 1.0, 2.0], vertices=frames, interpolation="linear")
    return ep.Mesh(vertices, [[0, 1, 2], [0, 1, 3], [0, 1, 4]]), sequence


def make_scene():
    """A wall that is a mirror, a deforming fan, two turning plates of one mesh, under a moving parent."""
    scene = ep.Scene()
    wall = quad((-5, 3, -5), (40, 3, -5), (40, 3, 6), (-5, 3, 6))
    rough = ep.Material(permittivity=5 - 0.3j, scattering=0.3, cross_polarization=0.2, mirror=True)
    scene.add(wall, name="wall", material=rough)
    mesh, sequence = fan()
    scene.add(mesh, name="fan", material=lambert(0.27), motion=sequence, position=(6, 0, 0))
    keys = ep.KeyframeMotion(times=[-1.0, 0.0, 1.0, 2.0],
                             translations=[[0, 0, 0], [0.1, 0, 0], [0.1, 0.2, 0], [0, 0, 0.0]])
    scene.add(None, name="carrier", motion=keys, position=(8, 1, 0), yaw=0.3)
    plate = quad((0, -0.5, -0.5), (0, 0.5, -0.5), (0, 0.5, 0.5), (0, -0.5, 0.5))
    spin = ep.LinearMotion(velocity=(-1, 0, 0), angular_velocity=(0, 0, 0.5))
    for index in range(2):
        scene.add(plate, name=f"plate{index}", material=ep.Material.metal(), motion=spin, parent="carrier",
                  position=(0, 0, index))
    return scene


def make_radar():
    receivers = [ep.Antenna((0, 0.01 * (i + 1), 0), pattern=ep.CosinePower(2.0)) for i in range(2)]
    return build_radar([ep.Antenna(polarization=(0, 1, 0))], receivers, num_chirps=16, chirp_interval=1e-4,
                       transmit_power=0.02, noise_figure_db=9.0, position=(0.1, -0.2, 0.3), yaw=0.05, pitch=-0.02,
                       motion=ep.LinearMotion(velocity=(1, 0, 0)))


@pytest.fixture(scope="module")
def frame():
    return ep.simulate(make_scene(), make_radar(), num_rays=4000, seed=7, parts=PARTS, noise_seed=3,
                       window=("chebyshev", 60), angles={"window": ("chebyshev", 30), "azimuth": [-0.1, 0.0, 0.15]})


@pytest.fixture
def saved(frame, tmp_path):
    path = tmp_path / "frame.h5"
    frame.save(path)
    return path


def test_every_keyword_of_a_map_from_above_is_read_again(tmp_path):
    wave = ep.speed_of_light / 77e9
    radar = build_radar(receivers=tuple((0, 0.5 * wave * n, 0) for n in range(4)), num_chirps=16)
    angles = {"overlaps": "first", "compensate": False, "velocity_gate": (-2.0, 2.0), "combine": "sum", "velocity_neighbours": 2}
    made = ep.simulate(curved_scene(), radar, num_rays=300, angles=angles, guard=False)
    ep.save_frame(made, tmp_path / "frame.h5")
    found = ep.load_frame(tmp_path / "frame.h5")
    assert found.angle_settings | {"velocity_gate": (-2.0, 2.0)} == angles
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


def refuse(path, reason):
    with pytest.raises(ep.FileError, match=reason):
        ep.load_frame(path)


def test_a_fault_of_a_reader_stays_behind_the_error(saved, monkeypatch):
    """Else a bug of ours looks like a damaged file."""
    def broken(*arguments):
        raise TypeError("no such argument")

    monkeypatch.setattr(frame_paths, "read_array", broken)
    with pytest.raises(ep.FileError, match="no such argument") as told:
        ep.load_frame(saved)
    causes = [told.value]
    while causes[-1].__cause__ is not None:
        causes.append(causes[-1].__cause__)
    assert type(causes[-1]) is TypeError and causes[-1].__traceback__.tb_next is not None


def test_other_files_are_refused(tmp_path):
    refuse(tmp_path / "nowhere.h5", "no such file")
    (tmp_path / "text.h5").write_text("no HDF5 at all")
    refuse(tmp_path / "text.h5", "damaged or not an HDF5 file")
    with h5py.File(tmp_path / "other.h5", "w") as file:
        file["data"] = np.arange(3)
    refuse(tmp_path / "other.h5", "no frame file of echopath")


def change(path, edit):
    with edited(path) as file:
        edit(file)


def replace(file, name, values):
    del file[name]
    file[name] = values


def replace_by_group(file, name):
    del file[name]
    file.create_group(name)


def replace_by_nothing(file, name, shape):
    """A dataset that says it is very long and has no values."""
    dtype = file[name].dtype
    del file[name]
    file.create_dataset(name, shape, dtype, chunks=(1 << 20,))


EDITS = {
    "newer layout": (lambda file: file.attrs.modify("schema_version", 99), "schema version 99"),
    "no weights": (lambda file: file.__delitem__("record/paths/weight"), "record/paths/weight: no such dataset"),
    "wrong type": (lambda file: replace(file, "record/hits/u", np.zeros(3)), "must hold float32"),
    "short column": (lambda file: replace(file, "record/hits/u", np.zeros(3, np.float32)), "must have the shape"),
    "wild offset": (lambda file: file["record/paths/offsets"].__setitem__(0, 10**9), "must lie within"),
    "wild mesh": (lambda file: file["record/hits/mesh_id"].__setitem__(0, 77), "must be below"),
    "wild triangle": (lambda file: file["record/hits/triangle_id"].__setitem__(0, 7777), "must be below"),
    "wild parent": (lambda file: file["scene/parent"].__setitem__(0, 3), "must name an earlier node"),
    "bad material": (lambda file: file["scene/materials/0"].attrs.modify("scattering", 7.0), "scattering"),
    "unknown replay": (lambda file: file["signal"].attrs.modify("replay", np.bytes_("newton")), "'replay' must be one of"),
    "unknown setting": (lambda file: file["spectra"].attrs.modify("settings", np.bytes_('{"windw": 1}')), "no keys but window"),
    "settings of another map": (lambda file: file["spectra"].attrs.modify("settings", np.bytes_('{"zero_pad": 4000000}')),
                                "make a map of 16 velocities"),
    "settings that are no table": (lambda file: file["spectra"].attrs.modify("settings", np.bytes_("[1]")), "no keys but"),
    "wild part": (lambda file: file["partitions/0/part_of_path"].__setitem__(0, 9), "must be below 3, the number of parts"),
    "last offset": (lambda file: file["record/paths/offsets"].__setitem__(0, 2**63 - 1), "must lie within"),
    "array as setting": (lambda file: file["record/frame"].attrs.create("seed", [1, 2]), "'seed' must be a int"),
    "negative seed": (lambda file: file["signal"].attrs.create("noise_seed", -1), "'noise_seed' must not be negative, is -1"),
    "group as array": (lambda file: replace_by_group(file, "record/paths/offsets"), "offsets: no such dataset"),
    "array as group": (lambda file: replace(file, "scene/materials", np.zeros(3)), "scene/materials: no such group"),
    "values without end": (lambda file: replace_by_nothing(file, "record/hits/u", (1 << 40,)), "record/hits"),
    "unknown column": (lambda file: file["record/paths"].move("flags", "flogs"), "flogs: unknown column|flags: no such"),
    "damaged keyframes": (lambda file: file["scene/motions/0/times"].__setitem__(0, np.nan), "/scene/motions/0: times"),
    "cube of another radar": (lambda file: file["radar/waveform"].attrs.modify("num_chirps", 5), "must have the shape"),
}


@pytest.mark.parametrize("name", EDITS)
def test_files_that_contradict_themselves_are_refused(saved, name):
    edit, reason = EDITS[name]
    change(saved, edit)
    refuse(saved, reason)


def position_of(path, name: str) -> int:
    """Byte of the file at which the values of a dataset begin."""
    with h5py.File(path) as file:
        dataset = file[name].id
        return dataset.get_offset() if file[name].chunks is None else dataset.get_chunk_info(0).byte_offset


@pytest.mark.parametrize("name", ["record/paths/weight", "record/paths/offsets", "signal/cube", "scene/name", "scene/parent",
                                  "radar/receivers/position"])
def test_a_flipped_bit_is_noticed(saved, name):
    position = position_of(saved, name)
    content = bytearray(saved.read_bytes())
    content[position + 5] ^= 0x10
    saved.write_bytes(content)
    refuse(saved, name)


def test_values_that_a_lost_sector_made_zeros_are_noticed(saved):
    """A check sum of sums, such as Fletcher's, is that of zeros for zeros."""
    with h5py.File(saved) as file:
        size = file["scene/parent"].nbytes
    position = position_of(saved, "scene/parent")
    content = bytearray(saved.read_bytes())
    content[position:position + size] = bytes(size)
    saved.write_bytes(content)
    refuse(saved, "scene/parent: damaged")


def test_settings_of_a_file_are_checked_bytes(saved):
    """HDF5 keeps attributes in headers, whose check sums it holds against them."""
    content = saved.read_bytes()
    position = content.index(b'"zero_pad": 1')
    saved.write_bytes(content[:position + 12] + b"2" + content[position + 13:])
    refuse(saved, "incorrect metadata checksum")


def test_no_text_of_a_file_has_a_variable_length(saved):
    def look(_, item):
        kinds = [item.attrs.get_id(name).dtype.kind for name in item.attrs]
        assert "O" not in (kinds if isinstance(item, h5py.Group) else [*kinds, item.dtype.kind]), item.name

    with h5py.File(saved) as file:
        file.visititems(look)


def test_texts_of_variable_length_are_not_read(saved):
    """The library runs in circles in damaged ones."""
    change_without_check_sums(saved, lambda file: replace(file, "scene/name", ["wall", "fan", "carrier", "a", "b"]))
    refuse(saved, "scene/name must hold texts of fixed length")
    with h5py.File(saved, "r+") as file:
        file.attrs["format"] = "echopath frame"
    refuse(saved, "attribute 'format' must be a str")


def change_without_check_sums(path, edit):
    with h5py.File(path, "r+") as file:
        edit(file)


def test_files_of_the_layout_before_are_told_why_not(tmp_path):
    with h5py.File(tmp_path / "frame.h5", "w") as file:
        file.attrs["format"], file.attrs["schema_version"] = "echopath frame", 3
    refuse(tmp_path / "frame.h5", "has schema version 3, this program reads 4; .*check sums")


def test_names_that_hold_a_nul_are_refused(tmp_path):
    with pytest.raises(ValueError, match="title: must not hold a NUL character, got 'a.x00b'"):
        with h5.writing(tmp_path / "frame.h5") as file:
            h5.write_texts(file, "title", ["a\0b"])


def test_long_settings_come_back(tmp_path):
    """Attributes beyond 64 KiB are kept elsewhere in the file."""
    text = "x" * 100_000
    with h5.writing(tmp_path / "long.h5") as file:
        h5.write_attribute(file, "settings", text)
    with h5.reading(tmp_path / "long.h5") as file:
        assert h5.read_attribute(file, "settings", str) == text


@pytest.mark.hard
@pytest.mark.parametrize("share", [0.1, 0.5, 0.95])
def test_a_truncated_file_is_refused(saved, share):
    content = saved.read_bytes()
    saved.write_bytes(content[:int(share * len(content))])
    refuse(saved, "damaged")


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
