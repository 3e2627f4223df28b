"""What records know of hits on edges: names, files, expressions, and the points that waves from edge to edge pass."""
import pickle

import numpy as np
import pytest

import echopath as ep
from echopath.paths.edge_hits import edge_hits
from support.scenes.edge_scenes import FREQUENCY, box, fields, on_edges, radar_at, scene_of, sheet, trace


@pytest.fixture(scope="module")
def of_a_box():
    return trace(scene_of(box((0.4, 0.5, 0.6)), yaw=0.4), radar_at(), num_rays=2000)


def test_paths_name_a_point_on_an_edge(of_a_box):
    edges = of_a_box.select("T E R")
    assert edges.num_paths > 0 and set(edges.num_bounces) == {1}
    first = np.asarray(edges.offsets)
    u, v = np.asarray(edges.u)[first], np.asarray(edges.v)[first]
    assert np.all((u == 0.0) | (v == 0.0) | (u.astype(float) + v == 1.0))
    corner = edges.points(0.0)[first] - np.mean(edges.points(0.0)[first], axis=0)
    assert np.ptp(corner, axis=0) == pytest.approx([0.56, 0.61, 0.58], abs=0.05)


def test_only_edges_that_both_antennas_see_make_echoes(of_a_box):
    """Three faces of the box are in sight, with nine of its twelve edges."""
    scene = scene_of(box((0.4, 0.5, 0.6)), yaw=0.4)
    triangles = np.unique(np.asarray(on_edges(of_a_box).triangle_id)[np.asarray(on_edges(of_a_box).offsets)])
    assert len(triangles) >= 5
    scene.add(box((0.01, 5.0, 5.0)), name="screen", position=(4.0, 0.0, 0.0), material=ep.Material.metal())
    hidden = trace(scene, radar_at())
    assert hidden.select("T E'plate' R").num_paths == 0 < hidden.select("T E'screen' R").num_paths


def test_mirrors_and_edges_count_as_bounces():
    """An edge over a floor has four ways, of which the one that is mirrored twice has three bounces."""
    scene = scene_of(box((0.1, 0.5, 0.6)), yaw=0.4)
    floor = np.array([(-1.0, -5.0, -1.0), (12.0, -5.0, -1.0), (12.0, 5.0, -1.0), (-1.0, 5.0, -1.0)])
    scene.add(ep.Mesh(floor, np.array([(0, 1, 2), (0, 2, 3)])), name="floor", material=ep.Material.metal(mirror=True))
    found = {most: on_edges(trace(scene, radar_at(), num_rays=2000, max_bounces=most)) for most in (1, 2, 3)}
    assert {most: int(np.max(paths.num_bounces)) for most, paths in found.items()} == {1: 1, 2: 2, 3: 3}
    assert found[2].select("T 'floor' E R").num_paths == found[2].select("T (E) 'floor' R").num_paths > 0
    assert found[3].select("T 'floor' (E) 'floor' R").num_paths > 0


def test_expressions_and_partitions_know_them(of_a_box):
    edges = of_a_box.select("T E R")
    assert edges.num_paths == of_a_box.select("T E'plate' R").num_paths == of_a_box.select("T ['plate'] R & T E R").num_paths
    assert (of_a_box.select("T S R").num_paths + edges.num_paths == of_a_box.select("T . R").num_paths
            == of_a_box.num_paths - of_a_box.select("T E E+ R").num_paths)
    assert of_a_box.select("T D R").num_paths == of_a_box.select("T E S R").num_paths == 0
    radar = of_a_box.radar
    parts = ep.decompose(of_a_box, radar, {"edges": "T E R"})
    assert parts["edges"] == pytest.approx(ep.synthesize(edges, radar, tolerance=1e-9), abs=1e-6 * np.abs(parts["edges"]).max())
    assert list(of_a_box.to_dataframe()["events"]).count("E") == edges.num_paths


def test_hits_on_edges_of_one_path_are_those_of_its_expression(of_a_box):
    is_single = np.asarray(ep.Selection("T E R").matches(of_a_box))
    for path in (int(np.flatnonzero(is_single)[0]), int(np.flatnonzero(~is_single)[0])):
        assert (edge_hits(of_a_box, slice(path, path + 1)).tolist() == [1]) == is_single[path]


def test_echoes_grow_with_the_root_of_both_gains(of_a_box):
    """Of edges alone, and of waves from edge to edge."""
    radar = of_a_box.radar
    gained = radar.replace(transmitters=[one.replace(pattern=ep.Isotropic(0.25)) for one in radar.transmitters],
                           receivers=[one.replace(pattern=ep.Isotropic(0.36)) for one in radar.receivers])
    for selection in ("T E R", "T E E+ R"):
        paths = of_a_box.select(selection)
        before = ep.synthesize(paths, radar, tolerance=1e-9)
        assert np.abs(before).max() > 0.0
        assert ep.synthesize(paths, gained, tolerance=1e-9) == pytest.approx(0.3 * before, abs=1e-6 * np.abs(before).max())


