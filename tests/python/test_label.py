"""Selections: path expressions and their algebra against a slow matcher written from the grammar."""
import random

import echopath as ep
import numpy as np
import pytest
from echopath import _core
from support.slow_matcher import glob_takes, slow_matches

GROUPS = ["street", "pedestrian", "pedestrian/arms"]
MESHES = ["street/wall_left", "street/wall_right", "street/floor", "pedestrian/torso", "pedestrian/arms/left",
          "pedestrian/arms/right"]
GLOBS = ["street", "street/wall*", "*left", "pedestrian/*", "pedestrian/arms", "*/arms/righ?", "*", "*e*"]
HIT = np.dtype([("mesh_id", np.uint32), ("triangle_id", np.uint32), ("u", np.float32), ("v", np.float32)])


@pytest.fixture(scope="module")
def street():
    scene = ep.Scene()
    triangle = ep.Mesh([[5, -1, -1], [5, 1, -1], [5, 0, 1]], [[0, 1, 2]])
    for name in GROUPS + MESHES:
        parent, _, own = name.rpartition("/")
        is_mesh = name in MESHES
        scene.add(triangle if is_mesh else None, name=own, parent=parent or None,
                  material=ep.Material.metal() if is_mesh else None)
    assert [mesh.name for mesh in scene.meshes] == MESHES
    return scene


@pytest.fixture(scope="module")
def make_paths(street):
    """make_paths([[("street/floor", "S"), ...], ...]) -> ep.Paths"""
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=16, sampling_rate=1e6, num_chirps=2,
                                chirp_interval=60e-6)
    radar = ep.Radar(waveform, transmitters=[ep.Antenna((0, 0, 0))], receivers=[ep.Antenna((0, 0.01, 0))])
    frame = ep.trace(street, radar, num_rays=100).frame

    def make(routes):
        counts = np.array([len(route) for route in routes], np.uint8)
        hits = np.zeros(int(counts.sum(dtype=int)), HIT)
        hits["mesh_id"] = [MESHES.index(name) for route in routes for name, _ in route]
        diffuse = [sum((event == "D") << k for k, (_, event) in enumerate(route)) for route in routes]
        zeros = np.zeros(len(routes))
        return ep.Paths.from_arrays(
            hits=hits, offsets=np.cumsum(counts, dtype=np.int64) - counts, num_bounces=counts,
            diffuse=np.array(diffuse, np.uint64), weight=zeros.astype(np.complex64), stratum=zeros.astype(np.uint8),
            batch=zeros.astype(np.uint8), flags=zeros.astype(np.uint32), scene=street, radar=radar, frame=frame)

    return make


def random_routes(count, max_hits, seed):
    draw = random.Random(seed)
    return [[(draw.choice(MESHES), draw.choice("SD")) for _ in range(draw.randint(1, max_hits))] for _ in range(count)]


def random_expression(draw: random.Random) -> str:
    def choice(depth):
        return " | ".join(sequence(depth) for _ in range(draw.choice([1, 1, 2])))

    def sequence(depth):
        return " ".join(repeat(depth) for _ in range(draw.randint(1, 3)))

    def repeat(depth):
        low = draw.randint(0, 2)
        counts = f"{{{low}}}", f"{{{low},}}", f"{{{low}, {low + draw.randint(0, 2)}}}"
        atom = f"({choice(depth - 1)})" if depth and draw.random() < 0.3 else hit()
        return atom + draw.choice(["", "", "", "*", "+", "?", *counts])

    def hit():
        globs = " ".join(f"'{draw.choice(GLOBS)}'" for _ in range(draw.randint(1, 3)))
        meshes = draw.choice([f"'{draw.choice(GLOBS)}'", f"[{globs}]", f"[^ {globs}]"])
        return draw.choice([".", "(S)", "(D)", meshes, "S" + meshes, "D" + meshes])

    return f"T {choice(2)} R"


def matches(selection, paths):
    return ep.Selection(selection).matches(paths)


def test_selections_agree_with_the_slow_matcher_on_random_expressions(make_paths):
    routes, per_expression = random_routes(10_000, 6, seed=1), 40
    paths, draw, num_taken = make_paths(routes), random.Random(2), 0
    for index in range(250):
        text = random_expression(draw)
        taken = matches(text, paths)
        assert taken.dtype == bool and taken.shape == (len(routes),)
        for path in range(index * per_expression, (index + 1) * per_expression):
            assert taken[path] == slow_matches(text, routes[path]), (text, routes[path])
            num_taken += taken[path]
    assert 0.05 < num_taken / len(routes) < 0.5  # both answers are common, else the comparison proves little


def test_globs_take_names_and_ancestors(make_paths):
    paths = make_paths([[(name, "S")] for name in MESHES])
    for glob in GLOBS:
        assert matches(f"T '{glob}' R", paths).tolist() == [glob_takes(glob, name) for name in MESHES]


def test_hits_is_touching_at_least_once(make_paths):
    routes = random_routes(1000, 5, seed=3)
    for glob in ("street/wall*", "pedestrian/arms"):
        wanted = [any(glob_takes(glob, name) for name, _ in route) for route in routes]
        assert ep.hits(glob).matches(make_paths(routes)).tolist() == wanted


