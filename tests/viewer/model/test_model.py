"""The model of the viewer, without VTK and Qt: filters, cells, selections, colours, against slow loops."""
from __future__ import annotations

import subprocess
import sys

import matplotlib
import numpy as np
import pytest

import echopath as ep
from echopath_viewer.model import (
    OWN_GROUP, WHOLE, CellBox, CellIndex, FilterError, Filters, Session, from_frame, from_paths, ray_segments,
)
from echopath_viewer.model.antennas import world_from_antenna
from echopath_viewer.model.rays.picking import nearest_segment
from support.placed_radar import make_radars

ROUNDING = 1e-9
SHADE = 0.2 * 255   # of a mesh of two from the colour of their object
BORDER = 0.01    # of a colour of 256: single precision
SINGLE = 2e-6    # relative, of positions kept in single precision


@pytest.fixture
def session(frame):
    return Session(from_frame(frame))


def hit_names(session, path: int) -> list[str]:
    first = session.paths.offsets[path]
    return [session.mesh_names[mesh] for mesh in session.paths.mesh_id[first:first + session.paths.num_bounces[path]]]


# --- cells ---

@pytest.mark.parametrize("seed", range(4))
def test_the_index_finds_what_a_loop_over_all_paths_finds(seed):
    rng = np.random.default_rng(seed)
    num_ranges, num_velocities, num_paths = 23, 11, 900
    range_index = rng.integers(-1, num_ranges, num_paths)
    velocity_index = np.where(range_index < 0, -1, rng.integers(0, num_velocities, num_paths))
    cell = np.where(range_index < 0, -1, velocity_index * num_ranges + range_index)
    index = CellIndex(cell, num_ranges, num_velocities)
    for _ in range(40):
        first, last = np.sort(rng.integers(-3, num_ranges + 3, 2)), np.sort(rng.integers(-3, num_velocities + 3, 2))
        slow = [first[0] <= r <= first[1] and last[0] <= v <= last[1] and r >= 0
                for r, v in zip(range_index, velocity_index)]
        assert np.array_equal(index.mask_of(CellBox(*first, *last)), slow)


def test_a_cell_lights_the_visible_paths_that_lie_in_it(session):
    session.set_filters(Filters(min_bounces=1, max_bounces=2))
    session.set_part(("route", "ghost"))
    strongest = int(session.shown_rays(1)[0])
    at = session.cell_of(strongest)
    session.select_cells(CellBox(at[0] - 1, at[0] + 20, 0, 31))
    cells = ep.path_cells(session.paths, session.parts.whole.spectrum)
    there = [path for path in range(session.paths.num_paths)
             if at[0] - 1 <= cells.range_index[path] <= at[0] + 20]
    slow = {path for path in there  # at most two bounces by the filter; one would be "direct", which comes first
            if session.paths.num_bounces[path] == 2 and any("walker/" in name for name in hit_names(session, path))}
    assert set(session.lit_rays(10**6)) == slow and strongest in slow and len(slow) < len(there)


def test_no_cell_selected_lights_nothing_and_lists_what_is_drawn(session):
    assert session.lit is None and len(session.lit_rays()) == 0
    listed = session.listed_rays()
    assert set(listed) == set(session.shown_rays()) and np.all(np.diff(session.columns.power[listed]) <= 0.0)


# --- filters ---

