"""Laws that hold for any input: selections, partitions, motions and scene files, drawn at random (hypothesis)."""
import math
from functools import reduce

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

import echopath as ep
from support.files.scene_text import WAVEFORM
from support.radars import build_radar

pytestmark = pytest.mark.hard

FEW = settings(max_examples=30, deadline=None, derandomize=True)
SUM_SHARE = 1e-12    # of the whole signal: sums of doubles in another order
LENGTH = 1e-9        # m: keys of some metres in double precision, through splines of steep pieces
ROTATION = 1e-12     # of a unit quaternion
AREA = 1e-7          # m^2, of up to 1 m^2: corners at UTM coordinates are known to 1e-9 m
MESHES = ("ball", "box", "plate")
UTM = (450_000.0, 5_400_000.0, 120.0)


@pytest.fixture(scope="module")
def paths():
    scene = ep.Scene()
    rough = ep.Material(reflectivity=0.6, scattering=0.7)
    scene.add(ep.actors.sphere(0.4), name="ball", material=rough, position=(5, 0, 0), smooth=True)
    scene.add(ep.actors.box(0.6), name="box", material=rough, position=(6, 1, 0),
              motion=ep.LinearMotion(velocity=(-3.0, 0, 0)))
    scene.add(ep.actors.plate(2.0, 2.0), name="plate", material=rough, position=(8, 0, 0))
    radar = build_radar(receivers=[(0, 0.1, 0)], num_samples=32, num_chirps=4, chirp_interval=1e-4)
    return ep.trace(scene, radar, num_rays=1500)


def touched(paths):
    """Names of the meshes of each path, as a list of sets."""
    names = [mesh.name for mesh in paths.scene.meshes]
    return [{names[paths.mesh_id[k]] for k in range(begin, begin + count)}
            for begin, count in zip(paths.offsets, paths.num_bounces)]


leaves = st.one_of(st.sampled_from(MESHES).map(lambda name: (ep.hits(name), lambda one: name in one["meshes"])),
                   st.integers(1, 4).map(lambda count: (ep.num_bounces == count, lambda one: one["bounces"] == count)),
                   st.integers(0, 5).map(lambda count: (ep.num_bounces > count, lambda one: one["bounces"] > count)))


def joined(children):
    both = st.tuples(children, children)
    return st.one_of(both.map(lambda p: (p[0][0] & p[1][0], lambda one: p[0][1](one) and p[1][1](one))),
                     both.map(lambda p: (p[0][0] | p[1][0], lambda one: p[0][1](one) or p[1][1](one))),
                     children.map(lambda p: (~p[0], lambda one: not p[1](one))))


selections = st.recursive(leaves, joined, max_leaves=6)


@FEW
@given(pair=selections)
def test_selections_take_what_their_logic_takes(paths, pair):
    selection, takes = pair
    records = [{"meshes": meshes, "bounces": int(count)} for meshes, count in zip(touched(paths), paths.num_bounces)]
    expected = np.array([takes(one) for one in records])
    assert np.array_equal(paths.select(selection).weight, np.asarray(paths.weight)[expected])


@FEW
@given(pair=selections)
def test_selections_are_their_own_text(paths, pair):
    again = ep.Selection(str(pair[0]))
    assert np.array_equal(paths.select(again).weight, paths.select(pair[0]).weight)


@FEW
@given(chosen=st.lists(selections, min_size=1, max_size=4))
def test_parts_are_disjoint_complete_and_add_up(paths, chosen):
    parts = {f"part {k}": pair[0] for k, pair in enumerate(chosen)}
    split = paths.partition(parts)
    assert sum(part.num_paths for part in split.values()) == paths.num_paths
    earlier = []
    for name, selection in parts.items():  # the first that takes a path has it
        left = reduce(lambda a, b: a & ~b, earlier, selection)
        assert split[name].num_paths == paths.select(left).num_paths
        earlier.append(selection)
    taken = reduce(lambda a, b: a | b, parts.values())
    assert split["other"].num_paths == paths.select(~taken).num_paths
    whole = ep.synthesize(paths)
    assert np.abs(sum(ep.decompose(paths, parts=parts).values()) - whole).max() <= SUM_SHARE * np.abs(whole).max()


steps = st.lists(st.floats(1e-4, 10.0), min_size=1, max_size=6)
coordinates = st.floats(-100.0, 100.0)
speeds = st.lists(st.floats(-300.0, 300.0), min_size=3, max_size=3)


