"""The record of a trace against a slow independent ray-triangle loop, and its rules as Python sees them."""
import os
import subprocess
import sys

import numpy as np
import pytest

import echopath as ep
from echopath.actors import shapes
from support.radars import build_radar
from support.references.slow_rays import closest_hit, segment_is_free

BARYCENTRIC_TOLERANCE = 2e-3  # single precision of a ray over some metres on triangles of decimetres
ON_RAY_TOLERANCE = 1e-4       # m, likewise
ROUNDING = 1e-12              # m: sums of lengths of some metres in double precision


def make_radar(transmitter=(0.0, 0.0, 0.0), receiver=(0.0, 0.3, 0.0), **settings):
    return build_radar([transmitter], [receiver], num_samples=512, **settings)


def triangle_soup(seed, count=60):
    rng = np.random.default_rng(seed)
    centres = rng.uniform((3, -2, -2), (7, 2, 2), (count, 3))
    return centres[:, None, :] + rng.uniform(-0.6, 0.6, (count, 3, 3))


def soup_scene(soup, **material):
    """Each triangle is a mesh of its own, in one object."""
    scene = ep.Scene()
    scene.add(None, name="soup")
    for i, corners in enumerate(soup):
        scene.add(ep.Mesh(corners, [[0, 1, 2]]), name=f"t{i}", parent="soup", material=ep.Material(**material))
    return scene


def chains(paths):
    """Hits of each path as rows (mesh_id, triangle_id, u, v)."""
    for offset, count in zip(paths.offsets, paths.num_bounces):
        yield [paths.hits[k] for k in range(offset, offset + count)]


@pytest.mark.hard
def test_recorded_hits_are_those_of_a_slow_loop():
    soup = triangle_soup(seed=3)
    paths = ep.trace(soup_scene(soup, reflectivity=0.5, scattering=0.6), make_radar(), num_rays=3000, max_bounces=3)
    points = paths.points(paths.frame.trace_time)
    checked = 0
    for path, chain in enumerate(chains(paths)):
        if paths.flags[path] & 1:
            continue  # a reversal was not traced in its direction of travel
        start = np.zeros(3)
        for k, hit in enumerate(chain):
            corners = soup[hit["mesh_id"]]
            u, v = float(hit["u"]), float(hit["v"])
            point = (1 - u - v) * corners[0] + u * corners[1] + v * corners[2]
            assert np.allclose(points[paths.offsets[path] + k], point, atol=ROUNDING)
            direction = (point - start) / np.linalg.norm(point - start)
            index, slow_u, slow_v, distance = closest_hit(start + 1e-4 * direction, direction, soup)
            origin, start = start, point
            if min(u, v, 1 - u - v) < BARYCENTRIC_TOLERANCE:
                continue  # at an edge either neighbour may be met
            assert index == hit["mesh_id"] and hit["triangle_id"] == 0
            assert abs(slow_u - u) < BARYCENTRIC_TOLERANCE and abs(slow_v - v) < BARYCENTRIC_TOLERANCE
            assert np.linalg.norm(origin + 1e-4 * direction + distance * direction - point) < ON_RAY_TOLERANCE
            checked += 1
    assert checked > 500


@pytest.mark.hard
def test_every_path_ends_in_view_of_the_receiver():
    soup = triangle_soup(seed=4)
    radar = make_radar()
    paths = ep.trace(soup_scene(soup, reflectivity=0.5, scattering=1.0), radar, num_rays=3000, max_bounces=2)
    points = paths.points(0.0)
    last = points[paths.offsets + paths.num_bounces - 1]
    blocked = sum(not segment_is_free(point, np.array([0.0, 0.3, 0.0]), soup) for point in last)
    assert len(last) > 300
    assert blocked <= 0.002 * len(last)  # rays that graze an edge within the margin of the slow test


def test_lengths_are_those_of_the_points():
    paths = ep.trace(soup_scene(triangle_soup(seed=5), reflectivity=0.5, scattering=1.0), make_radar(), num_rays=2000)
    points = paths.points(0.0)
    lengths = paths.lengths([0.0])[0]
    for path in range(0, paths.num_paths, 7):
        hits = points[paths.offsets[path]:paths.offsets[path] + paths.num_bounces[path]]
        corners = np.vstack([[0, 0, 0], hits, [0, 0.3, 0]])
        expected = np.linalg.norm(np.diff(corners, axis=0), axis=1).sum()
        assert abs(lengths[path] - expected) < ROUNDING


def test_columns_are_read_only_views():
    paths = ep.trace(soup_scene(triangle_soup(seed=6), reflectivity=0.5, scattering=1.0), make_radar(), num_rays=500)
    assert paths.mesh_id.base is not None and paths.mesh_id.strides == (16,)
    assert np.array_equal(paths.mesh_id, paths.hits["mesh_id"])
    for name in ("mesh_id", "u", "offsets", "weight", "diffuse"):
        with pytest.raises(ValueError):
            getattr(paths, name)[0] = 0
    column = paths.weight
    expected = column.copy()
    del paths  # the view keeps the record alive
    assert np.array_equal(column, expected)


def with_batches(frame, count):
    """The frame with another count of batches."""
    names = ("start_time", "trace_time", "transmitter", "receiver", "strata", "statistics", *ep._core.RECORD_SETTINGS)
    return ep.TraceFrame(**{name: getattr(frame, name) for name in names} | {"num_batches": count})


