"""Selections as text: what `Selection.text` writes is read back, and faults are shown where they are; powers of paths."""
from __future__ import annotations

import operator
import random

import numpy as np
import pytest

import echopath as ep
from support import shapes

ADDITIVITY = 1e-12  # of the whole


@pytest.fixture(scope="module")
def paths():
    """Two rough plates that see each other, and one behind."""
    rough = shapes.lambert(0.9)
    scene = shapes.scene_of(left=(shapes.plate((5.0, 1.1, 0.0), (-1.0, -1.0, 0.0), 3.0), rough),
                            right=(shapes.plate((5.0, -1.1, 0.0), (-1.0, 1.0, 0.0), 3.0), rough),
                            Rear=(shapes.plate((8.0, 0.0, 0.0), (-1.0, 0.0, 0.0), 9.0), rough))
    radar = ep.Radar(ep.ChirpSequence(num_samples=64, num_chirps=4),
                     transmitters=[ep.Antenna((0, 0, 0))], receivers=[ep.Antenna((0, 0.01, 0))])
    return ep.trace(scene, radar, num_rays=3000, max_bounces=3)


ONE, TWO, REAR = ep.Selection("T . R"), ep.Selection("T . . R"), ep.hits("Rear")


@pytest.mark.parametrize("selection", [
    ONE, ~ONE, ONE & REAR, ONE | TWO, ~(ONE & ~REAR) | (TWO & REAR) | ~TWO, ~~ONE,
    ep.hits("left") & (ep.num_bounces >= 2),
])
def test_the_text_of_a_selection_stands_for_it(paths, selection):
    read = ep.Selection(str(selection))
    assert np.array_equal(read.matches(paths), selection.matches(paths))


@pytest.mark.parametrize("joined", [
    lambda: REAR & ep.num_bounces == 1, lambda: ep.num_bounces == 1 & REAR, lambda: REAR | ep.power > 1e-15,
    lambda: ep.power > 1e-15 & ep.num_bounces == 2, lambda: "T . R" & ep.num_bounces == 1, lambda: REAR & 1 <= ep.num_bounces,
    lambda: 1 == ep.num_bounces | REAR, lambda: REAR & None,
])
def test_comparisons_beside_operators_are_told_to_stand_in_parentheses(joined):
    """& and | bind tighter than comparisons in Python, other than in the text of a Selection."""
    with pytest.raises(TypeError, match=r"a comparison stands in parentheses, as in ep.hits\('wall'\) & \(ep.num_bounces == 1\)"):
        joined()


def test_text_is_joined_as_a_selection():
    for joined, meant in ((REAR & "T . R", REAR & ONE), ("T . R" & REAR, ONE & REAR), ("T . R" | TWO, ONE | TWO)):
        assert joined == meant
    with pytest.raises(ValueError, match="path expression: expected"):
        REAR & "T Rear R"


@pytest.mark.parametrize("text, meant", [
    ("T . R | T . . R & ~T .* 'Rear' .* R", ONE | (TWO & ~REAR)),   # not before and before or
    (" ( T . R | T . . R ) & ( T .* 'Rear' .* R ) ", (ONE | TWO) & REAR),
    ("T 'Rear' | 'left' R", ep.Selection("T ('Rear' | 'left') R")),  # the | of the expression, and an R in quotes
])
def test_operators_bind_as_documented(paths, text, meant):
    mask = ep.Selection(text).matches(paths)
    assert np.array_equal(mask, meant.matches(paths)) and mask.any() and not mask.all()


@pytest.mark.parametrize("text, fault_at", [
    ("", 0), ("T . R &", 7), ("(T . R", 6), ("T . R T . R", 6), ("T . R & T ) R", 10), ("T . R | 'left'", 8),
    ("~(T . R) & T 'left", 13), ("T . R\n& T + R", 10), ("power = 3", 6), ("power", 5), ("power > much", 8),
    ("power > inf", 8), ("power > 1e-15 W", 14), ("~" * 101 + "T . R", 100),
])
def test_faults_are_marked_where_they_are(text, fault_at):
    with pytest.raises(ValueError, match="path expression: expected") as caught:
        ep.Selection(text)
    _, line, caret = str(caught.value).splitlines()
    begin = text.rfind("\n", 0, fault_at) + 1  # the line with the fault is shown
    assert line == "  " + text[begin:] and caret == " " * (2 + fault_at - begin) + "^"


def random_selection(draw: random.Random, thresholds, depth=4):
    """A tree of & | ~ over all kinds of terms."""
    terms = [lambda: ep.Selection("T 'Rear' | 'left' R"), lambda: ep.hits("right"), lambda: ep.first("left"),
             lambda: ep.last("R*"), lambda: ep.num_bounces >= draw.randint(0, 4), lambda: ep.power > draw.choice(thresholds),
             lambda: ep.power <= draw.choice(thresholds)]
    if depth == 0 or draw.random() < 0.2:
        return draw.choice(terms)()
    inner = random_selection(draw, thresholds, depth - 1)
    if draw.random() < 0.3:
        return ~inner
    other = random_selection(draw, thresholds, depth - 1)
    return inner & other if draw.random() < 0.5 else inner | other


