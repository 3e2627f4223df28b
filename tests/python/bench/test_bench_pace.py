"""What the pace of a machine is, and which limits are held over it."""
import json
import math

import numpy as np
import pytest

from echopath.bench import pace, suite
from echopath.bench.dataset import frames
from echopath.bench.live import drive, edits
from echopath.bench.receiver import codes
from echopath.bench.worlds import crowd, motion


def rows(**limits):
    """Rows of 1.5 each, by names and limits."""
    return [suite.judged_row(what, 1.5, limit) for what, limit in limits.items()]


def verdicts(paces, limit, what="all stages, s a frame"):
    return [row["holds"] for row in suite.at_reference(rows(**{what: limit}), paces)]


@pytest.mark.parametrize("paces, limit, holds", [
    ([2.0, 3.0], 1.0, True), ([1.0, 1.0], 1.0, False), ([1.0, 2.0], 1.0, None), ([0.5, 0.6], 2.0, False),
    ([0.5, 1.0], 2.0, None)])
def test_limits_in_seconds_are_held_over_the_pace(paces, limit, holds):
    assert verdicts(paces, limit) == [holds]
    assert verdicts(paces, limit, "visibility, ms an object") == [holds]
    assert verdicts(paces, limit, "frame over its stages") == [1.5 <= limit]


def test_a_limit_is_in_seconds_where_the_name_ends_so():
    known = {**drive.LIMITS, **crowd.LIMITS, **codes.LIMITS}
    timed = {what for what, limit in known.items() if suite.judged_row(what, 1.0, limit).get("timed")}
    assert timed == {"all stages, s a frame", "person, s", "visibility, ms an object"}
    moved = edits.moved_rows("sign", *edits.crowded_street(), 500, 1e9, 1)
    assert [row["what"] for row in moved if row.get("timed")] == ["sign, 500 rays: moved, s"]
    assert not suite.judged_row("first map, s", 1.0, None).get("timed")


def test_what_is_measured_stands_beside_what_the_reference_would_take():
    made = suite.at_reference(rows(**{"person, s": 1.0, "ratio": 1.0}), [2.0, 3.0])
    lines = suite.describe_judged(made)
    assert "1.5" in lines[1] and lines[1].endswith("holds, 0.5 to 0.75 at the reference's pace")
    assert lines[2].endswith("MISSED")
    assert suite.describe_judged(suite.at_reference(made[:1], [1.0, 3.0]))[1].split("  ")[-1].startswith("undecided, 0.5 to 1.5")


def test_rows_that_judge_themselves_are_held_over_the_pace():
    row = {"name": "radar drives", "paths": 1, "ns": 2.0 * motion.LIMIT_NS, "over_reference": 1.0, "error": 0.0, "timed": True}
    made = suite.at_reference([row, row | {"over_reference": 9.0}], [3.0, 4.0])
    assert [line.split("  ")[-1].split(", ")[0] for line in motion.describe(made)[1:3]] == ["holds", "MISSED ratio"]
    assert "undecided ns" in motion.describe(suite.at_reference([row], [1.0, 4.0]))[1]
    row = {"template": "street", "frames": 1, "seconds": 2.0 * frames.STREET_LIMIT, "bytes": 1, "limit": frames.STREET_LIMIT,
           "timed": True, "shares": {}}
    assert frames.describe([row])[1].endswith("MISSED")
    assert ": holds, " in frames.describe(suite.at_reference([row], [3.0, 4.0]))[1]


def test_the_pace_is_over_the_time_of_the_reference(monkeypatch):
    class Given:
        def __init__(self, points, strengths, num_samples, tolerance):
            assert len(points) == len(strengths) == 102_400 and (num_samples, tolerance) == (512, 1e-6)

        def seconds(self):
            return 2.0 * 14.8e-9 * 102_400

    monkeypatch.setattr(pace, "Finufft", Given)
    monkeypatch.setattr(pace, "finufft_version", lambda: "any")
    assert pace.measured_pace() == pytest.approx(2.0)


def test_the_pace_is_found_in_a_process_of_its_own():
    pytest.importorskip("finufft", reason="finufft, of the extra 'test', is not installed")
    assert 0.05 < pace.pace() < 100.0


class Part:
    @staticmethod
    def rows(*, quick):
        return suite.judged({"a, s": 2.0}, {"a, s": 1.0})

    @staticmethod
    def describe(rows):
        return suite.describe_judged(rows)


@pytest.mark.parametrize("found, quick, paces", [
    ([3.0, 2.0, 4.0, 5.0], False, [[2.0, 3.0], [2.0, 4.0], [4.0, 5.0]]), ([None] * 4, False, [None] * 3), ([], True, [None] * 3)])
def test_a_part_is_judged_by_the_paces_before_and_after_it(tmp_path, monkeypatch, found, quick, paces):
    given = iter(found)
    monkeypatch.setattr(suite, "pace", lambda: next(given))
    parts = dict.fromkeys(("one", "two", "three"), Part)
    results = suite.run_parts("any", parts, tmp_path, quick=quick, progress=None)
    assert [results["rows"][name][0].get("paces") for name in parts] == paces
    assert [results["rows"][name][0]["holds"] for name in parts] == [pair is not None for pair in paces]
    assert json.loads((tmp_path / "any.json").read_text()) == results
    said = [line for line in suite.describe_parts(parts, results) if line.startswith("pace: ")]
    assert len(said) == sum(pair is not None for pair in paces)
    assert all("2.00 to 3.00 times" in line for line in said[:1])


def test_figures_of_numpy_are_written_as_numbers(tmp_path):
    parts = {"one": type("Counts", (), {"rows": staticmethod(lambda quick: [suite.judged_row("count", np.int64(3), None)])})}
    suite.run_parts("any", parts, tmp_path, quick=True, progress=None)
    assert json.loads((tmp_path / "any.json").read_text())["rows"]["one"][0]["measured"] == 3


def test_what_has_no_number_is_null_in_a_benchmark_s_file(tmp_path):
    rows = [suite.judged_row("share", one, None) for one in (math.nan, np.float64(math.inf), (2.5, -math.inf))]
    parts = {"one": type("Shares", (), {"rows": staticmethod(lambda quick: rows)})}
    suite.run_parts("any", parts, tmp_path, quick=True, progress=None)
    read = json.loads((tmp_path / "any.json").read_text(), parse_constant=pytest.fail)  # called for what JSON does not know
    assert [row["measured"] for row in read["rows"]["one"]] == [None, None, [2.5, None]]
