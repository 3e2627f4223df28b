"""The speed benchmark with few paths: its truths, its files, and what it says without FINUFFT."""
import json
import re

import numpy as np
import pytest

import echopath as ep
from echopath.bench import speed
from echopath.bench.speed import (
    frames as speed_frames,
    retrace as speed_retrace,
    synthesis as speed_synthesis,
    tracer as speed_tracer,
)
from echopath.cli import main
from support.radars import build_radar

EXTENDED = 1e-12   # of a sum in extended precision against the direct one
RATES = 1e-9         # relative: differences of delays tell the rate to 1e-10
FINUFFT_MISS = 2.0   # times the tolerance that FINUFFT was asked for, which it estimates
MOVING_S = 5e-9      # s of processor time for each moving path and chirp: 2.5 ns by the clock of two threads
AT_TOLERANCE = 1.1   # times it: few echoes scatter about the mean error that kernels are made for


def test_tones_at_rest_are_those_of_the_direct_sum():
    """Truth from the tones, written out as exponentials; the sum goes through the whole of synthesis."""
    echoes = speed_synthesis.Echoes(40, 1, seed=3)
    samples = speed_synthesis.slow_sum(*speed_synthesis.tones(echoes.delays[0], echoes.amplitudes[0], echoes.waveform), 512)
    made = ep._core.bench.synthesis_trial(echoes.waveform, echoes.delays[:1], echoes.amplitudes[:1], method="direct")[2][0]
    assert speed_synthesis.relative_error(made, samples) < EXTENDED


@pytest.mark.parametrize("scattered", [False, True])
def test_echoes_of_a_trial_move_as_they_should(scattered):
    """Direct sums in neighbouring chirps: each echo at its delay, against delays written out per chirp."""
    echoes = speed_synthesis.Echoes(30, 8, scattered=scattered)
    nodes = ep._core.bench.trial_node_times(echoes.waveform, speed_synthesis.NODES)
    # Straight motion: two nodes tell the delay at every chirp.
    rate = (echoes.delays[-1] - echoes.delays[0]) / (nodes[-1] - nodes[0])
    times = 60e-6 * np.arange(8) + 0.5 * 511 / 20e6
    delays = echoes.delays[0] + rate * (times[:, None] - nodes[0])
    still = np.broadcast_to(echoes.amplitudes[0], delays.shape)
    constant = np.broadcast_to(echoes.amplitudes[0], echoes.amplitudes.shape)
    expected = ep._core.synthesize_echoes(echoes.waveform, delays, still, method="direct")
    made = ep._core.bench.synthesis_trial(echoes.waveform, echoes.delays, constant, method="direct")[2]
    assert speed_synthesis.relative_error(made, expected) < RATES


def test_bare_loop_asks_the_queries_of_the_trace():
    scene, radar = speed_tracer.rough_spheres(5), build_radar([(0.0, 0.0, 0.0)], [(0.0, 0.3, 0.0)])
    paths = ep.trace(scene, radar, num_rays=5000)
    found = ep._core.bench.bare_queries(scene, radar, num_rays=5000, repetitions=2)
    # A look around each facet that may be a large plane: up to eight queries in each of 64 directions.
    of_planes = paths.frame.statistics.num_queries - found["num_queries"]
    assert 0 <= of_planes < 1000 < 5000 < found["num_queries"]
    assert found["num_paths"] == paths.num_paths and found["num_rays"] == 5000
    assert 0 < found["num_shadow"] < found["num_queries"] and 5000 <= found["num_in_packets"] <= found["num_queries"]
    for name in ("trace_seconds", "bare_seconds", "single_seconds"):
        assert len(found[name]["elapsed"]) == len(found[name]["processor"]) == 2
    with pytest.raises(ValueError, match="repetitions"):
        ep._core.bench.bare_queries(scene, radar, num_rays=100, repetitions=0)


def test_records_have_the_paths_that_were_asked_for():
    paths = speed_frames.record_of(speed_frames.street(), 20_000).num_paths
    assert 20_000 <= paths <= 21_000


def test_the_street_counts_the_paths_that_move_and_adds_up_its_floor():
    """What moves is the pedestrian alone."""
    street = speed_frames.street()
    for row in speed_frames.measure_street(quick=True):
        paths = ep.trace(street.scene, street.radar, num_rays=row["rays"])
        assert (row["paths"], row["chirps"]) == (paths.num_paths, street.radar.waveform.num_chirps)
        assert row["moving_paths"] == paths.select("T .* 'pedestrian' .* R").num_paths > 0
        floor = row["floor"]
        assert floor["moving_s"] == pytest.approx(MOVING_S * row["moving_paths"] * row["chirps"] / ep.num_threads())
        assert row["floor_s"] == pytest.approx(floor["queries_s"] + floor["moving_s"] + floor["still_s"])


