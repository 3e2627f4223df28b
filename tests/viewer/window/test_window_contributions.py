"""What makes a cell, asked for by real clicks."""
from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

import echopath as ep
from echopath_viewer.model.maps.attribution import CellAttribution, Contribution
from echopath_viewer.window.background_work import BackgroundWork
from echopath_viewer.window.maps.contributions import HINT, kind_of
from echopath_viewer.window.maps.phasors import PhasorDiagram
from support.window import PATIENCE_MS, click_cell, settle, strongest_cell

WHOLE = ("whole", "whole")


@pytest.fixture
def panel(qtbot, window):
    window.docks["What makes the cell"].raise_()
    settle(qtbot)
    assert window.contributions.title.text() == HINT
    return window.contributions


def wait_for(qtbot, panel) -> None:
    qtbot.waitUntil(lambda: panel.session.attribution is not None and not panel.work.is_running, timeout=PATIENCE_MS)
    settle(qtbot)


def test_a_clicked_cell_tells_its_echoes_and_what_it_would_be_without(qtbot, window, frame, panel):
    distance, velocity = strongest_cell(window, WHOLE)
    click_cell(qtbot, window, WHOLE, distance, velocity)
    wait_for(qtbot, panel)
    assert window.session.cell == (distance, velocity)
    level = window.session.parts.whole.level(0, 0)[velocity, distance]
    assert f"{level:.1f} dBm".replace("-", "−") in panel.title.text()
    assert panel._rows[0].name in panel.title.text()
    panel._cell_told = "10.94 m, -3.97 m/s: -115.9 dBm", "mostly a ghost: pedestrian by way of wall_left and of the garage door"
    panel._break_title()
    assert panel.title.sizeHint().width() <= panel.width() and "<br>" in panel.title.text()
    assert "without wall_left " in panel.without.text() and "dB" in panel.without.text()
    assert panel.without.height() >= panel.without.sizeHint().height() and panel.without.sizeHint().width() <= panel.width()
    values = [one.value for one in panel._rows]
    assert panel.table.rowCount() == len(values) > 2 and np.all(np.diff(np.abs(values)) <= 0.0)
    total = frame.spectrum.values[0, 0, velocity, distance]
    assert panel.phasors.corners()[-1] == pytest.approx(abs(total), rel=1e-6, abs=1e-9 * abs(total))
    assert not panel.bar.isVisible()


@pytest.mark.parametrize("kind", ["ghost", "object", "rest"])
def test_a_cell_says_in_words_what_makes_most_of_it(kind):
    family = SimpleNamespace(object="walker", via=("wall_left", "floor"), is_ghost=kind == "ghost")
    group = SimpleNamespace(family=family)
    weak, strong = Contribution("weak", 0.5j, 0.0), Contribution("walker itself", -2.0, 0.0, None if kind == "rest" else group)
    assert CellAttribution(1.0, (weak, strong), ()).strongest is strong
    words = "a ghost: walker by way of wall_left and floor" if kind == "ghost" else "walker itself"
    assert kind_of(strong) == words


def test_a_chosen_row_lights_its_paths_wherever_they_lie(qtbot, window, frame, panel):
    click_cell(qtbot, window, WHOLE, *strongest_cell(window, WHOLE))
    wait_for(qtbot, panel)
    families = ep.families(frame.paths)
    for row, one in enumerate(panel._rows[:3]):
        panel.table.selectRow(row)
        settle(qtbot)
        assert panel.table.rowCount() == len(panel._rows)  # the table stays
        lit = window.session.lit
        if one.group is not None and one.group.family.object:
            wanted = families.family_of_path == families.families.index(one.group.family)
            assert np.array_equal(lit, wanted & window.session.visible)
            assert set(window.view3d.builder.lit.segments.rays) <= set(np.flatnonzero(wanted))


def test_groups_of_paths_hold_each_path_once(qtbot, window, panel):
    window.session.select_cells(None)
    click_cell(qtbot, window, WHOLE, *strongest_cell(window, WHOLE))
    wait_for(qtbot, panel)
    attribution = window.session.attribution
    counts = sum(attribution.paths_of(group).astype(int) for group in attribution.groups)
    assert np.all(counts == 1)


def test_arrows_go_head_to_tail_to_the_sum(qtbot):
    diagram = PhasorDiagram()
    qtbot.addWidget(diagram)
    values = np.array([3.0, 2.0j, -1.0, *(0.1 * np.exp(1j * np.arange(20)))])
    diagram.show_values(values, values.sum())
    corners = diagram.corners()
    assert corners[-1] == pytest.approx(abs(values.sum())) and abs(corners[1]) == pytest.approx(3.0)
    diagram.show_values([], 1.0)
    assert len(diagram.corners()) == 1


def test_work_that_is_replaced_or_fails_says_so(qtbot):
    work, results, errors = BackgroundWork(), [], []
    work.done.connect(results.append)
    work.failed.connect(errors.append)
    work.start(lambda progress: 1)
    work.start(lambda progress: 2)
    qtbot.waitUntil(lambda: results == [2], timeout=PATIENCE_MS)

    def fail(progress):
        raise ValueError("too large")

    work.start(fail)
    qtbot.waitUntil(lambda: errors == ["too large"], timeout=PATIENCE_MS)
    qtbot.wait(50)
    assert results == [2] and not work.is_running
