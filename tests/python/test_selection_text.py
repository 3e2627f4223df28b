"""Selections as text: what `Selection.text` writes is read back, and faults are shown where they are."""
from __future__ import annotations

import numpy as np
import pytest

import echopath as ep
from support import shapes


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
    read = ep.parse_selection(str(selection))
    assert np.array_equal(read.matches(paths), selection.matches(paths))


@pytest.mark.parametrize("text, meant", [
    ("T . R | T . . R & ~T .* 'Rear' .* R", ONE | (TWO & ~REAR)),   # not before and before or
    (" ( T . R | T . . R ) & ( T .* 'Rear' .* R ) ", (ONE | TWO) & REAR),
    ("T 'Rear' | 'left' R", ep.Selection("T ('Rear' | 'left') R")),  # the | of the expression, and an R in quotes
])
def test_operators_bind_as_documented(paths, text, meant):
    mask = ep.parse_selection(text).matches(paths)
    assert np.array_equal(mask, meant.matches(paths)) and mask.any() and not mask.all()


@pytest.mark.parametrize("text, fault_at", [
    ("", 0), ("T . R &", 7), ("(T . R", 6), ("T . R T . R", 6), ("T . R & T ) R", 10), ("T . R | 'left'", 8),
    ("~(T . R) & T 'left", 13), ("T . R\n& T + R", 10),
])
def test_faults_are_marked_where_they_are(text, fault_at):
    with pytest.raises(ValueError) as caught:
        ep.parse_selection(text)
    _, line, caret = str(caught.value).splitlines()
    assert line == "  " + text.replace("\n", " ") and caret == " " * (2 + fault_at) + "^"


def test_parts_remember_what_they_are(paths):
    parts = ep.decompose(paths, paths.radar, {"one": "T . R", "two": TWO})
    assert list(parts) == ["one", "two", "other"] and parts.selections == {"one": "T . R", "two": TWO}
    views = ep.decompose(paths, None, {"a": {"one": "T . R"}, "b": {"two": TWO}})
    assert views["a"].selections == {"one": "T . R"} and list(views["b"]) == ["two", "other"]
    whole = ep.synthesize(paths)
    assert np.abs(whole - sum(parts.values())).max() < 1e-12 * np.abs(whole).max()
