"""`echopath bench dataset`: what frames of datasets cost, and growth with workers."""
import json
import multiprocessing

import pytest

from echopath.bench import dataset


def test_a_quick_run_writes_what_it_measured(tmp_path, monkeypatch):
    monkeypatch.setattr(dataset.frames, "TEMPLATES", ("ghosts",))
    monkeypatch.setattr(dataset.workers, "TEMPLATE", "ghosts")
    monkeypatch.setattr(dataset.workers, "QUICK_SCENES", 2)
    results = dataset.run_dataset(tmp_path, quick=True)
    assert json.loads((tmp_path / "dataset.json").read_text()) == results
    row, = results["rows"]["frames"]
    assert sum(row["shares"].values()) == pytest.approx(1.0) and row["shares"]["trace"] > 0.0 and row["shares"]["writing"] > 0.0
    assert row["frames"] == 8 and 1e4 < row["bytes"] < 1e6
    one, two = results["rows"]["workers"]
    assert one["frames"] == two["frames"] == 8 and one["growth"] == 1.0
    assert two["growth"] == pytest.approx(one["busiest"] / two["busiest"])  # what it comes to is a matter of the machine
    assert two["memory_holds"] and two["busiest"] < two["seconds"]  # both have worked
    lines = dataset.describe(results)
    assert any(line.startswith("ghosts") for line in lines) and any(line.startswith("2 ") for line in lines)


def test_a_worker_that_fails_ends_the_benchmark(monkeypatch):
    context = multiprocessing.get_context("fork")
    monkeypatch.setattr(dataset.workers.multiprocessing, "get_context", lambda kind: context)
    monkeypatch.setattr(dataset.workers, "_work", lambda path, folder, scenes, run, told: exit(1 if 0 in scenes else 0))
    with pytest.raises(RuntimeError, match="a worker of the benchmark has failed"):
        dataset.workers.rows(quick=True)
