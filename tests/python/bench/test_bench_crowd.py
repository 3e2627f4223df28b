"""The benchmark of crowded scenes: its scenes are what it says, its truths and verdicts hold, its files."""
import json

import numpy as np
import pytest

import echopath as ep
from echopath.bench import crowd
from echopath.bench.crowd import coverage as crowd_coverage, scenes
from echopath.bench.physics.closed_forms import FREQUENCY
from echopath.cli import main
from echopath.paths.resolution import Interval
from echopath.tracing.tessellation import coarse_meshes
from support.scenes.coarse_bodies import coarse_bodies

MID_FRAME = 0.0128   # s
LEAST_GAP = 0.2      # deg between neighbours as the radar sees them
IMAGE = 1e-6         # relative: rounding of single-precision weights


@pytest.fixture(scope="module")
def street():
    return scenes.street(mirrors=False)


def root_name(scene, node: int) -> str:
    nodes = scene.nodes
    while nodes[node].parent >= 0:
        node = nodes[node].parent
    return nodes[node].name


def test_street_has_what_it_is_named_for(street):
    names = [node.name for node in street.nodes if node.parent < 0]
    assert names == scenes.street_names() and len(names) == 21
    for kind, count in (("car", 6), ("pole", 5), ("sign", 2), ("pedestrian", 3), ("cyclist", 1), ("guard_rail", 1)):
        assert sum(name.startswith(kind) for name in names) == count


def test_powers_that_are_no_numbers_get_no_verdict():
    assert crowd.decibels(2.0, 1.0) == pytest.approx(10.0 * np.log10(2.0))
    for powers in ((np.nan, 1.0), (1.0, np.nan), (np.inf, 1.0)):
        with pytest.raises(ValueError, match="must be finite"):
            crowd.decibels(*powers)


def test_no_object_of_the_street_shadows_another(street):
    spans = {}
    for mesh in street.meshes:
        name = root_name(street, mesh.node)
        if name not in scenes.BACKDROPS:
            x, y, _ = np.asarray(street.world_vertices(mesh.id, MID_FRAME)).T
            azimuth = np.degrees(np.arctan2(y, x))
            low, high = spans.get(name, (np.inf, -np.inf))
            spans[name] = min(low, azimuth.min()), max(high, azimuth.max())
    ordered = sorted(spans.values())
    assert len(ordered) == 18
    assert all(after[0] - before[1] > LEAST_GAP for before, after in zip(ordered, ordered[1:]))


def test_meshes_of_the_street_are_fine_enough(street):
    assert coarse_meshes(street, FREQUENCY) == []


def test_an_object_alone_has_the_very_meshes_it_has_in_the_street(street):
    only = scenes.alone("cyclist_18", mirrors=False)
    ids = [mesh.id for mesh in street.meshes if root_name(street, mesh.node) == "cyclist_18"]
    assert len(ids) == len(only.meshes)
    for index, mesh in zip(ids, only.meshes):
        assert np.array_equal(street.world_vertices(index, 0.0), only.world_vertices(mesh.id, 0.0))


def test_screens_before_a_wall_send_nothing_back():
    paths = ep.trace(scenes.alone("wall_left", mirrors=False), scenes.radar(), num_rays=5_000, max_bounces=2)
    whole, wall = ep.received_power(paths).power, ep.received_power(paths.select("T 'wall_left'+ R")).power
    assert wall > 0.0 and whole == pytest.approx(wall, rel=1e-12)


def test_ground_path_of_a_flagged_mirror_has_the_power_of_the_closed_form():
    scene, radar = scenes.city_ground(mirror=True)
    paths = ep.trace(scene, radar, num_rays=100, max_bounces=1)
    found = ep.received_power(paths.select("T 'ground' R")).power
    assert found == pytest.approx(scenes.ground_path_power(radar.transmit_power), rel=IMAGE)


def test_city_has_2400_children_beside_the_person():
    scene, _ = scenes.flat_city()
    assert crowd.scene_size(scene) == 2401 and len({node.name for node in scene.nodes if node.parent < 0}) == 2401


@pytest.mark.parametrize("error, flagged, verdict", [(0.2, False, "right"), (-0.31, False, "MISSED"), (-5.0, True, "flagged"),
                                                     (0.2, True, "flagged"), (0.05, True, "NEEDLESS")])
def test_verdicts(error, flagged, verdict):
    assert crowd.judged(error, flagged) == verdict


def test_gaussian_claims_cover_as_often_as_two_sigma_do():
    draw = np.random.default_rng(3)
    claims = [(Interval(power, power - 0.2, power + 0.2), 0.2) for power in 5.0 + 0.1 * draw.standard_normal(20_000)]
    found = crowd_coverage.covered(claims, [5.0] * len(claims))
    assert found["coverage"] == pytest.approx(0.9545, abs=0.005)
    assert found["coverage_error"] == pytest.approx(np.sqrt(0.9545 * 0.0455 / 20_000), rel=0.05)
    assert crowd_coverage.covered(claims, [6.0] * len(claims))["coverage"] == 0.0


