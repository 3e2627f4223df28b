"""Datasets in the layout of CARRADA: what the loaders of its authors (valeoai/MVRSS, mvrss/loaders) open, with the axes of its
annotations (valeoai/carrada_dataset, utils/transform_annotations.py) and levels that its networks scale from."""
import json

import numpy as np
import pytest

import echopath as ep
from echopath import dataset
from echopath.dataset.exports.carrada_views import views_of
from support.radars import build_radar

RANGE_CELL, VELOCITY_CELL, ANGLE_CELL = 0.1953125, 0.41968030701528203, 0.01227184630308513  # m, m/s, rad, as published
STATS = {"range_doppler": (58.47112418237332, 37.59535773996415, 119.08313902425246),         # dB: mean, lowest, highest
         "range_angle": (56.00209075744544, 40.40928894952408, 103.80548746494114),
         "angle_doppler": (59.62242439612116, 54.42604354196056, 105.79746676271202)}
SHAPES = {"range_doppler": (256, 64), "range_angle": (256, 256), "angle_doppler": (256, 64)}
BALLS = {"walker": (10.0, np.deg2rad(-20.0), 3.4, 1), "rider": (24.0, np.deg2rad(15.0), -4.2, 2)}  # m, rad to the right, m/s
RADIUS = 0.4
TEMPLATE = """
[dataset]
scenes = 2
frames = 2
interval = 0.01
keep = "all"
seed = 12
split = {train = 0.5, test = 0.5}
[dataset.classes]
walker = "pedestrian"
rider = "cyclist"
[radar]
transmit_power = 0.1
[radar.waveform]
start_frequency = 76.6e9
bandwidth = 767.5e6
num_samples = 256
sampling_rate = 10e6
num_chirps = 64
chirp_interval = 36.24e-6
[[radar.transmitters]]
position = [0.0, 0.0, 0.0]
[[radar.transmitters]]
position = [0.0, 0.00779, 0.0]
""" + "".join(f"[[radar.receivers]]\nposition = [0.0, {0.015 + 0.001947 * k:.6f}, 0.0]\n" for k in range(4)) + "".join(f"""
[[objects]]
name = "{name}"
actor = "sphere"
parameters = {{radius = {RADIUS}}}
material = "metal"
smooth = true
position = [{way * np.cos(right):.6f}, {-way * np.sin(right):.6f}, 0.0]
motion = {{kind = "linear", velocity = [{-approach * np.cos(right):.6f}, {approach * np.sin(right):.6f}, 0.0]}}
""" for name, (way, right, approach, _) in BALLS.items()) + """
[trace]
num_rays = 2000
"""


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("carrada")
    (folder / "balls.toml").write_text(TEMPLATE)
    list(dataset.make(folder / "balls.toml", folder / "made"))
    dataset.write_carrada(dataset.open(folder / "made"), folder / "warehouse")
    return folder


@pytest.fixture(scope="module")
def root(made):
    return made / "warehouse" / "Carrada"


def read(root, name: str) -> dict:
    return json.loads((root / name).read_text())


def view(root, name: str, frame: str = "000001", sequence: str = "scene_000000") -> np.ndarray:
    return np.load(root / sequence / f"{name}_processed" / f"{frame}.npy")


def cells_of(name: str) -> dict:
    """{view: (row, column)} of the nearest point of a ball in the middle of frame 1, by the published cells."""
    way, right, approach, _ = BALLS[name]
    row = (way - RADIUS - approach * (0.01 + 64 * 36.24e-6)) / RANGE_CELL
    column, doppler = 128 + right / ANGLE_CELL, 32 + approach / VELOCITY_CELL
    return {"range_doppler": (row, doppler), "range_angle": (255 - row, column), "angle_doppler": (column, doppler)}


def test_every_split_sequence_and_frame_is_where_the_loaders_look(made, root):
    frames, reference = read(root, "light_dataset_frame_oriented.json"), read(root, "data_seq_ref.json")
    assert list(frames) == list(reference) == (root / "validated_seqs.txt").read_text().split()
    opened = dataset.open(made / "made")
    for split, name in (("Train", "train"), ("Test", "test")):
        found = [sequence for sequence in frames if reference[sequence]["split"] == split]
        assert sum(len(frames[sequence]) for sequence in found) == len(opened.split(name)) > 0
    for sequence, names in frames.items():
        assert names == ["000000", "000001"]
        for frame in names:
            for name, shape in SHAPES.items():
                assert view(root, name, frame, sequence).shape == shape
            for kind in ("dense", "sparse"):
                for name in ("range_doppler", "range_angle"):
                    mask = np.load(root / sequence / "annotations" / kind / frame / f"{name}.npy")
                    assert mask.shape == (4, *SHAPES[name]) and (mask.sum(axis=0) == 1).all() and mask.max() == 1


@pytest.mark.parametrize("ball", BALLS)
@pytest.mark.parametrize("name", SHAPES)
def test_targets_are_in_the_published_cells(root, name, ball):
    row, column = cells_of(ball)[name]
    values = view(root, name)
    near = np.full_like(values, -np.inf)
    place = np.s_[int(row) - 8: int(row) + 9, int(column) - 8: int(column) + 9]
    near[place] = values[place]
    found = np.unravel_index(np.argmax(near), values.shape)
    beam = 3 if name == "angle_doppler" else 0.75  # columns of a quarter of a degree have a beam of 20; noise moves its top
    assert abs(found[0] - row) <= beam and abs(found[1] - column) <= (3 if name == "range_angle" else 0.75)
    assert values[found] > STATS[name][0] + 1.5  # five deviations of noise at least, of 256 ranges that are averaged


