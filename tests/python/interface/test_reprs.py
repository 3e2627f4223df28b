"""What results and settings show of themselves at a prompt: one short line that says what they hold."""
import numpy as np
import pytest

import echopath as ep
from echopath import dataset
from echopath.dataset.folder import SceneRecord
from support import shapes

LONGEST = 120  # characters


@pytest.fixture(scope="module")
def paths():
    scene = shapes.scene_of(plate=(shapes.plate((5.0, 0.0, 0.0), (-1.0, 0.0, 0.0), 1.0), shapes.lambert(0.9)))
    radar = ep.Radar(ep.ChirpSequence(num_samples=64, num_chirps=4),
                     transmitters=[ep.Antenna((0, 0, 0))], receivers=[ep.Antenna((0, 0.01, 0))])
    return radar, ep.trace(scene, radar, num_rays=300)


def test_records_show_what_they_were_made_with(paths):
    _, record = paths
    rays, hits = record.frame.statistics.num_rays, record.frame.statistics.num_hits
    assert repr(record.frame).startswith(f"TraceFrame({rays} rays, {len(record.frame.strata)} strata, seed 1, at ")
    assert f"({rays} rays, " in repr(record.frame.statistics) and f", {hits} hits, " in repr(record.frame.statistics)


def test_arrays_are_counted_and_not_listed(paths):
    radar, record = paths
    parts = ep.decompose(record, radar, {"plate": "T 'plate' R"})
    assert repr(parts) == "Parts(plate, other: [1, 1, 4, 64])" and repr(parts | {}).startswith("{")
    cells = ep.path_cells(record, ep.range_doppler(sum(parts.values()), radar))
    assert repr(cells) == f"PathCells({record.num_paths} paths, {np.count_nonzero(cells.range_index >= 0)} within the map)"
    sheet = ep.sheet_coefficients(ep.materials["painted_bumper"], frequency=77e9, incidence=np.radians([0, 30, 60]))
    assert repr(sheet) == "SheetCoefficients(3 angles from 0 to 60 degrees)"


def test_labels_are_a_line_each_in_lists(paths):
    """`labels.objects` at a prompt: what `print(labels)` says of each."""
    _, record = paths
    labels = ep.annotate(record, {"plate": "T 'plate' R"}, noise=False)
    shown = repr(labels.objects[0])
    assert shown.startswith("ObjectLabel(plate: seen, ") and " peak 4.95 m" in shown and " dBm" in shown and len(shown) <= LONGEST
    ghost = ep.GhostLabel(object="plate", ghost_type=2, order=3, via=("wall",), class_code=124, cells=0, power=1e-12, peak=None,
                          box=None, received=None)
    assert repr([ghost]) == "[GhostLabel(plate: type 2, order 3, via wall)]"


def test_doubtful_echoes_are_a_line_each_in_lists():
    interval = ep.Interval(1e-12, 1e-13, 1e-11)
    echo = ep.Unresolved(name="plate", via=("wall",), ghost_type=2, order=3, interval=interval, advice="more rays")
    assert repr([echo]) == "[Unresolved(plate via wall, type 2/3: -90.0 dBm, -100.0 to -80.0 dBm; more rays)]"


def test_scene_files_show_what_is_in_them(tmp_path):
    wave = ("num_samples = 64\nsampling_rate = 1e7\nnum_chirps = 4\nchirp_interval = 1e-4\nstart_frequency = 77e9\n"
            "bandwidth = 1e9\n")
    antennas = "[[radar.transmitters]]\nposition = [0, 0, 0]\n[[radar.receivers]]\nposition = [0, 0, 0]\n"
    (tmp_path / "ball.toml").write_text(f"[radar.waveform]\n{wave}{antennas}[trace]\nnum_rays = 10\n[labels]\n[parts]\n"
                                        "ball = \"T 'ball' R\"\n[[objects]]\nname = \"ball\"\nactor = \"sphere\"\n"
                                        "parameters = {radius = 0.1}\nmaterial = \"metal\"\n")
    loaded = ep.load_scene(tmp_path / "ball.toml")
    assert repr(loaded) == f"SceneFile('ball.toml', {loaded.scene!r}, parts, labels)"


def test_receivers_show_what_is_not_ideal():
    assert repr(ep.Receiver()) == "Receiver()"
    faulty = ep.Receiver(iq_gain_db=0.2, phase_noise={"offsets": [1e4], "levels": [-70.0]})
    assert repr(faulty) == "Receiver(phase_noise=PhaseNoise(offsets=(10000.0,), levels=(-70.0,)), iq_gain_db=0.2)"
    assert eval(repr(faulty), {"Receiver": ep.Receiver, "PhaseNoise": ep.PhaseNoise}) == faulty


def test_datasets_tell_of_their_scenes_in_short_lines():
    """`for told in dataset.make(...): print(told)` is what the documentation does."""
    files = {f"frame_{number:04d}.h5": "0" * 64 for number in range(9)}
    done = dataset.MadeScene(0, "train", SceneRecord("done", files), False, 1, 4, 0.56)
    failed = done._replace(record=SceneRecord("failed", reason="ValueError: no rays"), seconds_left=None)
    assert repr(done) == "MadeScene(1 of 4: scene 0 (train) done, about 0.56 s left)"
    assert repr(failed) == "MadeScene(1 of 4: scene 0 (train) failed, ValueError: no rays)"
    assert repr(done.record) == "SceneRecord(done: 9 files)"
    assert repr(dataset.Forecast(8, 1.4962, 3024925)) == "Forecast(8 frames in about 1.5 s, 2.9 MiB)"


def test_the_tab_key_offers_names_of_a_scene_and_of_materials():
    """By the method that IPython asks for, as Jupyter does."""
    scene = ep.Scene()
    scene.add(ep.actors.pedestrian(), name="walker")
    assert scene._ipython_key_completions_() == list(scene) and "walker" in list(scene)
    assert "concrete" in ep.materials._ipython_key_completions_()
