"""The benchmark of labels at a small number of rays: parts that add up, what it counts, its files."""
import json

import numpy as np
import pytest

import echopath as ep
from echopath.bench import labels
from echopath.bench.labels.false_alarms import MAPS, measure_false_alarms
from echopath.cli import main

COUNT = 0.02  # relative: counts of hits drawn at random


@pytest.fixture(scope="module")
def paths():
    scene = ep.Scene()
    for index in range(3):
        scene.add(ep.actors.plate(1.0, 1.0), name=f"plate_{index}", material="concrete", position=(5.0 + index, index, 0.0),
                  yaw=np.pi)
    radar = ep.Radar(ep.ChirpSequence(num_samples=64, num_chirps=4), transmitters=[ep.Antenna()],
                     receivers=[ep.Antenna((0.0, 0.01, 0.0))])
    return ep.trace(scene, radar, num_rays=500, polarization="scalar")


def test_random_paths_have_the_hits_that_are_asked_for(paths):
    made = labels.random_paths(paths, 30_000, 1, 4)
    assert len(made.mesh_id) == int(made.num_bounces.sum()) == pytest.approx(30_000, rel=COUNT, abs=0)
    assert set(made.num_bounces) == {1, 2, 3, 4} and set(made.mesh_id) == {0, 1, 2}
    assert np.array_equal(made.offsets[1:], np.cumsum(made.num_bounces)[:-1])
    is_diffuse = np.array([[mask >> k & 1 for k in range(5)] for mask in made.diffuse.tolist()], bool)
    assert not is_diffuse[:, 4].any() and 0.4 < is_diffuse[:, 0].mean() < 0.6  # no bit beyond the last hit


def test_partitions_have_the_number_of_parts_that_is_asked_for(paths):
    for count in labels.NUM_PARTS[:3]:
        names, _ = ep._core.partition_groups(paths, list(labels.partition_of(paths, count).items()))
        assert len(names) == min(count, 13) and names[-1] == "other"


@pytest.mark.usefixtures("plain_pictures")
def test_command_writes_numbers_and_picture(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(labels, "QUICK_RAYS", (200,))
    monkeypatch.setattr(labels, "QUICK_NUM_HITS", 20_000)
    monkeypatch.setattr(labels, "NUM_PARTS", (1, 4, 8))
    monkeypatch.setattr(labels, "measure_false_alarms", lambda cells: measure_false_alarms(1, maps=MAPS[:1]))
    assert main(["bench", "labels", "--quick", "--out", str(tmp_path / "b")]) == 0
    results = json.loads((tmp_path / "b" / "labels.json").read_text())
    assert (tmp_path / "b" / "labels.png").stat().st_size > 10_000
    rows = results["parts"][0]["rows"]
    assert [row["num_parts"] for row in rows] == [1, 4, 8] and all(row["sum_error"] < labels.SUM_TARGET for row in rows)
    told = capsys.readouterr().out
    assert "T .* 'wall_*' .* R" in told and "bare loop" in told