@pytest.mark.parametrize("name", SHAPES)
def test_noise_has_the_published_level_and_inputs_end_at_the_published_ends(root, name):
    mean, lowest, highest = STATS[name]
    values = np.concatenate([view(root, name, frame, sequence)[:, :20] for sequence in ("scene_000000", "scene_000001")
                             for frame in ("000000", "000001")])  # columns without a target
    level = 10.0 * np.log10(np.median(10.0 ** (values / 10.0)))
    assert level == pytest.approx(mean, abs=0.3)
    assert values.min() >= lowest and view(root, name).max() <= highest


def test_noise_of_channels_at_one_position_has_the_published_level():
    """Three transmitters two elements apart: four of eight elements are those of two channels."""
    step, scene = 0.001947, ep.Scene()
    scene.add(ep.actors.sphere(0.01), name="speck", material="metal", smooth=True, position=(10, 0, 0))
    radar = build_radar([(0, 2 * k * step, 0) for k in range(3)], [(0, k * step, 0) for k in range(4)], num_samples=256,
                        num_chirps=64, transmit_power=1e-12)
    views = views_of(ep.simulate(scene, radar, num_rays=500, guard=False))
    for name, (mean, *_) in STATS.items():
        assert 10.0 * np.log10(np.mean(10.0 ** (views[name] / 10.0))) == pytest.approx(mean, abs=0.1), name


@pytest.mark.parametrize("ball", BALLS)
@pytest.mark.parametrize("name", ["range_doppler", "range_angle"])
def test_masks_have_the_class_at_the_target_and_little_else(root, name, ball):
    row, column = (round(place) for place in cells_of(ball)[name])
    annotations = root / "scene_000000" / "annotations"
    masks = {kind: np.load(annotations / kind / "000001" / f"{name}.npy") for kind in ("dense", "sparse")}
    label = BALLS[ball][3]
    cells = np.argwhere(masks["dense"][label])
    assert (np.abs(cells - [row, column]).max(axis=0) <= ((5, 4) if name == "range_doppler" else (5, 30))).all()
    assert masks["sparse"][label].sum() == 1 and np.all(masks["dense"][label] >= masks["sparse"][label])
    told = read(root, "annotations_frame_oriented.json")["scene_000000"]["000001"][ball][name]
    assert told["label"] == label and sorted(told["dense"]) == cells.tolist()
    assert told["box"] == [cells.min(axis=0).tolist(), cells.max(axis=0).tolist()]
    assert masks["sparse"][label][tuple(told["sparse"][0])] == 1
    assert read(root, "annotations_instance_oriented.json")["scene_000000"][ball]["000001"][name] == told


@pytest.mark.parametrize("before, after, told", [
    ('keep = "all"', 'keep = "maps"', 'of a template with keep = "all"'),
    ("num_chirps = 64", "num_chirps = 32", "256 ranges and 64 velocities, got '256 and 32'"),
    ("test = 0.5", "dev = 0.5", "splits train, val, validation, test alone, got 'dev'")])
def test_what_the_layout_does_not_have_is_refused(tmp_path, before, after, told):
    text = TEMPLATE.replace(before, after).replace("scenes = 2", "scenes = 1").replace("frames = 2", "frames = 1")
    assert before not in text
    (tmp_path / "other.toml").write_text(text)
    list(dataset.make(tmp_path / "other.toml", tmp_path / "made"))
    with pytest.raises(ValueError, match=f"dataset: must be .*{told}"):
        dataset.write_carrada(dataset.open(tmp_path / "made"), tmp_path / "out")


def test_what_a_fault_ends_leaves_nothing(made, monkeypatch, tmp_path):
    def damaged(*_):
        raise ep.FileError("frame_0000.h5: is damaged")

    monkeypatch.setattr("echopath.dataset.exports.carrada.views_of", damaged)
    with pytest.raises(ep.FileError, match="^frame_0000.h5: is damaged$"):
        dataset.write_carrada(dataset.open(made / "made")[:1], tmp_path)
    assert not list(tmp_path.iterdir())


def test_a_folder_that_has_one_is_refused(made):
    with pytest.raises(ValueError, match="folder: must be one that has no folder 'Carrada' yet"):
        dataset.write_carrada(dataset.open(made / "made"), made / "warehouse")


def masks_with(folder, labels: str) -> dict:
    """{(kind, view): mask} of the first frame, of a template with such a table [labels]."""
    (folder / "labelled.toml").write_text(TEMPLATE.replace("frames = 2", "frames = 1") + f"[labels]\n{labels}\n")
    list(dataset.make(folder / "labelled.toml", folder / "made", frames=(0, 1)))
    dataset.write_carrada(dataset.open(folder / "made"), folder / "out")
    return masks_of(folder / "out" / "Carrada")


def masks_of(root) -> dict:
    return {(kind, name): np.load(root / "scene_000000" / "annotations" / kind / "000000" / f"{name}.npy")
            for kind in ("dense", "sparse") for name in ("range_doppler", "range_angle")}


def test_masks_are_those_of_the_objects_whatever_labels_report_on(root, tmp_path):
    for place, mask in masks_with(tmp_path, 'objects = {people = "w*", bikes = "r*"}').items():
        np.testing.assert_array_equal(mask, masks_of(root)[place])


def test_margins_of_labels_hold_in_both_views(tmp_path):
    for mask in masks_with(tmp_path, "noise_margin_db = 300.0").values():
        assert mask[0].all()  # background: no echo is 300 dB above the noise
