"""The replay benchmark at a small number of rays: its cases, its truth by images, its files."""
import json

import pytest

from echopath.bench import replay
from echopath.bench.replay import cases as replay_cases
from echopath.cli import main

FOLLOWED_DB = -35.0    # of the map's peak, for motions that one record follows; the sides of a rotor come into view at -37
IMAGE_RAD = 0.3        # what `validity` takes for harmless


@pytest.mark.parametrize("case", [case for case in replay_cases.all_cases() if case.name != "wheel"],
                         ids=lambda case: case.name)
def test_one_record_follows_the_motion(case, monkeypatch):
    monkeypatch.setattr(replay, "ERROR_RAYS", 400)
    monkeypatch.setattr(replay, "VARIANTS", {"default": {}})
    assert replay._errors(case)[0]["error_db"] < FOLLOWED_DB


def test_a_newton_step_serves_arrays_near_walls():
    row = replay._aperture(0.25, 5.0)
    assert row["paths"] > 10 and row["material_rad"] > IMAGE_RAD > 10 * row["fermat_rad"]


@pytest.mark.usefixtures("plain_pictures")
def test_command_writes_numbers_and_picture(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(replay, "ERROR_RAYS", 200)
    monkeypatch.setattr(replay, "QUICK_RAYS", 1000)
    monkeypatch.setattr(replay, "ARRAYS", ((1, 1), (3, 4)))
    assert main(["bench", "replay", "--quick", "--out", str(tmp_path / "b")]) == 0
    results = json.loads((tmp_path / "b" / "replay.json").read_text())
    assert (tmp_path / "b" / "replay.png").stat().st_size > 10_000
    assert set(results["cases"]) == {case.name for case in replay_cases.all_cases()}
    assert all(case["gain"] > 1 for case in results["cases"].values())
    assert "guard rail, ego 30 m/s" in capsys.readouterr().out
