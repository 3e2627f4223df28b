"""Maps of parts and of meshes are those of their paths."""
from __future__ import annotations

import numpy as np
import pytest

import echopath as ep
from echopath_viewer.model import OWN_GROUP, WHOLE, Filters, Session, from_frame, from_paths
from support.scenes.session_hits import hit_names

ROUNDING = 1e-9
SINGLE = 2e-6    # relative, of positions kept in single precision


def test_parts_show_the_paths_that_the_frame_gave_them(session, frame):
    for index, name in enumerate(frame.parts["route"]):
        session.set_part(("route", name))
        assert np.array_equal(session.visible, frame.part_of_path["route"] == index)
    session.set_part((WHOLE, WHOLE))
    assert session.visible.all()


def test_a_part_named_in_the_viewer_is_the_map_of_what_was_visible(session):
    session.set_part(("route", "ghost"))
    session.set_filters(Filters(expression="T .* 'wall_left' .* R"))
    part = session.add_part("left ghosts")
    mask = session.visible.copy()
    alone = ep.range_doppler(ep.synthesize(session.paths.select(mask)), session.radar, **session.signals.spectrum_settings)
    assert np.abs(part.spectrum.values - alone.values).max() <= ROUNDING * np.abs(alone.values).max()
    session.set_filters(Filters())
    session.set_part((OWN_GROUP, "left ghosts"))
    assert np.array_equal(session.visible, mask)
    with pytest.raises(ValueError, match="taken"):
        session.add_part("left ghosts")
    with pytest.raises(ValueError, match="empty"):
        session.add_part(" ")
    session.remove_part((OWN_GROUP, "left ghosts"))
    assert session.part_key == (WHOLE, WHOLE) and session.visible.all()
    with pytest.raises(ValueError, match="named here"):
        session.remove_part(("route", "ghost"))


def wanted_map(session, paths):
    """The map of some paths (indices) from the record alone."""
    mask = np.zeros(session.paths.num_paths, bool)
    mask[paths] = True
    return ep.range_doppler(ep.synthesize(session.paths.select(mask)), session.radar).values


def assert_same_map(part, wanted) -> None:
    assert np.abs(part.spectrum.values - wanted).max() <= ROUNDING * np.abs(wanted).max()


def paths_over(session, name: str, min_bounces: int) -> list:
    return [path for path in range(session.paths.num_paths)
            if name in hit_names(session, path) and session.paths.num_bounces[path] >= min_bounces]


def test_the_spectrum_of_a_mesh_is_that_of_the_paths_that_hit_it(session):
    session.set_filters(Filters(min_bounces=2))
    session.select_node("walker/head")
    part, = session.parts.of_group("mesh")
    slow = paths_over(session, "walker/head", 2)
    assert_same_map(part, wanted_map(session, slow))
    session.set_part(part.key)
    assert np.array_equal(np.flatnonzero(session.visible), slow)
    assert session.meshes_of_node() == {session.mesh_names.index("walker/head")}
    session.select_node("walker")
    assert session.meshes_of_node() == {0, 1} and [part.name for part in session.parts.of_group("mesh")] == ["walker"]
    session.select_node(None)
    assert not session.parts.of_group("mesh") and session.part_key == (WHOLE, WHOLE)


@pytest.mark.parametrize("base", [(WHOLE, WHOLE), ("route", "ghost")])
def test_the_map_of_a_mesh_does_not_depend_on_the_mesh_chosen_before(frame, base):
    one, two = Session(from_frame(frame)), Session(from_frame(frame))
    one.set_part(base)
    one.select_node("walker/head")
    two.set_part(base)
    two.select_node("wall_left")
    two.set_part(("mesh", "wall_left"))
    two.select_node("walker/head")
    (part,), (wanted,) = (session.parts.of_group("mesh") for session in (two, one))
    assert np.array_equal(part.mask, wanted.mask) and np.array_equal(part.spectrum.values, wanted.spectrum.values)
    assert two.part_key == base