def test_kept_geometry_gives_the_same_hits():
    rows = speed_retrace.measure_retrace(quick=True)
    assert len(rows) == 4 and all(row["same_hits"] and row["paths"] > 500 for row in rows)


def test_spread_of_the_cost_per_path_is_seen():
    rows = [{"paths": count, "processor_s": count * cost} for count, cost in ((1000, 9.0), (100_000, 1.0), (1_000_000, 1.3))]
    assert speed_frames.linearity(rows) == pytest.approx(0.3)
    assert speed_frames.linearity(rows[:2]) is None


def test_the_large_frame_has_all_its_chirps_and_channels_and_must_fit_into_memory():
    row = speed_frames.measure_large(2_000)
    assert (row["chirps"], row["channels"]) == (256, 12) and 2_000 <= row["paths"]
    frames = {"paths": [{"peak_bytes": 1}]}
    for gibibytes, holds in ((3.9, True), (4.1, False)):
        verdicts = speed._memory_rows(frames, row | {"paths": 10_247_139, "peak_bytes": gibibytes * 2 ** 30})
        assert verdicts[1]["what"] == "peak memory of 1e+07 paths, 256 chirps, 12 channels" and verdicts[1]["holds"] == holds
    assert len(speed._memory_rows(frames, None)) == 1


@pytest.mark.usefixtures("plain_pictures")
def test_command_writes_numbers_and_pictures_without_finufft_too(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(speed_synthesis, "finufft_version", lambda: None)
    monkeypatch.setattr(speed_synthesis, "TOLERANCES", (1e-3, 1e-6))
    monkeypatch.setattr(speed_frames, "CHIRPS", (2, 4))
    monkeypatch.setattr(speed_frames, "ARRAYS", ((1, 1), (1, 2)))
    monkeypatch.setattr(speed_frames, "QUICK_PATHS", (500, 1_000))
    monkeypatch.setattr(speed_frames, "MEASURED_PATHS", 1)
    monkeypatch.setattr(speed_frames, "PARTS", (1, 4))
    monkeypatch.setattr(speed, "REPLAY_REPEATS", 1)
    monkeypatch.setattr(speed.guard, "QUICK_RAYS", 2_000)
    monkeypatch.setattr(speed.guard, "QUICK_REPEATS", 1)
    monkeypatch.setattr(speed.faint, "QUICK_RAYS", 1_000)
    monkeypatch.setattr(speed.faint, "QUICK_SEEDS", 2)
    cases = speed.replay_cases.all_cases()[:1]
    monkeypatch.setattr(speed.replay_cases, "all_cases", lambda: cases)
    assert main(["bench", "speed", "--quick", "--out", str(tmp_path / "b")]) == 0
    results = json.loads((tmp_path / "b" / "speed.json").read_text())
    for row in results["synthesis"]["rows"]:
        assert row["error"] < AT_TOLERANCE * row["tolerance"] and "finufft_ns" not in row
    for row in results["synthesis"]["slow"]:
        assert row["error"] < row["tolerance"]
    assert results["guard"]["paths"] > 0 and 0.0 <= results["guard"]["share"] < 1.0
    told = capsys.readouterr().out
    assert told.startswith("quick run") and "not installed" in told
    assert set(re.findall("at least|at most", told)) == {"at least", "at most"}
    assert (tmp_path / "b" / "speed.csv").read_text().startswith("tolerance,ns,error")
    for name in ("speed_synthesis.png", "speed_frames.png"):
        assert (tmp_path / "b" / name).stat().st_size > 10_000


def test_finufft_holds_its_own_tolerance_against_our_direct_sum():
    pytest.importorskip("finufft")
    echoes = speed_synthesis.Echoes(500, 1)
    points, strengths = speed_synthesis.tones(echoes.delays[0], echoes.amplitudes[0], echoes.waveform)
    direct = ep._core.bench.synthesis_trial(echoes.waveform, echoes.delays[:1], echoes.amplitudes[:1], method="direct")[2][0]
    asked = 1e-9
    theirs = speed_synthesis.Finufft(points, strengths, 512, asked).samples()
    assert speed_synthesis.relative_error(theirs, direct) < FINUFFT_MISS * asked


def test_a_trial_refuses_what_does_not_fit():
    waveform = speed_synthesis.waveform(8)
    with pytest.raises(ValueError, match="amplitudes"):
        ep._core.bench.synthesis_trial(waveform, np.zeros((2, 3)), np.zeros((2, 4)))
    with pytest.raises(ValueError, match="num_nodes"):
        ep._core.bench.trial_node_times(waveform, 0)