def test_first_and_last_are_the_ends_of_a_path(make_paths):
    routes = random_routes(1000, 5, seed=11)
    paths = make_paths(routes)
    for glob in ("street/wall*", "pedestrian/arms", "*left"):
        assert ep.first(glob).matches(paths).tolist() == [glob_takes(glob, route[0][0]) for route in routes]
        assert ep.last(glob).matches(paths).tolist() == [glob_takes(glob, route[-1][0]) for route in routes]
    assert str(ep.first("street") & ep.last("street")) == "(T 'street' .* R) & (T .* 'street' R)"


@pytest.mark.parametrize("number", [-1, 0, 1, 3, 6, 64, 65, 10**12])
def test_num_bounces_compares_like_a_number(make_paths, number):
    paths = make_paths(random_routes(500, 6, seed=4))
    counts = paths.num_bounces.astype(np.int64)
    assert np.array_equal((ep.num_bounces == number).matches(paths), counts == number)
    assert np.array_equal((ep.num_bounces != number).matches(paths), counts != number)
    assert np.array_equal((ep.num_bounces < number).matches(paths), counts < number)
    assert np.array_equal((ep.num_bounces <= number).matches(paths), counts <= number)
    assert np.array_equal((ep.num_bounces > number).matches(paths), counts > number)
    assert np.array_equal((ep.num_bounces >= number).matches(paths), counts >= number)
    assert np.array_equal((number < ep.num_bounces).matches(paths), number < counts)


def test_algebra_is_that_of_sets(make_paths):
    paths = make_paths(random_routes(1000, 5, seed=5))
    a, b = ep.hits("pedestrian/arms"), "T .* D R"
    in_a, in_b = matches(a, paths), matches(b, paths)
    assert np.array_equal((a & b).matches(paths), in_a & in_b)
    assert np.array_equal((b & a).matches(paths), in_a & in_b)
    assert np.array_equal((a | b).matches(paths), in_a | in_b)
    assert np.array_equal((b | ~a).matches(paths), in_b | ~in_a)
    assert np.array_equal((~(a | b)).matches(paths), (~a & ~ep.Selection(b)).matches(paths))


def test_text_stands_wherever_a_selection_does(make_paths):
    paths = make_paths(random_routes(300, 3, seed=6))
    text = "T 'pedestrian' R"
    selection = ep.hits("pedestrian") & (ep.num_bounces == 1)
    assert paths.select(text).num_paths == matches(text, paths).sum() > 0
    assert paths.select(selection).num_paths == paths.select(text).num_paths


def test_partition_is_disjoint_and_complete(make_paths):
    paths = make_paths(random_routes(2000, 4, seed=7))
    parts = [("direct", "T . R"), ("wall", ep.hits("street/wall*")), ("floor", "T .* 'street/floor' .* R")]
    names, group = _core.partition_groups(paths, parts)
    assert names == ["direct", "wall", "floor", "other"]
    masks = [matches(selection, paths) for _, selection in parts]
    wanted = np.select(masks, range(len(masks)), default=len(masks))
    assert np.array_equal(group, wanted) and group.dtype == np.uint32
    assert set(wanted) == {0, 1, 2, 3}
    split = paths.partition(dict(parts))
    assert {name: part.num_paths for name, part in split.items()} == dict(zip(names, np.bincount(wanted)))


@pytest.mark.hard
def test_no_paths_give_no_bits(make_paths):
    paths = make_paths([])
    assert matches("T . R", paths).shape == (0,)
    assert _core.partition_groups(paths, [("a", "T . R")])[1].shape == (0,)


def test_text_of_selections_is_readable():
    selection = (ep.hits("wall") | "T . R") & ~(ep.num_bounces >= 2)
    assert str(selection) == selection.text == "((T .* 'wall' .* R) | (T . R)) & ~(T .{2,} R)"
    assert repr(ep.Selection("T . R")) == "<Selection T . R>"
    assert str(ep.Selection(selection)) == str(selection)


def test_faults_in_the_text_point_at_the_place(make_paths):
    paths = make_paths(random_routes(3, 3, seed=8))
    calls = (ep.Selection, paths.select, lambda text: ep.hits("street") & text, lambda text: text | ep.hits("street"),
             lambda text: paths.partition({"a": text}), lambda text: _core.partition_groups(paths, [("a", text)]))
    for call in calls:
        with pytest.raises(ValueError, match="expected") as error:
            call("T .* & R")
        assert str(error.value).endswith("\n  T .* & R\n       ^")


def test_unknown_meshes_name_the_nearest(make_paths):
    paths = make_paths(random_routes(3, 3, seed=9))
    with pytest.raises(ValueError, match="nearest names: pedestrian/torso"):
        paths.select("T 'pedestrian/torzo' R")
    for make in (ep.hits, ep.first, ep.last):
        with pytest.raises(ValueError, match="glob: must be non-empty"):
            make("")


def test_parts_must_have_names_of_their_own(make_paths):
    paths = make_paths(random_routes(3, 3, seed=10))
    for names in (["other"], [""], ["a", "a"]):
        with pytest.raises(ValueError, match="parts: "):
            _core.partition_groups(paths, [(name, "T . R") for name in names])


def test_python_operators_that_would_mislead_are_errors():
    with pytest.raises(TypeError, match="& | ~"):
        ep.hits("a") and ep.hits("b")
    with pytest.raises(TypeError, match="& | ~"):
        1 < ep.num_bounces < 3
    with pytest.raises(TypeError):
        ep.Selection(3)
    with pytest.raises(TypeError):
        ep.hits("a") & 3
