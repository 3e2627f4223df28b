"""What the pace of a machine is, and which limits are held over it."""
import pytest

from echopath.bench import pace, suite

ROWS = [{"what": "all stages, s a frame", "measured": 2.5, "limit": 2.0, "holds": False},
        {"what": "visibility, ms an object", "measured": 0.9, "limit": 0.3, "holds": False},
        {"what": "frame over its stages", "measured": 1.2, "limit": 1.1, "holds": False},
        {"what": "file of labels, MiB", "measured": 3.0, "limit": 2.0, "holds": False},
        {"what": "first map, s", "measured": 1.0, "limit": None, "holds": None},
        {"name": "a part that judges itself", "seconds": 5.0, "limit": 3.0}]


def test_limits_in_seconds_are_held_over_the_pace_and_no_others():
    assert [row.get("holds") for row in suite.at_reference_pace(ROWS, 2.0)] == [True, False, False, False, None, None]
    assert [row.get("holds") for row in suite.at_reference_pace(ROWS, 0.5)] == [False, False, False, False, None, None]


def test_a_machine_of_unknown_pace_is_judged_as_it_is():
    assert suite.at_reference_pace(ROWS, None) == ROWS


def test_what_is_measured_stands_beside_what_the_reference_would_take():
    lines = suite.describe_judged(suite.at_reference_pace(ROWS[:3], 2.0))
    assert lines[1].split()[-6:] == ["holds,", "1.25", "at", "the", "reference's", "pace"]
    assert "2.5" in lines[1] and "0.45 at the reference's pace" in lines[2]
    assert lines[3].endswith("MISSED")


def test_the_pace_is_that_of_the_tolerance_that_says_least(monkeypatch):
    longer = {1e-6: 3.0, 1e-9: 2.0, 1e-12: 4.0}

    class Given:
        def __init__(self, points, strengths, num_samples, tolerance):
            assert len(points) == len(strengths) == pace.POINTS and num_samples == pace.SAMPLES
            self._seconds = 1e-9 * longer[tolerance] * pace.REFERENCE_NS[tolerance] * pace.POINTS

        def seconds(self):
            return self._seconds

    monkeypatch.setattr(pace, "Finufft", Given)
    monkeypatch.setattr(pace, "finufft_version", lambda: "any")
    assert pace.pace_of_machine() == pytest.approx(2.0)


def test_the_pace_is_unknown_without_finufft(monkeypatch):
    monkeypatch.setattr(pace, "finufft_version", lambda: None)
    assert pace.pace_of_machine() is None


def test_a_part_is_judged_by_the_quicker_end_of_its_time(tmp_path, monkeypatch):
    paces = iter([3.0, 2.0, 4.0])
    monkeypatch.setattr(suite, "pace_of_machine", lambda: next(paces))

    class Part:
        @staticmethod
        def rows(*, quick):
            return suite.judged({"a, s": 2.0}, {"a, s": 1.0})

        @staticmethod
        def describe(rows):
            return suite.describe_judged(rows)

    parts = {"one": Part, "two": Part}
    results = suite.run_parts("any", parts, tmp_path, quick=True, progress=None)
    assert results["pace"] == {"one": 2.0, "two": 2.0} and results["rows"]["one"][0]["holds"]
    assert [line for line in suite.describe_parts(parts, results) if "pace:" in line][0].startswith("pace: 2.00 times")