@pytest.mark.parametrize("count, told", [(8, []), (40, ["coverage, the worst: plates, 64 rays: at least 0.8",
                                                         "coverage, plates, 40 runs: 0.9 to 0.98"])])
def test_coverage_is_judged_from_enough_runs_on(count, told):
    """Of 8 runs all hold in two thirds of the cases, .95 to the eighth, which tells nothing of an upper limit of .98."""
    row = {"kind": "plates", "rays": 64, "count": count, "coverage": 1.0}
    found = {"streets": [], "ground": [], "person": {"scatter": 0.0}, "mirrors": [],
             "coverage": {"wanted": (0.9, 0.98), "wanted_of_one": 0.8, "rows": [row], "classes": [row]}}
    assert [one["what"] for one in crowd.verdicts(found) if "coverage" in one["what"]] == told


def test_intervals_of_what_no_ray_has_met_count_too():
    """A patch beside a board gets no ray at 64: its interval is what ep.unresolved says."""
    patch = next(echo for echo in crowd_coverage.all_echoes() if echo.kind == "diffuse, patch far away")
    scene, _ = patch.draw(1)
    interval, half_db = crowd_coverage.power_of(patch, scene, num_rays=64, seed=1)
    assert interval.power == 0.0 < interval.high and half_db == np.inf


def test_scenes_whose_truth_is_not_known_are_no_truth(monkeypatch):
    """Traces of every other seed do not know the power themselves."""
    echo = crowd_coverage.Echo("coherent, drawn", lambda seed: (seed, None), "T 'body' R", differs=True)

    def power_of(_, scene, **settings):
        half_db = 0.05 if scene % 2 else 3.0
        return Interval(float(scene), 0.9 * scene, 1.1 * scene), half_db

    monkeypatch.setattr(crowd_coverage, "power_of", power_of)
    first = crowd_coverage.FIRST_SEED
    wanted = [first + 1, first + 3, first + 5]
    assert crowd_coverage._known(echo, 3, 2 ** 12, 0.1) == [(seed, seed, float(seed)) for seed in wanted]
    with pytest.raises(ValueError, match="0 scenes only is known"):
        crowd_coverage._known(echo, 3, 2 ** 12, 0.01)
    monkeypatch.setattr(crowd_coverage, "all_echoes", lambda: [echo])
    assert crowd_coverage.measure_coverage(quick=False, seeds=3)["left_out"] == {echo.kind: 3}
    monkeypatch.setattr(crowd_coverage, "NUM_SEEDS", {"coherent": 4})
    found = crowd_coverage.measure_coverage(quick=False)
    assert found["left_out"] == {echo.kind: 4} and [row["count"] for row in found["rows"]] == [4] * len(crowd_coverage.RAYS)


@pytest.mark.usefixtures("plain_pictures")
def test_command_writes_numbers_and_picture(tmp_path, capsys, monkeypatch):
    names = ["car_smooth_15", "pole_20", "pedestrian_10", "wall_left"]
    assert set(names) <= set(scenes.street_names())
    monkeypatch.setattr(scenes, "street_names", lambda: names)
    for limit, rays in (("QUICK_RAYS", 4_000), ("QUICK_ALONE_RAYS", 2_000), ("QUICK_PERSON_RAYS", 2_000)):
        monkeypatch.setattr(crowd, limit, rays)
    for limit, least in (("QUICK_SEEDS", 1), ("QUICK_RAYS", (2 ** 9,)), ("QUICK_TRUE_RAYS", 2 ** 12)):
        monkeypatch.setattr(crowd_coverage, limit, least)
    of_class = {echo.of_class: echo for echo in crowd_coverage.all_echoes()}  # the last of each
    monkeypatch.setattr(crowd_coverage, "all_echoes", lambda: list(of_class.values()))
    with coarse_bodies():
        assert main(["bench", "crowd", "--quick", "--out", str(tmp_path / "b")]) == 0
    results = json.loads((tmp_path / "b" / "crowd.json").read_text())
    assert (tmp_path / "b" / "crowd.png").stat().st_size > 10_000
    assert [len(street["rows"]) for street in results["streets"]] == [len(names)] * 2
    assert {row["kind"] for row in results["coverage"]["rows"]} == {echo.kind for echo in of_class.values()}
    assert [row["kind"] for row in results["coverage"]["classes"]] == ["coherent", "diffuse", "ghost", "two bounces",
                                                                        "one batch"]
    assert [row["mirrors"] for row in results["mirrors"]] == [51] and sum(results["mirrors"][0]["paths"]) > 0
    told = capsys.readouterr().out
    assert "person at 40 m among 2400 flat objects" in told and "must reach" in told