def moved(corners, motion):
    """Scene of one triangle."""
    scene = ep.Scene()
    scene.add(ep.Mesh(corners, [[0, 1, 2]]), name="triangle", material="metal", motion=motion)
    return scene


def keys_of(gaps, draw_points):
    times = np.concatenate([[0.0], np.cumsum(gaps)])
    return times, np.array(draw_points[:3 * len(times)]).reshape(-1, 3)


@FEW
@given(gaps=steps, points=st.lists(coordinates, min_size=21, max_size=21),
       interpolation=st.sampled_from(["cubic", "linear", "monotone"]))
def test_keyframes_pass_through_their_points(gaps, points, interpolation):
    times, keys = keys_of(gaps, points)
    motion = ep.KeyframeMotion(times=times, translations=keys, interpolation=interpolation)
    scene = moved(np.eye(3), motion)
    for time, point in zip(times, keys):
        np.testing.assert_allclose(scene.world_vertices(0, time), np.eye(3) + point, rtol=0, atol=LENGTH)


@FEW
@given(gaps=steps, numbers=st.lists(st.floats(-1.0, 1.0), min_size=28, max_size=28), share=st.floats(0.0, 1.0),
       interpolation=st.sampled_from(["cubic", "linear", "monotone"]))
def test_turns_stay_turns(gaps, numbers, share, interpolation):
    times = np.concatenate([[0.0], np.cumsum(gaps)])
    quaternions = np.array(numbers[:4 * len(times)]).reshape(-1, 4) + [1.5, 0, 0, 0]
    quaternions /= np.linalg.norm(quaternions, axis=1, keepdims=True)
    scene = moved(np.eye(3), ep.KeyframeMotion(times=times, rotations=quaternions, interpolation=interpolation))
    turned = np.asarray(scene.world_vertices(0, share * times[-1]))
    np.testing.assert_allclose(turned @ turned.T, np.eye(3), rtol=0, atol=10 * ROTATION)
    assert np.linalg.det(turned) > 0


@FEW
@given(velocity=speeds, spin=speeds, time=st.floats(-10.0, 10.0))
def test_linear_motion_is_a_shift_and_a_turn(velocity, spin, time):
    scene = moved([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]], ep.LinearMotion(velocity=velocity, angular_velocity=spin))
    points = np.asarray(scene.world_vertices(0, time))
    np.testing.assert_allclose(points[0], time * np.array(velocity), rtol=0, atol=LENGTH)
    np.testing.assert_allclose(np.linalg.norm(points[1:] - points[0], axis=1), 1.0, rtol=0, atol=LENGTH)


RADAR = """
[[radar.transmitters]]
position = [0.0, 0.0, 1.0]
[[radar.receivers]]
position = [0.0, 0.0, 1.0]
"""
OBJECT = """
[[objects]]
name = "{name}"
actor = "plate"
parameters = {{width = {width!r}, height = {height!r}}}
material = {{conductor = true}}
position = {position}
yaw_deg = {yaw!r}
motion = {{kind = "linear", velocity = {velocity}}}
"""
sizes = st.floats(1e-3, 1e3)
triples = st.lists(st.floats(-1e6, 1e6), min_size=3, max_size=3)


@FEW
@given(width=sizes, height=sizes, position=triples, yaw=st.floats(-720.0, 720.0), velocity=triples)
def test_scene_files_place_what_they_say(tmp_path_factory, width, height, position, yaw, velocity):
    path = tmp_path_factory.mktemp("scene") / "scene.toml"
    text = OBJECT.format(name="plate", width=width, height=height, position=position, yaw=yaw, velocity=velocity)
    path.write_text(RADAR + WAVEFORM + text, encoding="utf-8")
    vertices = np.asarray(ep.load_scene(path).scene.world_vertices(0, 2.0))
    size = 1.0 + np.abs(position).max() + 2 * np.abs(velocity).max()
    np.testing.assert_allclose(vertices.mean(axis=0), np.array(position) + 2 * np.array(velocity), rtol=0, atol=1e-12 * size)
    across = np.hypot(width / 2 * math.sin(math.radians(yaw)), width / 2 * math.cos(math.radians(yaw)))
    reach = np.abs(vertices - vertices.mean(axis=0))
    np.testing.assert_allclose(np.hypot(reach[:, 0], reach[:, 1]), across, rtol=0, atol=1e-12 * size + 1e-9 * across)
    np.testing.assert_allclose(reach[:, 2], height / 2, rtol=0, atol=1e-12 * size + 1e-9 * height)