def test_arrays_give_the_paths_back():
    paths = ep.trace(soup_scene(triangle_soup(seed=7), reflectivity=0.5, scattering=0.5), make_radar(), num_rays=2000)
    columns = {name: np.array(getattr(paths, name)) for name in
               ("hits", "offsets", "num_bounces", "diffuse", "weight", "stratum", "batch", "flags", "jones")}
    again = ep.Paths.from_arrays(**columns, scene=paths.scene, radar=paths.radar, frame=paths.frame)
    assert np.array_equal(again.amplitude, paths.amplitude)
    with pytest.raises(ValueError, match="jones: must be given for a frame that follows field vectors"):
        ep.Paths.from_arrays(**columns | {"jones": None}, scene=paths.scene, radar=paths.radar, frame=paths.frame)
    for name, value, rule in (("offsets", 2 ** 63 - 1, "must lead to hits"), ("diffuse", 1 << 40, "must have no bits beyond"),
                              ("weight", np.nan, "must be finite"), ("num_bounces", 0, "must lie in")):
        broken = columns | {name: columns[name].copy()}
        broken[name][0] = value
        with pytest.raises(ValueError, match=f"{name}: {rule}"):
            ep.Paths.from_arrays(**broken, scene=paths.scene, radar=paths.radar, frame=paths.frame)
    for count in (0, 65):
        frame = with_batches(paths.frame, count)
        with pytest.raises(ValueError, match=f"num_batches: must lie in .*, got {count}"):
            ep.Paths.from_arrays(**columns, scene=paths.scene, radar=paths.radar, frame=frame)
    off = columns["hits"].copy()
    for u in (2.0, -1e-3):
        off["u"][0] = u
        with pytest.raises(ValueError, match="u and v: must not be negative"):
            ep.Paths.from_arrays(**columns | {"hits": off}, scene=paths.scene, radar=paths.radar, frame=paths.frame)
    off["u"][0] = -1e-7  # rounding, on the border of two triangles
    ep.Paths.from_arrays(**columns | {"hits": off}, scene=paths.scene, radar=paths.radar, frame=paths.frame)
    columns["offsets"][0] = len(columns["hits"])
    with pytest.raises(ValueError, match="offsets: must lead to hits"):
        ep.Paths.from_arrays(**columns, scene=paths.scene, radar=paths.radar, frame=paths.frame)


@pytest.mark.hard
def test_empty_scene_gives_zeros():
    radar = make_radar(num_chirps=4)
    paths = ep.trace(ep.Scene(), radar, num_rays=100)
    assert paths.num_paths == 0 and paths.amplitude.shape == (0,) and paths.points(0.0).shape == (0, 3)
    cube = ep.synthesize(paths, radar)
    assert cube.shape == (1, 1, 4, 512) and not cube.any()
    parts = ep.decompose(paths, radar, {"direct": "T . R"})
    assert set(parts) == {"direct", "other"} and not any(part.any() for part in parts.values())


@pytest.mark.parametrize("keywords, text", [
    ({"num_rays": 0}, "num_rays: must be a whole number from 1 to 10000000000, got 0"),
    ({"max_bounces": 0}, "max_bounces"),
    ({"max_bounces": 65}, "max_bounces"),
    ({"start_time": float("inf")}, "start_time"),
])
def test_bad_settings_are_named(keywords, text):
    with pytest.raises(ValueError, match=text):
        ep.trace(ep.Scene(), make_radar(), **keywords)


def test_unknown_keyword_names_the_nearest():
    with pytest.raises(TypeError, match="num_ray.*num_rays"):
        ep.trace(ep.Scene(), make_radar(), num_ray=10)


def test_antenna_index_out_of_range():
    paths = ep.trace(soup_scene(triangle_soup(seed=8), reflectivity=0.5, scattering=1.0), make_radar(), num_rays=100)
    with pytest.raises(IndexError, match="rx: must lie in 0 to 0, got 1"):
        paths.amplitudes([0.0], 0, 1)


def test_facets_are_told_but_ask_for_no_rays():
    """The facets of a coarse ball leave more than is wanted; a fine ball needs as many rays."""
    paths = {}
    for edge in (0.012, 0.06):
        scene, ball = ep.Scene(), shapes.sphere(0.4, edge=edge)
        scene.add(ball, name="ball", material=ep.Material.metal(), position=(15.0, 0.0, 0.0), smooth=True)
        paths[edge] = ep.trace(scene, make_radar(), target_error_db=0.05, max_bounces=1)
    fine, coarse = (ep.received_power(one).interval_db for one in paths.values())
    assert fine <= 0.05 and 2.0 * fine < coarse <= 0.15
    assert len({one.frame.statistics.num_rays for one in paths.values()}) == 1
    assert max(one.frame.error_db for one in paths.values()) <= 0.05


def test_hits_stay_the_same_bits_when_the_program_changes_its_environment():
    """The instruction set is asked for before the program starts: what it does to its environment later asks for none."""
    code = """
import os
import numpy as np
import echopath as ep

def hits():
    scene = ep.Scene()
    scene.add(ep.actors.pedestrian(height=1.78, speed=1.4), name="walker", position=(8.0, 0.5, 0.0))
    waveform = ep.ChirpSequence(start_frequency=77e9, num_chirps=2, num_samples=64)
    radar = ep.Radar(waveform, transmitters=[ep.Antenna((0, 0, 1))], receivers=[ep.Antenna((0, 0.01, 1))])
    return ep.trace(scene, radar, num_rays=20_000).hits

before = hits()
del os.environ["ECHOPATH_INSTRUCTION_SET"]
after = hits()
assert len(before) > 10_000 and np.array_equal(before, after)
"""
    subprocess.run([sys.executable, "-c", code], env=os.environ | {"ECHOPATH_INSTRUCTION_SET": "baseline"}, check=True)