def test_files_and_pickles_keep_them(of_a_box, tmp_path):
    of_a_box.save(tmp_path / "box.h5")
    for again in (ep.Paths.load(tmp_path / "box.h5"), pickle.loads(pickle.dumps(of_a_box))):
        assert again.frame.edges
        assert np.array_equal(again.flags, of_a_box.flags)
        assert np.array_equal(on_edges(again).amplitude, on_edges(of_a_box).amplitude)


def arrays_of(paths) -> tuple[np.ndarray, dict]:
    """(hits, {name: column}) of paths, which a test may change."""
    names = ("offsets", "num_bounces", "diffuse", "weight", "stratum", "batch", "flags", "curved_cell", "jones")
    columns = {name: np.array(getattr(paths, name)) for name in names}
    return np.array(paths.hits), {name: value for name, value in columns.items() if len(value)}


def test_a_record_whose_edge_has_no_mirror_behind_it_is_refused(of_a_box):
    hits, columns = arrays_of(of_a_box)
    columns["flags"][np.flatnonzero(columns["flags"] & 4)[0]] |= 32
    with pytest.raises(ValueError, match="flags: must name an edge before a mirror"):
        ep.Paths.from_arrays(hits=hits, **columns, scene=of_a_box.scene, radar=of_a_box.radar, frame=of_a_box.frame)


def test_a_record_whose_edge_is_none_is_refused(of_a_box):
    hits, columns = arrays_of(of_a_box)
    edge = int(np.flatnonzero(columns["flags"] & 4)[0])
    hits["u"][columns["offsets"][edge]] = hits["v"][columns["offsets"][edge]] = 0.25
    with pytest.raises(ValueError, match="flags: must name hits on sharp edges"):
        ep.Paths.from_arrays(hits=hits, **columns, scene=of_a_box.scene, radar=of_a_box.radar, frame=of_a_box.frame)


def test_the_frame_stays_valid_while_nothing_moves(of_a_box):
    report = ep.validity(of_a_box, of_a_box.radar)
    assert report.ok
    assert report.occluded_share == report.turned_share == report.left_share == 0.0


@pytest.fixture(scope="module")
def of_a_small_sheet():
    motion = ep.LinearMotion(velocity=(1.0, -2.0, 0.5), angular_velocity=(0.0, 0.3, 10.0))
    return trace(scene_of(sheet(0.3, 0.4), yaw=1.0, motion=motion), radar_at(polarization=(0.0, 1.0, 0.0), num_chirps=64))


def test_paths_from_edge_to_edge_name_all_their_points(of_a_small_sheet, tmp_path):
    chains = of_a_small_sheet.select("T E E+ R")
    assert chains.num_paths == of_a_small_sheet.select("T E{2,4} R").num_paths > 0
    assert set(chains.num_bounces) <= {2, 3, 4} and set(chains.to_dataframe()["events"]) <= {"EE", "EEE", "EEEE"}
    first, second = (chains.points(chains.frame.trace_time)[np.asarray(chains.offsets) + k] for k in (0, 1))
    assert np.linalg.norm(first - second, axis=1).max() < 0.5
    chains.save(tmp_path / "chains.h5")
    assert np.array_equal(ep.Paths.load(tmp_path / "chains.h5").amplitude, chains.amplitude)


def test_waves_from_edge_to_edge_follow_a_turning_plate(of_a_small_sheet):
    """The points stay where they are on the plate; new ones lie where the cone is by then."""
    later = trace(of_a_small_sheet.scene, of_a_small_sheet.radar, start_time=0.003)
    there = [fields(paths.select("T E E R"), later.frame.trace_time).sum() for paths in (of_a_small_sheet, later)]
    assert abs(there[0] - there[1]) < 0.1 * abs(there[1])


def test_only_faces_of_few_wavelengths_carry_waves_from_edge_to_edge():
    """From one edge to the other across a sheet that is wider than 40 wavelengths there is none."""
    wavelength = 299792458.0 / FREQUENCY
    for size, has_some in ((1.1, True), (1.3, False)):
        chains = trace(scene_of(sheet(2.0, size)), radar_at((2.0, 0.0, 7.5), polarization=(1.0, 0.0, 0.0))).select("T E E R")
        first, second = (chains.points(0.0)[np.asarray(chains.offsets) + k] for k in (0, 1))
        ways = np.linalg.norm(first - second, axis=1)
        assert ways.max(initial=0.0) < 40.0 * wavelength and bool(np.any(ways > 35.0 * wavelength)) == has_some