junk = st.text(alphabet="[]={}\"'#\n .,abcdefnorstuvwxyz_0123456789+-e", max_size=200)


@settings(max_examples=75, deadline=None, derandomize=True)
@given(text=junk, behind=st.booleans())
def test_no_scene_file_is_worse_than_an_error(tmp_path_factory, text, behind):
    path = tmp_path_factory.mktemp("junk") / "scene.toml"
    path.write_text((RADAR + WAVEFORM if behind else "") + text, encoding="utf-8")
    try:
        ep.load_scene(path)
    except (ValueError, OSError) as error:
        assert str(error)


centimetres = st.integers(-150, 150).map(lambda number: 0.01 * number)
sides = st.integers(10, 200).map(lambda number: 0.01 * number)
turns = st.lists(st.floats(-1.0, 1.0), min_size=4, max_size=4).filter(lambda q: math.hypot(*q) > 0.1)


def rectangle(corner, size, height: float, cells: int) -> ep.Mesh:
    """A flat mesh over [corner, corner + size] at `height`, of cells x cells pairs of triangles."""
    across, up = (start + length * np.arange(cells + 1) / cells for start, length in zip(corner, size))
    vertices = [(x, y, height) for y in up for x in across]
    lower = [j * (cells + 1) + i for j in range(cells) for i in range(cells)]
    pairs = [[(a, a + 1, a + cells + 2), (a, a + cells + 2, a + cells + 1)] for a in lower]
    return ep.Mesh(vertices, [triangle for pair in pairs for triangle in pair])


def turned_scene(turn, offset) -> ep.Scene:
    """A scene whose node "both" is turned by a quaternion of any length and moved by `offset` (m)."""
    scene = ep.Scene()
    turned = np.array(turn) / math.hypot(*turn)
    motion = ep.KeyframeMotion(times=[-1.0, 1.0], translations=[offset] * 2, rotations=[turned] * 2)
    scene.add(name="both", motion=motion)
    return scene


@FEW
@given(corners=st.tuples(centimetres, centimetres), sizes=st.tuples(sides, sides), turn=turns, gap=st.floats(-2e-5, 2e-5),
       cells=st.tuples(st.integers(1, 6), st.integers(1, 6)), offset=st.sampled_from([(0.0, 0.0, 0.0), UTM]))
def test_overlaps_have_the_area_of_the_rectangle_that_two_have_in_common(corners, sizes, turn, gap, cells, offset):
    scene = turned_scene(turn, offset)
    scene.add(rectangle((0.0, 0.0), (1.0, 1.0), 0.0, cells[0]), name="one", parent="both", material="metal")
    scene.add(rectangle(corners, sizes, gap, cells[1]), name="two", parent="both", material="concrete")
    common = math.prod(max(0.0, min(1.0, low + size) - max(0.0, low)) for low, size in zip(corners, sizes))
    found = scene.coplanar_overlaps()
    if abs(abs(gap) - 1e-5) < 2 * LENGTH:
        return
    assert [overlap.names for overlap in found] == ([("both/one", "both/two")] if common > 0.0 and abs(gap) < 1e-5 else [])
    for overlap in found:
        assert abs(overlap.area - common) <= AREA and abs(overlap.distance - abs(gap)) <= 2 * LENGTH


@FEW
@given(copies=st.lists(st.integers(0, 3), min_size=1, max_size=40), turn=turns, gap=st.sampled_from([2e-6, 3e-6]),
       cells=st.integers(1, 4), offset=st.sampled_from([(0.0, 0.0, 0.0), UTM]))
def test_copies_at_one_place_are_told_of_once_each(copies, turn, gap, cells, offset):
    scene = turned_scene(turn, offset)
    for number, level in enumerate(copies):
        mesh = rectangle((0.0, 0.0), (1.0, 0.5), level * gap, cells)
        scene.add(mesh, name=str(number), parent="both", material="metal")
    first_of = {level: copies.index(level) for level in copies}
    firsts = sorted(first_of.values())
    between = [(one, two) for one in firsts for two in firsts if one < two]
    of_copies = [(first_of[level], number) for number, level in enumerate(copies) if first_of[level] != number]
    found = scene.coplanar_overlaps()
    assert [overlap.mesh_ids for overlap in found] == sorted(between + of_copies)
    for overlap in found:
        one, two = (copies[mesh_id] for mesh_id in overlap.mesh_ids)
        assert abs(overlap.area - 0.5) <= AREA and abs(overlap.distance - abs(two - one) * gap) <= 2 * LENGTH
