"""Selections: path expressions and their algebra against a slow matcher written from the grammar."""
import random

import numpy as np
import pytest

import echopath as ep
from echopath import _core
from support.hand_made import GLOBS, MESHES, hand_made_paths, make_street, random_expression, random_routes
from support.references.slow_matcher import Words, glob_takes, slow_matches


@pytest.fixture(scope="module")
def make_paths():
    """make_paths([[("street/floor", "S"), ...], ...]) -> ep.Paths"""
    street = make_street()
    return lambda routes: hand_made_paths(street, routes)


def matches(selection, paths):
    return ep.Selection(selection).matches(paths)


def test_selections_agree_with_the_slow_matchers_on_random_expressions(make_paths):
    num_paths, num_expressions, by_backtracking = 10_000, 250, 20
    routes = random_routes(num_paths, 6, seed=1)
    paths, words, draw, num_taken = make_paths(routes), Words(routes), random.Random(2), 0
    for index in range(num_expressions):
        text = random_expression(draw)
        taken = matches(text, paths)
        assert taken.dtype == bool and taken.shape == (num_paths,)
        assert np.array_equal(taken, words.taken_by(text)), text
        for path in range(index * by_backtracking, (index + 1) * by_backtracking):
            assert taken[path] == slow_matches(text, routes[path]), (text, routes[path])
        num_taken += taken.sum()
    assert 0.05 < num_taken / (num_paths * num_expressions) < 0.5  # both answers are common, else it proves little


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


def test_what_both_operands_have_is_taken_once():
    selection = both = either = ep.hits("wall") & (ep.num_bounces >= 2)
    for _ in range(60):  # without sharing 2^60 terms
        both, either = both & both, either | either
    assert str(both) == str(either) == str(selection)
    assert str((ep.Selection("T . R") | selection) | selection) == str(ep.Selection("T . R") | selection)


def test_selections_that_would_take_for_ever_are_refused():
    many = deep = ep.Selection("T . R")
    with pytest.raises(ValueError, match="selection: must have at most 100000 terms, got 1[0-9]{5}$"):
        for _ in range(60):
            many = (many & ep.hits("wall")) | (many & ep.hits("floor"))
    with pytest.raises(ValueError, match="selection: must be nested at most 100 deep, got 101"):
        for _ in range(101):
            deep = ~(deep & ep.hits("wall"))


def test_text_that_is_no_unicode_is_refused():
    with pytest.raises(ValueError, match="text: must be text that UTF-8 can hold, without lone surrogates, got .*ud800"):
        ep.Selection("T '\ud800' R")