@pytest.mark.parametrize("filters", [
    Filters(), Filters(min_bounces=2), Filters(max_bounces=1), Filters(mesh="wall_*"), Filters(mesh="walker"),
    Filters(expression="T 'walker' . R | ~(T .* 'wall_left' .* R)"),
    Filters(min_bounces=2, max_bounces=3, min_power_dbm=-150.0, mesh="walker/head", expression="T .* 'wall_right' .* R"),
])
def test_filters_keep_what_a_loop_keeps(session, filters):
    session.set_filters(filters)
    power = np.abs(session.paths.amplitudes([session.paths.frame.trace_time])[0]) ** 2
    for path in range(session.paths.num_paths):
        names = hit_names(session, path)
        kept = filters.min_bounces <= len(names) <= filters.max_bounces
        if filters.min_power_dbm is not None:
            kept &= 10 * np.log10(power[path] * 1e3) >= filters.min_power_dbm
        kept &= {"": True, "wall_*": any("wall_" in name for name in names),
                 "walker": any("walker" in name for name in names),
                 "walker/head": "walker/head" in names}[filters.mesh]
        if filters.expression.startswith("T 'walker' ."):
            kept &= (len(names) == 2 and "walker" in names[0]) or "wall_left" not in names
        elif filters.expression:
            kept &= "wall_right" in names
        assert session.visible[path] == kept


@pytest.mark.parametrize("filters, field, word", [
    (Filters(expression="T . "), "expression", "^"), (Filters(expression="T 'nobody' R"), "expression", "nobody"),
    (Filters(mesh="nobody"), "mesh", "nobody"), (Filters(mesh="it's"), "mesh", "quotes"),
])
def test_a_filter_that_is_not_understood_changes_nothing_and_names_its_field(session, filters, field, word):
    session.set_filters(Filters(max_bounces=1))
    before = session.visible.copy()
    with pytest.raises(FilterError) as caught:
        session.set_filters(filters)
    assert caught.value.field == field and word in str(caught.value)
    assert session.filters == Filters(max_bounces=1) and np.array_equal(session.visible, before)


def test_the_strongest_rays_are_drawn_first(session):
    shown = session.shown_rays(50)
    power = session.columns.power[shown]
    assert np.all(np.diff(power) <= 0.0) and len(shown) == 50
    others = np.setdiff1d(np.flatnonzero(session.visible), shown)
    assert session.columns.power[others].max() <= power.min()


def test_counts_of_nodes_have_each_path_once(session):
    session.set_filters(Filters(min_bounces=2))
    slow = [sum(any(f"{name}/".startswith(f"{node.name}/") for name in hit_names(session, path))
                for path in np.flatnonzero(session.visible)) for node in session.scene.nodes]
    assert np.array_equal(session.node_counts(), slow)


# --- parts ---

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


@pytest.mark.parametrize("hide", [lambda session: session.set_filters(Filters(min_bounces=3)),
                                  lambda session: session.set_part(("count", "other"))])
def test_a_chosen_ray_that_is_hidden_is_chosen_no_more(session, hide):
    single = int(np.flatnonzero(session.paths.num_bounces == 1)[0])
    session.select_ray(single)
    session.set_filters(Filters(max_bounces=2))
    assert session.ray == single
    hide(session)
    assert not session.visible[single] and session.ray is None


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


def test_signals_by_families_are_shown_by_their_names(frame):
    found = ep.families(frame.paths, ["walker"])
    parts = from_paths(frame.scene, frame.paths, {"ghosts": ep.decompose(frame.paths, frame.radar, found)}).parts
    assert [part.name for part in parts if part.group == "ghosts"] == [str(family) for family in found]


# --- channels and time ---

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


def test_segments_lead_from_the_transmitter_by_all_hits_to_the_receiver(session, frame):
    rng = np.random.default_rng(5)
    chosen = rng.choice(frame.paths.num_paths, 200, replace=False)  # in no order
    time = frame.radar.chirp_time(0, 3)
    tx, rx = np.array([0.0, 0.0, 0.0]), np.array([0.0, 0.01, 0.0])
    segments = ray_segments(frame.paths, chosen, time, tx, rx)
    points, row = frame.paths.points(time), 0
    for number, path in enumerate(chosen):
        first, count = frame.paths.offsets[path], frame.paths.num_bounces[path]
        corners = np.vstack([tx, points[first:first + count], rx])
        meshes = list(frame.paths.mesh_id[first:first + count])
        for bounce in range(count + 1):
            assert segments.ray[row] == number and segments.bounce[row] == bounce
            assert segments.mesh_id[row] == (meshes + meshes[-1:])[bounce]
            begin, end = segments.points[segments.ends[row]]
            assert begin == pytest.approx(corners[bounce], rel=SINGLE, abs=SINGLE)
            assert end == pytest.approx(corners[bounce + 1], rel=SINGLE, abs=SINGLE)
            row += 1
    assert row == segments.num_segments
    assert segments.num_segments_of(10) == sum(frame.paths.num_bounces[chosen[:10]] + 1)


