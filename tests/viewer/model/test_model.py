"""The model of the viewer, without VTK and Qt: filters, cells, selections, colours, against slow loops."""
from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

import echopath as ep
from echopath_viewer.model import CellBox, CellIndex, FilterError, Filters, Session, from_paths
from support.behind_sheets import make_radar, make_scene
from support.scenes.session_hits import hit_names


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


@pytest.mark.parametrize("hide", [lambda session: session.set_filters(Filters(min_bounces=3)),
                                  lambda session: session.set_part(("count", "other"))])
def test_a_chosen_ray_that_is_hidden_is_chosen_no_more(session, hide):
    single = int(np.flatnonzero(session.paths.num_bounces == 1)[0])
    session.select_ray(single)
    session.set_filters(Filters(max_bounces=2))
    assert session.ray == single
    hide(session)
    assert not session.visible[single] and session.ray is None


def test_a_ray_tells_the_sheets_that_it_goes_through_on_its_way():
    scene = make_scene()
    session = Session(from_paths(scene, ep.trace(scene, make_radar(), num_rays=500, max_bounces=2)))
    for text, told in (("T P'pane' 'ball' P'pane' R", ["through", "hit 1", "through"]),
                       ("T 'pane' R & ~(T .* P .* R)", ["hit 1"])):
        ray = int(np.flatnonzero(session.matches(Filters(expression=text).selection()))[0])
        lines = [line for line in session.explain(ray) if line[0] in ("through", "hit 1", "hit 2")]
        assert [label for label, _ in lines] == told
        assert {text for label, text in lines if label == "through"} <= {"pane"}


def test_scales_of_range_and_speed_are_those_of_a_gesture():
    """Fingers 58 and 68 mm ahead, the first of which comes with 20 mm/s: no more than that is the scale."""
    scene = ep.Scene()
    for name, ahead, across, speed in (("first", 0.06, 0.01, -0.02), ("second", 0.07, -0.01, 0.0)):
        scene.add(ep.actors.box(size=(0.004, 0.004, 0.004)), name=name, position=(ahead, across, -0.002), material="skin",
                  motion=ep.LinearMotion(velocity=(speed, 0.0, 0.0)))
    chirps = ep.ChirpSequence(start_frequency=60e9, bandwidth=6e9, num_samples=32, sampling_rate=2e6, num_chirps=4,
                              chirp_interval=1e-4)
    radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 0))], receivers=[ep.Antenna((0, 0.001, 0))])
    session = Session(from_paths(scene, ep.trace(scene, radar, num_rays=300, max_bounces=1)))
    session.set_color_by("range")
    low, high = session.colouring(session.segments(session.shown_rays())).legend.clim
    assert 0.057 < low < high < 0.075
    session.set_color_by("speed")
    assert session.colouring(session.segments(session.shown_rays())).legend.clim == pytest.approx((-0.02, 0.02), rel=0.05)


def test_a_cell_shows_its_power_from_chirp_to_chirp(session, frame):
    session.select_cells(CellBox(0, 60, 0, 31))
    cube = ep.synthesize(frame.paths.select(session.lit))[0, 0]
    slow = [10 * np.log10(np.mean(np.abs(chirp) ** 2) * 1e3) for chirp in cube]
    assert session.slow_time_power() == pytest.approx(slow, abs=1e-6)
    assert ep.power_by_chirp(cube[None, None]) == pytest.approx(slow, abs=1e-9)
    assert np.all(ep.power_by_chirp(np.zeros((1, 1, 3, 4))) == pytest.approx(-2970.0))


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
