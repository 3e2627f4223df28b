"""Views that are saved and loaded."""
from __future__ import annotations

import json

import numpy as np
import pytest

import echopath as ep
from echopath_viewer.model import MESH_GROUP, OWN_GROUP, CellBox, Filters, Session, from_frame
from echopath_viewer.model.view_format import _RULES
from echopath_viewer.model.view_state import apply_state, load_state, save_state, state_of


@pytest.fixture
def session(frame):
    return Session(from_frame(frame))


def test_a_view_is_saved_and_loaded(frame, tmp_path):
    first = Session(from_frame(frame))
    first.set_channel(0, 1)
    first.set_filters(Filters(min_bounces=2, expression="T .* 'walker' .* R"))
    first.add_part("mine")
    first.set_part((OWN_GROUP, "mine"))
    first.set_partition("count")
    first.set_color_by("speed")
    first.set_max_rays(123)
    first.set_mesh_visible([1], False)
    first.set_mesh_colour(2, (1, 2, 3))
    first.set_chirp(7)
    first.select_cells(CellBox(3, 60, 2, 20))
    first.select_ray(np.flatnonzero(first.visible)[11])
    save_state(state_of(first), tmp_path / "view.json")
    second = Session(from_frame(frame))
    assert apply_state(second, load_state(tmp_path / "view.json")) == []
    assert state_of(second) == state_of(first)
    assert np.array_equal(second.visible, first.visible) and np.array_equal(second.lit, first.lit)


def test_the_cell_that_was_clicked_is_told_of_again(frame, tmp_path):
    """Not the highest of those around it, as in a map of more cells than samples, where a click takes some."""
    first = Session(from_frame(frame))
    level = frame.spectrum.values[0, 0]
    velocity, distance = (int(index) for index in np.unravel_index(np.abs(level).argmax(), level.shape))
    clicked = distance + 1, velocity + 1
    first.select_cells(CellBox.around(*clicked, 2), clicked)
    save_state(state_of(first), tmp_path / "view.json")
    second = Session(from_frame(frame))
    assert apply_state(second, load_state(tmp_path / "view.json")) == [] and second.cell == clicked
    first.select_cells(first.box)  # a rectangle: whichever is its highest
    assert state_of(first)["cell"] is None and first.cell == (distance, velocity)
    for elsewhere in ([0, 0], [10**6, 0]):
        apply_state(second, state_of(first) | {"cell": elsewhere})
        assert second.cell == (distance, velocity)


def test_the_beam_that_was_chosen_lights_its_rays_again(frame, tmp_path):
    """Without it all rays of the cell are lit, and the cell tells of the echoes of one channel."""
    first = Session(from_frame(frame))
    first.select_beam(45, 0.1, 0.0)
    save_state(state_of(first), tmp_path / "view.json")
    second = Session(from_frame(frame))
    assert apply_state(second, load_state(tmp_path / "view.json")) == [] and second.beam == (0.1, 0.0)
    assert second.where_lit() == first.where_lit() and np.array_equal(second.lit, first.lit)
    assert 0 < np.count_nonzero(first.lit) < np.count_nonzero(first.index.mask_of(first.box))
    first.select_cells(first.box)
    apply_state(second, state_of(first))
    assert second.beam is None and np.array_equal(second.lit, first.lit)


def test_colours_of_meshes_are_told_once_where_some_are_others(session):
    told = []
    session.listen(lambda topics: told.append(topics))
    state = state_of(session)
    for rgb, times in ((None, 0), ((1, 2, 3), 1)):
        if rgb is not None:
            state["mesh_colours"] = dict.fromkeys(state["mesh_colours"], rgb)
        told.clear()
        apply_state(session, state)
        assert told.count({"meshes", "colours"}) == times
    assert session.palette.tolist() == [[1, 2, 3]] * len(session.mesh_names)