def test_the_map_of_a_mesh_follows_the_filters(session):
    session.select_node("walker/head")
    session.set_part(("mesh", "walker/head"))
    for min_bounces in (2, 1):
        session.set_filters(Filters(min_bounces=min_bounces))
        slow = paths_over(session, "walker/head", min_bounces)
        assert np.array_equal(np.flatnonzero(session.visible), slow)
        session.refresh_node()
        assert session.part_key == ("mesh", "walker/head")
        assert_same_map(session.part, wanted_map(session, slow))
    before = session.part
    session.refresh_node()
    assert session.part is before


def test_a_map_of_a_mesh_that_is_not_made_anew_is_taken_away(session):
    def stop(_stage, _fraction):
        raise InterruptedError

    session.select_node("walker/head")
    session.set_part(("mesh", "walker/head"))
    session.set_filters(Filters(min_bounces=2))
    with pytest.raises(InterruptedError):
        session.refresh_node(stop)
    assert not session.parts.of_group("mesh") and session.node == "walker/head" and session.part_key == (WHOLE, WHOLE)


def test_paths_with_parts_are_viewed_as_the_frame_is(frame):
    selections = {"direct": "T 'walker' R", "ghost": "T .* 'walker' .* R"}
    cubes = ep.decompose(frame.paths, frame.radar, selections)
    for parts in (selections, cubes, {"route": cubes}):
        view_input = from_paths(frame.scene, frame.paths, parts)
        group, = view_input.parts.partitions
        for index, name in enumerate(["direct", "ghost", "other"]):
            part = view_input.parts[group, name]
            assert np.array_equal(part.mask, frame.part_of_path["route"] == index)
            wanted = frame.part_spectra["route"][name].values
            assert np.abs(part.spectrum.values - wanted).max() <= 1e-6 * np.abs(wanted).max()  # synthesis: 1e-7
    with pytest.raises(ValueError, match="scene"):
        from_paths(ep.Scene(), frame.paths)


@pytest.mark.parametrize("name", ["mesh", "own", "whole"])
def test_partitions_with_names_of_the_viewers_own_are_partitions(frame, name):
    direct = np.asarray(ep.Selection("T . R").matches(frame.paths))
    parts = {name: {name: "T . R", "ghosts": "T .{2} R"}}
    again = ep.simulate(frame.scene, frame.radar, num_rays=300, parts=parts, labels=True)
    for session in (Session(from_frame(again)), Session(from_paths(None, frame.paths, parts))):
        group, = session.parts.partitions
        session.select_node("walker")
        assert [part.name for part in session.parts.of_group(group)] == [name, "ghosts", "other"]
        assert session.parts.whole.mask is None  # all paths: it is none of the parts
        session.set_part((group, name))
    assert np.array_equal(session.visible, direct)
    session = Session(from_frame(again))
    session.set_layer("labels", True)
    assert session.known_data("labels") is again.labels[name]


def test_signals_by_families_are_shown_by_their_names(frame):
    found = ep.families(frame.paths, ["walker"])
    parts = from_paths(frame.scene, frame.paths, {"ghosts": ep.decompose(frame.paths, frame.radar, found)}).parts
    assert [part.name for part in parts if part.group == "ghosts"] == [str(family) for family in found]


def test_each_channel_has_its_own_cells_powers_and_maps(session, frame):
    session.set_channel(1, 1)
    cells = ep.path_cells(frame.paths, frame.spectrum, tx=1, rx=1)
    wanted = zip(cells.range_index[::7], cells.velocity_index[::7])
    assert [session.cell_of(path) for path in range(0, len(cells.range), 7)] == [
        None if distance < 0 else (distance, velocity) for distance, velocity in wanted]
    assert session.columns.range == pytest.approx(cells.range, rel=SINGLE, abs=0)
    power = np.abs(frame.paths.amplitudes([frame.paths.frame.trace_time], 1, 1)[0]) ** 2
    assert np.array_equal(session.columns.power, power)
    level = 10 * np.log10(np.abs(frame.spectrum.values[1, 1]) ** 2 * 1e3)
    assert session.parts.whole.level(1, 1) == pytest.approx(level, abs=1e-4)