def test_random_selections_are_read_back(paths):
    draw, thresholds, shares = random.Random(3), np.quantile(paths.power, [0.1, 0.5, 0.9]), []
    for _ in range(200):
        selection = random_selection(draw, thresholds)
        mask = selection.matches(paths)
        assert np.array_equal(ep.Selection(selection.text).matches(paths), mask), selection
        shares.append(mask.mean())
    # neither all nor none, else it proves little
    assert np.mean((np.array(shares) > 0.02) & (np.array(shares) < 0.98)) > 0.3


def test_power_compares_like_the_powers_of_the_paths(paths):
    median = float(np.sort(paths.power)[paths.num_paths // 2])  # one of them, so that > and >= differ
    assert np.array_equal((ep.power > median).matches(paths), paths.power > median)
    assert np.array_equal((ep.power >= median).matches(paths), paths.power >= median)
    assert np.array_equal((ep.power < median).matches(paths), paths.power < median)
    assert np.array_equal((median >= ep.power).matches(paths), paths.power <= median)
    assert 0 < (ep.power > median).matches(paths).sum() < paths.num_paths
    bands = paths.partition({"strong": ep.power > median, "weak": "power > 0"})
    assert bands["strong"].power.min() > median >= bands["weak"].power.max()


def test_the_text_of_a_power_keeps_every_bit(paths):
    for watts in (1e-15, 0.1 + 0.2, 5e-324, 0.0, -0.0, float(paths.power[0])):
        text = (ep.power >= watts).text
        assert float(text.removeprefix("power >= ")) == watts and ep.Selection(text).text == text
    assert str((ep.power > 1e-15) & ~ONE) == "(power > 1e-15) & ~(T . R)"


def test_comparisons_of_power_that_would_mislead_are_errors():
    for mistake in (lambda: ep.power == 1e-15, lambda: ep.power != 0, lambda: 0 < ep.power < 1, lambda: bool(ep.power)):
        with pytest.raises(TypeError):
            mistake()
    for watts in (float("nan"), float("inf")):
        with pytest.raises(ValueError, match="power: must be compared with a finite power in W"):
            ep.power < watts


def test_powers_in_dbm_are_refused_with_what_they_are_in_watts():
    with pytest.raises(ValueError, match="power in W from 0 on, such as 1e-13 for -100 dBm, got -100"):
        ep.power > -100
    for text, told in (("power > -100", "a power in W from 0 on, such as 1e-13 for -100 dBm, got '-100'"),
                       ("power > 100 dBm", "no unit, as powers are in W, such as 1e-13 for -100 dBm, got 'dBm'"),
                       ("power > 1 W & T . R", "no unit, as powers are in W"), ("power > 5 pW", "no unit, .* got 'pW'")):
        with pytest.raises(ValueError, match=told):
            ep.Selection(text)


def test_joined_text_stands_wherever_a_selection_does(paths):
    text, meant = "~(T . R) & T .* 'Rear' .* R", ~ONE & REAR
    wanted = meant.matches(paths)
    assert 0 < wanted.sum() < paths.num_paths
    assert np.array_equal(ep.Selection(text).matches(paths), wanted)
    assert paths.select(text).num_paths == paths.partition({"a": text})["a"].num_paths == wanted.sum()
    assert np.array_equal((text | REAR).matches(paths), (meant | REAR).matches(paths))
    assert np.array_equal(ep.decompose(paths, None, {"a": text})["a"], ep.decompose(paths, None, {"a": meant})["a"])


def test_globs_can_be_checked_before_a_trace(paths):
    ep.Selection("T 'left' R & ~(power > 1)").check(paths.scene)
    with pytest.raises(ValueError, match=r"expected a glob that takes a mesh, got 'Raer'; nearest names: Rear"):
        ep.Selection("T . R | ~(T 'left' 'Raer' R)").check(paths.scene)


def test_parts_remember_what_they_are(paths):
    parts = ep.decompose(paths, paths.radar, {"one": "T . R", "two": TWO})
    assert list(parts) == ["one", "two", "other"] and parts.selections == {"one": "T . R", "two": TWO}
    views = ep.decompose(paths, None, {"a": {"one": "T . R"}, "b": {"two": TWO}})
    assert views["a"].selections == {"one": "T . R"} and list(views["b"]) == ["two", "other"]
    whole = ep.synthesize(paths)
    assert np.abs(whole - sum(parts.values())).max() < ADDITIVITY * np.abs(whole).max()


@pytest.mark.parametrize("join", [operator.and_, operator.or_])
def test_a_selection_joined_with_itself_stays_as_long_as_it_was(paths, join):
    """Doubled twenty times it had a million terms, and took seven seconds to select."""
    joined = chosen = ep.hits("left") & ~ONE
    for _ in range(20):
        joined = join(joined, joined)
    assert joined.text == chosen.text
    assert np.array_equal(paths.select(joined).offsets, paths.select(chosen).offsets)


@pytest.mark.parametrize("asked, meant", [("wheels", "car/wheel"), ("*/wheels/*", "car/wheel"), ("legs", "walker/leg_left"),
                                          ("walker/arms", "walker/arm_left"), ("tyres", "car/wheel/front_left/tyre"),
                                          ("cat", "car")])
def test_globs_that_take_nothing_are_answered_with_groups_and_parts(asked, meant):
    scene = ep.Scene()
    for name, actor in (("car", ep.actors.car()), ("walker", ep.actors.pedestrian())):
        scene.add(actor, name=name, position=(9.0, 0.0, 0.0))
    with pytest.raises(ValueError, match=f"nearest names: {meant},"):
        ep.Selection(f"T .* '{asked}' .* R").check(scene)