def test_a_view_of_another_frame_says_what_does_not_fit(session):
    state = state_of(session) | {"hidden_meshes": ["car"], "part": ["route", "lost"], "channel": [5, 0]}
    misfits = apply_state(session, json.loads(json.dumps(state)))
    assert any("car" in text for text in misfits) and any("lost" in text for text in misfits)
    assert any("transmitter 5" in text for text in misfits)


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"format": "echopath view", "version": 99}'])
def test_what_is_no_view_is_refused(tmp_path, text):
    (tmp_path / "x.json").write_text(text)
    with pytest.raises(ep.FileError, match="x.json"):
        load_state(tmp_path / "x.json")


def test_maps_of_meshes_and_parts_of_them_are_loaded_too(frame, tmp_path):
    first = Session(from_frame(frame))
    first.set_part(("route", "ghost"))
    first.select_node("wall_left")
    first.set_part((MESH_GROUP, "wall_left"))
    first.set_filters(Filters(max_bounces=2))
    first.add_part("over the left wall")
    first.select_node("walker/head")
    first.set_part((MESH_GROUP, "walker/head"))
    save_state(state_of(first), tmp_path / "view.json")
    second = Session(from_frame(frame))
    assert apply_state(second, load_state(tmp_path / "view.json")) == []
    assert state_of(second) == state_of(first)
    assert np.array_equal(second.visible, first.visible) and first.visible.any()
    for key in ((OWN_GROUP, "over the left wall"), (MESH_GROUP, "walker/head")):
        assert np.array_equal(second.parts[key].spectrum.values, first.parts[key].spectrum.values)


@pytest.mark.parametrize("key, value", [
    ("frame", 3), ("filters", []), ("filters", {"colour": "red"}), ("filters", {"min_bounces": "2"}),
    ("filters", {"min_bounces": -1}), ("filters", {"mesh": None}), ("filters", {"min_power_dbm": [1]}), ("own_parts", [1]),
    ("own_parts", {"x": None}), ("own_parts", {"x": {"part": "whole", "filters": {}}}), ("node", 1), ("node_base", "whole"),
    ("part", "whole"), ("part", ["whole"]), ("partition", 1), ("channel", "ab"), ("channel", [0]), ("channel", [0, -1]),
    ("color_by", "mood"), ("color_by", ["mesh"]), ("max_rays", None), ("max_rays", 0), ("max_rays", 10**12),
    ("dynamic_range_db", "60"), ("dynamic_range_db", 0), ("dynamic_range_db", float("nan")), ("chirp", 1.5), ("chirp", True),
    ("box", [1, 2]), ("box", "1234"), ("cell", [1]), ("cell", [-1, 2]), ("beam", [0.1]), ("beam", ["a", 0]), ("ray", -1),
    ("ray", "3"),
    ("hidden_meshes", "car"), ("hidden_meshes", [1]),
    ("mesh_colours", []), ("mesh_colours", {"car": [1, 2]}), ("mesh_colours", {"car": [1, 2, 300]}), ("camera", {}),
    ("camera", {"position": [0, 0, 0], "focal_point": [1, 0, 0], "up": [0, 0], "view_angle": 30}), ("show_hits", 1),
    ("one_map", "no"), ("map_view", [0, 0, 1]), ("map_view", [0, 0, 0, 1]),
])
def test_a_damaged_view_is_refused_by_the_key_that_is_wrong(session, tmp_path, key, value):
    state = state_of(session) | {key: value}
    (tmp_path / "x.json").write_text(json.dumps(state))
    with pytest.raises(ep.FileError, match=f"x.json.*{key}: must be"):
        load_state(tmp_path / "x.json")


def test_every_key_of_a_view_has_a_rule(session):
    assert set(state_of(session)) - {"format", "version"} <= set(_RULES)


def test_cells_beyond_the_map_of_this_frame_are_not_selected(session):
    misfits = apply_state(session, state_of(session) | {"box": [10**6, 10**6 + 3, 0, 3]})
    assert session.box is None and any("cells" in text for text in misfits)
