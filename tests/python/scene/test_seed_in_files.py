"""Every file that the product writes says by which seed and version it was made."""
import csv
import json

import h5py
import pytest
from PIL import Image

import echopath as ep
from echopath.bench.machine import machine
from echopath.cli.run import write_outputs
from echopath.plots.style import new_figure, save_png
from support.pictures import plain
from support.radars import build_radar
from support.shapes import lambert

SEED = 2**63 + 11  # no default, and more than a double holds
NOISE_SEED = 7
SOFTWARE = f"echopath {ep.__version__}"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """What `echopath run` and `ep.save_labels` write of a frame with labels and detections."""
    folder = tmp_path_factory.mktemp("files")
    scene = ep.Scene()
    scene.add(ep.actors.plate(1.0, 1.0), name="plate", position=(4, 0, 1), material=lambert(0.27),
              motion=ep.LinearMotion(velocity=(-2, 0, 0)))
    radar = build_radar([(0, 0, 1)], [(0, 0.01, 1)], num_chirps=8, chirp_interval=1e-4, transmit_power=10.0)
    frame = ep.simulate(scene, radar, num_rays=2000, seed=SEED, noise_seed=NOISE_SEED, parts={"one": "T . R"}, labels=True,
                        detections={"false_alarm_rate": 1e-2})
    assert len(frame.detections) > 0
    with plain():
        write_outputs(frame, folder, partitions=frame.parts)
    ep.save_labels(frame.labels, folder / "labels.h5")
    return folder


def pictures_of(folder) -> list:
    return sorted(folder.rglob("*.png"))


def test_frame_file(folder):
    with h5py.File(folder / "frame.h5") as file:
        assert int(file["record/frame"].attrs["seed"]) == SEED
        assert int(file["signal"].attrs["noise_seed"]) == NOISE_SEED
        assert file.attrs["software_version"].decode() == ep.__version__
    frame = ep.load_frame(folder / "frame.h5")
    assert (frame.detections.seed, frame.detections.noise_seed) == (SEED, NOISE_SEED)
    assert {labels.seed for labels in frame.labels.values()} == {SEED}


def test_labels_on_their_own(folder):
    assert {labels.seed for labels in ep.load_labels(folder / "labels.h5").values()} == {SEED}


def test_pictures_and_label_maps(folder):
    found = pictures_of(folder)
    assert {"scene.png", "map.png", "objects_and_ghosts.png"} <= {path.name for path in found}
    assert {"objects.png", "ghosts.png"} <= {path.name for path in found if path.parent.name == "label_maps"}
    for path in found:
        with Image.open(path) as image:
            assert (image.text["Seed"], image.text["Software"]) == (str(SEED), SOFTWARE), path.name


def test_the_map_with_noise_tells_the_seed_of_the_noise_too(folder):
    with Image.open(folder / "map.png") as image:
        assert image.text["Noise seed"] == str(NOISE_SEED)


def test_palettes(folder):
    for path in pictures_of(folder / "label_maps"):
        origin = json.loads(path.with_suffix(".json").read_text())["origin"]
        assert origin == {"Software": SOFTWARE, "Seed": str(SEED)}


def test_table_of_detections(folder):
    with open(folder / "detections.csv", newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert rows and {(row["seed"], row["noise_seed"]) for row in rows} == {(str(SEED), str(NOISE_SEED))}


def test_benchmarks(tmp_path):
    assert machine()["seeds"].startswith("fixed") and machine()["echopath"] == ep.__version__
    with new_figure(1.0, 1.0) as figure:
        save_png(figure, tmp_path / "figure.png", seed=machine()["seeds"])
    with Image.open(tmp_path / "figure.png") as image:
        assert image.text["Seed"].startswith("fixed")
