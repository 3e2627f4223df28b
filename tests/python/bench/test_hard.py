"""The hard cases keep to their bounds: those of `echopath bench hard` that are quick enough, and the page that it writes."""
import json
import subprocess
import sys
from types import SimpleNamespace

import pytest

import echopath as ep
from echopath.bench import hard
from echopath.bench.hard import heavy
from echopath.cli import main

pytestmark = pytest.mark.hard

CASES = hard.all_cases(with_heavy=False)
SECOND_TRACER_SHARE = 1e-5  # as in the heavy case: rays within single precision of an edge are left out already


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name.replace(" ", "_"))
def test_case_keeps_to_its_bound(case):
    value = case.measure()
    assert case.holds(value), f"{value:.6g}, bound {case.bound_text}"


@pytest.mark.parametrize("seed", [100, 101])
def test_hits_and_shadows_are_those_of_a_second_tracer(seed):
    pytest.importorskip("embreex")
    assert heavy.disagreement(seed, 100_000) <= SECOND_TRACER_SHARE
    assert heavy.shadow_disagreement(seed, 100_000) <= SECOND_TRACER_SHARE


def test_names_are_unique_and_every_case_says_what_it_expects_and_how_it_fails():
    cases = hard.all_cases()
    assert len({case.name for case in cases}) == len(cases) > 60
    assert all(case.expected and case.group and case.bound_text and case.broken for case in cases)


def test_a_checkout_has_the_cases_of_the_slow_reference():
    """They are there with the sources alone: a reference that is looked for in the wrong folder would be missed by nobody."""
    from support.references import reference_scenes

    kinds = {name.removesuffix("_deviation") for name in vars(reference_scenes)}
    asked = []
    with pytest.MonkeyPatch.context() as patched:
        found = [SimpleNamespace(field=0, cube=0, power=0)]
        patched.setattr(hard.oracle, "_deviations", lambda kind: asked.append(kind) or found)
        assert [case.measure() for case in hard.oracle.cases] == [0] * 5
    assert set(asked) == {"coherent", "polarized", "array", "diffuse"} <= kinds


def test_nan_keeps_to_no_bound():
    for at_least in (False, True):
        assert not hard.Case("x", "g", "e", 0.0, "", lambda: 0.0, "", at_least).holds(float("nan"))


def test_the_page_has_no_empty_cell_and_tells_what_fails(tmp_path, monkeypatch, capsys):
    def broken():
        raise ValueError("no | such\nthing")

    few = [hard.Case("good", "one", "small", 1.0, "m", lambda: 0.5, "no | guard: 3"),
           hard.Case("bad", "one", "small", 1.0, "m", lambda: 2.0, "none"),
           hard.Case("ill", "two", "anything", 1.0, "", broken, "none")]
    monkeypatch.setattr(hard, "all_cases", lambda with_heavy: few)
    assert main(["bench", "hard", "--out", str(tmp_path), "--quick"]) == 0
    text = (tmp_path / "hard.md").read_text(encoding="utf-8")
    rows = [line for line in text.splitlines() if line.startswith("| ") and not line.startswith("| case")]
    assert len(rows) == 3 and all(cell.strip() for line in rows for cell in line.replace("\\|", "").strip("|").split("|"))
    assert [line.count("**fails**") for line in rows] == [0, 1, 1] and "no \\| such thing" in rows[2]
    assert [row["holds"] for row in json.loads((tmp_path / "hard.json").read_text())["cases"]] == [True, False, False]
    assert "1 of 3 hard cases hold" in capsys.readouterr().out


def test_a_radar_on_a_surface_is_warned_of():
    scene = ep.Scene()
    scene.add(ep.actors.plate(1.0, 1.0), name="bumper", material="plastic")
    radar = hard.scenes.make_radar()
    with pytest.warns(RuntimeWarning, match="within 1 mm of the radar"):
        ep.trace(scene, radar, num_rays=2000)


# On two processors: the stacks of a thread for each of 32 would leave none of the memory, and the library of threads ends the
# process where it cannot start one.
RUN_OUT_OF_MEMORY = """
import os, resource, sys
os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:2])
from echopath.cli import main
from echopath.cli import demo
used = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (used + (700 << 20), resource.RLIM_INFINITY))
sys.exit(main(["demo", "--rays", "3e6", "--out", sys.argv[1]]))
"""


def test_a_command_without_enough_memory_ends_in_one_line(tmp_path):
    done = subprocess.run([sys.executable, "-c", RUN_OUT_OF_MEMORY, str(tmp_path / "out")], capture_output=True, text=True)
    said = done.stderr.strip()  # Embree says in its own words that it cannot begin
    assert done.returncode == 2 and said in ("echopath: not enough memory; fewer rays (--rays), samples and chirps need less",
                                             "echopath: Embree: no device could be made"), said
    assert not (tmp_path / "out").exists() or not list((tmp_path / "out").iterdir())