def test_rays_have_the_length_that_replay_gives_them(session, frame):
    for chirp in (0, 31):
        session.set_chirp(chirp)
        rays = session.shown_rays(100)
        segments = session.segments(rays)
        ends = segments.points[segments.ends].astype(float)
        pieces = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        lengths = np.bincount(segments.ray, pieces)
        assert lengths == pytest.approx(frame.paths.lengths([session.time], 0, 0)[0][rays], rel=SINGLE, abs=0)


def test_a_selection_without_rays_has_no_segments(session):
    segments = session.segments(session.lit_rays())
    assert segments.num_segments == 0 and len(session.colouring(segments).rgb) == 0


def test_a_cell_shows_its_power_from_chirp_to_chirp(session, frame):
    session.select_cells(CellBox(0, 60, 0, 31))
    cube = ep.synthesize(frame.paths.select(session.lit))[0, 0]
    slow = [10 * np.log10(np.mean(np.abs(chirp) ** 2) * 1e3) for chirp in cube]
    assert session.slow_time_power() == pytest.approx(slow, abs=1e-6)
    assert ep.power_by_chirp(cube[None, None]) == pytest.approx(slow, abs=1e-9)
    assert np.all(ep.power_by_chirp(np.zeros((1, 1, 3, 4))) == pytest.approx(-2970.0))


# --- colours ---

@pytest.mark.parametrize("mode", ["bounces", "mesh", "power", "range", "speed"])
def test_every_segment_has_the_colour_of_its_legend(session, mode):
    session.set_color_by(mode)
    segments = session.segments(session.shown_rays(300))
    colouring = session.colouring(segments)
    assert colouring.rgb.shape == (segments.num_segments, 3) and colouring.rgb.dtype == np.uint8
    for row in range(0, segments.num_segments, 37):
        path = segments.rays[segments.ray[row]]
        if mode == "bounces":
            assert dict(colouring.legend.rows)[str(session.paths.num_bounces[path])] == tuple(colouring.rgb[row])
        elif mode == "mesh":
            of_object = dict(colouring.legend.rows)[session.mesh_names[segments.mesh_id[row]].partition("/")[0]]
            assert np.abs(np.subtract(of_object, colouring.rgb[row].astype(int))).max() <= SHADE
        else:
            columns = session.columns
            value = {"power": columns.power_dbm(), "range": columns.range, "speed": columns.velocity}[mode][path]
            assert_colour_of_scale(colouring.rgb[row], value, colouring.legend)


def assert_colour_of_scale(rgb, value: float, legend) -> None:
    """One look-up in matplotlib's own way; a value at the border of two of the 256 colours may have either."""
    low, high = legend.clim
    assert low < high
    colours = matplotlib.colormaps[legend.cmap]
    shares = [(value - low) / (high - low) * 255 + off for off in (-BORDER, BORDER)]
    rows = [int(np.clip(np.floor(share), 0, 255)) for share in shares]
    assert tuple(rgb) in [tuple(colours(row, bytes=True)[:3]) for row in rows]


def test_a_scale_of_ones_own_is_taken(session):
    session.set_color_by("power")
    segments = session.segments(session.shown_rays(10))
    rgb = session.colouring(segments, cmap="gray", clim=(-1000.0, -900.0)).rgb
    assert np.all(rgb == 255)
    with pytest.raises(ValueError, match="cmap"):
        session.colouring(segments, cmap="greyish")


# --- picking on the screen ---

def test_the_picked_segment_is_the_one_whose_picture_is_nearest():
    rng = np.random.default_rng(6)
    points, ends = rng.uniform(-1.0, 1.0, (60, 3)), np.arange(60).reshape(30, 2)
    clip_from_world = np.array([[1.2, 0, 0, 0], [0, 1.5, 0, 0], [0, 0, -1, -0.1], [0, 0, -1, 3.0]])  # eye at z = 3
    size = (400, 300)
    for cursor in rng.uniform((0, 0), size, (50, 2)):
        slow = []
        for begin, end in ends:
            dense = points[begin] + np.linspace(0, 1, 4001)[:, None] * (points[end] - points[begin])
            clip = np.column_stack([dense, np.ones(len(dense))]) @ clip_from_world.T
            x, y = clip[:, 0] / clip[:, 3], clip[:, 1] / clip[:, 3]
            slow.append(np.hypot((0.5 + 0.5 * x) * 400 - cursor[0], (0.5 - 0.5 * y) * 300 - cursor[1]).min())
        found = nearest_segment(points, ends, clip_from_world, size, cursor, reach=6.0)
        assert (found is None) == (min(slow) > 6.0)
        assert found is None or slow[found] == pytest.approx(min(slow), abs=0.2)


def test_segments_behind_the_eye_are_not_picked():
    clip_from_world = np.array([[1.0, 0, 0, 0], [0, 1, 0, 0], [0, 0, -1, -0.1], [0, 0, -1, 0.0]])  # looks along -z
    behind, across = [[0, 0, 1.0], [0, 0, 2.0]], [[0, 0, 3.0], [0.5, 0, -1.0]]
    ends = np.array([[0, 1]])
    assert nearest_segment(np.array(behind), ends, clip_from_world, (100, 100), (50, 50), 5.0) is None
    assert nearest_segment(np.array(across), ends, clip_from_world, (100, 100), (75, 50), 5.0) == 0


# --- place of the radar ---

def test_antennas_stand_and_look_where_the_placed_radar_takes_them():
    placed, by_hand = make_radars((3.0, -2.0, 1.2), 0.5, 0.1, motion=ep.LinearMotion(velocity=(4.0, 1.0, 0.0)))
    for one, other in zip(placed.receivers, by_hand.receivers, strict=True):
        for time in (0.0, 0.7):
            np.testing.assert_allclose(world_from_antenna(placed, one, time), world_from_antenna(by_hand, other, time),
                                       atol=ROUNDING)


# --- empty ---

def test_a_record_without_paths_is_a_view_too(frame):
    session = Session(from_paths(frame.scene, frame.paths.select("T .{9} R")))
    session.set_filters(Filters(min_power_dbm=-100.0, mesh="walker"))
    session.select_cells(CellBox(0, 9, 0, 9))
    assert len(session.shown_rays()) == len(session.lit_rays()) == 0
    assert not session.node_counts().any()


def test_listeners_hear_what_changed(session):
    heard = []
    session.listen(heard.append)
    session.set_chirp(10**6)
    session.set_color_by("mesh")
    session.set_part(("route", "ghost"))
    assert heard[0] == {"time"} and session.chirp == 31
    assert heard[1] == {"colours"} and {"rays", "maps"} <= heard[2]


def test_the_model_needs_neither_vtk_nor_qt():
    script = ("import sys, echopath_viewer.model, echopath_viewer.model.rays.picking, echopath_viewer.model.view_state;"
              "loaded = {name.partition('.')[0].lower() for name in sys.modules};"
              "sys.exit(bool(loaded & {'vtk', 'vtkmodules', 'pyvista', 'qtpy', 'pyside6'}))")
    assert subprocess.run([sys.executable, "-c", script]).returncode == 0
