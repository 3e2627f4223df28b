"""Panels beside the range-Doppler map: they follow the selection and select."""
from __future__ import annotations

import numpy as np
import pytest

import echopath as ep
from echopath_viewer.model import CellBox, from_frame
from echopath_viewer.model.maps.beams import beam_values
from echopath_viewer.model.maps.comparison import KeptMap, kept_map
from echopath_viewer.window.background_work import BackgroundWork
from echopath_viewer.window.qt import QtCore
from support import shapes
from support.window import LEFT, PATIENCE_MS


@pytest.fixture
def panels(qtbot, window):
    yield window.side_panels
    for name in window.side_panels:
        window.docks[name].hide()


def opened(qtbot, window, name: str):
    window.open_panel(name)
    panel = window.side_panels[name]
    qtbot.waitUntil(lambda: panel.map is not None and not panel.work.is_running, timeout=PATIENCE_MS)
    return panel


@pytest.mark.parametrize("name, axis", [("Range-azimuth", 0), ("Range-elevation", 1)])
def test_a_click_in_a_map_of_angles_selects_its_beam(qtbot, window, panels, name, axis):
    panel = opened(qtbot, window, name)
    row, column = np.unravel_index(panel.map.level.argmax(), panel.map.level.shape)
    at = panel.panel.to_pixel(panel.map.x[column], panel.map.y[row])
    qtbot.mouseClick(panel.panel, LEFT, pos=at.toPoint())
    beam = window.session.beam[axis]
    assert np.degrees(beam) == pytest.approx(panel.map.y[row], rel=0, abs=3.0)
    assert window.session.lit.any() and panel.panel.box.first_range == window.session.cell[0]
    window.session.select_cells(None)
    assert window.session.beam is None and panel.panel.box is None


@pytest.mark.parametrize("angles", [{"combine": "peak", "elevation": 0.4}, {"combine": "peak", "elevation": [-0.5, 0.0, 0.5]},
                                    {"velocity": 1.0}, {"combine": "peak", "velocity_gate": (-9.0, -1.0)}], ids=str)
def test_a_click_in_a_map_of_azimuths_selects_the_beam_whose_level_it_shows(qtbot, window, panels, angles):
    window.session.angles = angles
    panel = opened(qtbot, window, "Range-azimuth")
    shown = panel.map.level
    for row, column in [np.unravel_index(shown.argmax(), shown.shape), (shown.shape[0] // 3, 30), (1, 45)]:
        panel.pick(int(column), int(row))
        session = window.session
        found = beam_values(session.part.spectrum, session.radar, session.cell[0], *session.beam)[session.cell[1]]
        assert 20.0 * np.log10(np.abs(found)) + 30.0 == pytest.approx(shown[row, column], rel=0, abs=1e-3)


def test_cells_of_another_frame_are_not_marked_in_the_map_of_the_one_before(qtbot, window, panels, frame, monkeypatch):
    """Until its own is made: cells that the map before does not have had ended the program."""
    panel = opened(qtbot, window, "Range-azimuth")
    monkeypatch.setattr(BackgroundWork, "start", lambda self, work: None)
    longer = frame.radar.replace(waveform=frame.radar.waveform.replace(num_samples=4 * len(panel.map.x)))
    window.show_input(from_frame(ep.simulate(frame.scene, longer, num_rays=500)))
    window.session.select_cells(CellBox.around(2 * len(panel.map.x), 3))
    panel.grab()
    assert panel.panel.box is None
    qtbot.mouseClick(panel.panel, LEFT, pos=panel.panel.plot_rect().center().toPoint())
    assert window.session.beam is None


@pytest.mark.filterwarnings("ignore:.*several pairs of polarisations")
def test_beams_over_several_pairs_of_polarisations_are_cautioned_of(qtbot, window, panels, frame):
    assert opened(qtbot, window, "Range-azimuth").note.text() == ""
    crossed = [frame.radar.receivers[0].replace(polarization=(0, 1, 0)), *frame.radar.receivers[1:]]
    window.show_input(from_frame(ep.simulate(frame.scene, frame.radar.replace(receivers=crossed), num_rays=500)))
    panel = window.side_panels["Range-azimuth"]
    qtbot.waitUntil(lambda: not panel.work.is_running, timeout=PATIENCE_MS)
    assert "several pairs of polarisations" in panel.note.text()


def test_the_dynamic_range_is_that_of_maps_that_are_there_already(qtbot, window, panels):
    panel = opened(qtbot, window, "Range-azimuth")
    high = panel.colour_bar.limits[1]
    for decibels in (35, 60):
        window.map_area.range_slider.setValue(decibels)
        assert panel.colour_bar.limits == panel.panel.limits == (high - decibels, high)


def test_a_click_in_the_spectrogram_goes_to_its_chirp(qtbot, window, panels):
    panel = opened(qtbot, window, "Spectrogram")
    panel.pick(len(panel.map.x) - 1, len(panel.map.y) // 2)
    time = 1e3 * (window.session.time - window.session.paths.frame.start_time)
    assert time == pytest.approx(panel.map.x[-1], rel=0, abs=0.3)
    box = window.session.box
    assert (box.first_range, box.last_range) == (0, 127) and box.first_velocity <= box.last_velocity
    assert panel.panel.ray_cell[0] == len(panel.map.x) - 1


def test_a_click_in_the_spectrogram_goes_to_its_chirp_however_the_chirps_follow_each_other(qtbot, window, panels, frame):
    """Pairs of chirps, with a pause of ten chirps behind each: none of them ends at a multiple of the first step."""
    interval = frame.radar.waveform.chirp_interval
    radar = ep.Radar(frame.radar.waveform.replace(extra_idle=(0.0, 10.0 * interval)), transmitters=frame.radar.transmitters[:1],
                     receivers=frame.radar.receivers)
    window.show_input(from_frame(ep.simulate(frame.scene, radar, num_rays=500)))
    panel = opened(qtbot, window, "Spectrogram")
    for column in (0, len(panel.map.x) // 2, len(panel.map.x) - 1):
        panel.pick(column, 0)
        time = 1e3 * (window.session.time - window.session.paths.frame.start_time)
        assert time == pytest.approx(panel.map.x[column], rel=0, abs=1e3 * 6.0 * interval)


def test_the_beat_signal_is_that_of_the_chirp(qtbot, window, panels):
    window.open_panel("Beat signal")
    panel = window.side_panels["Beat signal"]
    qtbot.waitUntil(lambda: len(panel.curves.x) > 0, timeout=PATIENCE_MS)
    window.session.set_chirp(9)
    assert np.array_equal(panel.curves.curves["real"], window.session.cube[0, 0, 9].real)
    assert not panel.grab().isNull()


def test_a_mixer_without_quadrature_gives_no_imaginary_part(qtbot, window, panels, frame):
    radar = frame.radar.replace(waveform=frame.radar.waveform.replace(real=True))
    window.show_input(from_frame(ep.simulate(frame.scene, radar, num_rays=500)))
    window.open_panel("Beat signal")
    assert list(window.side_panels["Beat signal"].curves.curves) == ["real"]


def test_maps_are_compared_over_channels_and_files(qtbot, window, panels, stored_run):
    window.open_panel("Compare")
    panel = window.side_panels["Compare"]
    qtbot.waitUntil(lambda: panel._is_seen, timeout=PATIENCE_MS)
    panel.keep()
    assert not panel.change.any()
    window.session.set_channel(1, 1)
    levels = [window.session.parts.whole.level(*channel) for channel in ((0, 0), (1, 1))]
    row, column = np.unravel_index(levels[0].argmax(), levels[0].shape)
    assert panel.change[row, column] == pytest.approx(levels[1][row, column] - levels[0][row, column], rel=0, abs=1e-4)
    window.session.select_cells(CellBox.around(int(column), int(row)), (int(column), int(row)))
    assert f"{abs(panel.change[row, column]):.1f} dB" in panel.note.text()
    panel.keep_file(stored_run.paths_of_files[0])
    assert panel.kept.title == "frame_0000.h5" and panel.change.shape == levels[0].shape
    panel.keep_file("no such file.h5")
    assert "no such file" in panel.note.text() and panel.kept.title == "frame_0000.h5"


def test_no_change_is_told_where_the_map_that_was_kept_has_no_cells(qtbot, window, panels):
    window.open_panel("Compare")
    panel = window.side_panels["Compare"]
    qtbot.waitUntil(lambda: panel._is_seen, timeout=PATIENCE_MS)
    now = kept_map(window.session, "now")
    half = len(now.range) // 2
    panel.kept = KeptMap("near", now.level[:, :half] - 3.0, now.range[:half], now.velocity)
    panel.refresh()
    row, column = np.unravel_index(now.level[:, :half].argmax(), (len(now.velocity), half))
    for at, told in ((column, "+3.0 dB"), (len(now.range) - 2, "not in the map that was kept")):
        panel.panels["difference"].hovered.emit(float(now.range[at]), float(now.velocity[row]), 0.0)
        assert panel.note.text().endswith(told)
        window.session.select_cells(CellBox.around(int(at), int(row)), (int(at), int(row)))
        assert panel.note.text() == f"the selected cell: {told}"


def test_why_there_is_no_map_is_told_of_that_frame_alone(qtbot, window, panels, frame):
    panel = opened(qtbot, window, "Range-azimuth")
    one = frame.radar.replace(transmitters=frame.radar.transmitters[:1], receivers=frame.radar.receivers[:1])
    window.show_input(from_frame(ep.simulate(frame.paths.scene, one, num_rays=300, guard=False)))
    qtbot.waitUntil(lambda: panel.map is None, timeout=PATIENCE_MS)
    panel.panel.left.emit()  # the mouse has crossed the panel
    assert panel.note.text() == "There is no map to show: the antennas of this radar tell no azimuths apart."
    window.show_input(from_frame(frame))
    qtbot.waitUntil(lambda: panel.map is not None, timeout=PATIENCE_MS)
    assert panel.note.text() == ""


def test_files_of_maps_show_the_azimuths_that_they_keep(qtbot, window, panels, moving_sequence, tmp_path):
    """Their range-Doppler map has the same values in all channels, which beams would take for an echo from straight ahead."""
    scene = ep.Scene()
    scene.add(shapes.plate((6.0, 4.0, 0.0), (-0.83, -0.55, 0.0), 0.6), name="plate", material=shapes.lambert(0.8))
    run = ep.Sequence(scene, moving_sequence.radar, frames=1, interval=0.2, num_rays=1000, max_bounces=1)
    run.save(tmp_path / "maps", keep="maps")
    assert window.open_file(tmp_path / "maps")
    assert window.map_area.channel_box.currentText() == "mean of 4 channels"
    panel = opened(qtbot, window, "Range-azimuth")
    row, column = np.unravel_index(panel.map.level.argmax(), panel.map.level.shape)
    assert panel.map.y[row] == pytest.approx(np.degrees(np.arctan2(4.0, 6.0)), rel=0, abs=4.0)
    assert panel.map.x[column] == pytest.approx(np.hypot(6.0, 4.0), rel=0, abs=0.3)
    window.open_panel("Spectrogram")
    qtbot.waitUntil(lambda: "this file keeps maps" in window.side_panels["Spectrogram"].note.text(), timeout=PATIENCE_MS)


def test_files_of_labels_alone_show_no_level(qtbot, window, moving_sequence, tmp_path):
    run = ep.Sequence(moving_sequence.scene, moving_sequence.radar, frames=1, interval=0.2, num_rays=1000, labels=True)
    run.save(tmp_path / "labels", keep="labels")
    assert window.open_file(tmp_path / "labels")
    area = window.map_area
    (panel,) = area.panels.values()
    assert panel.title == "no map: the file keeps labels alone" and area.colour_bar.isHidden()
    panel.hovered.emit(5.0, 0.0, float(panel.level[0, 0]))
    assert "dBm" not in area.read_out.text() and "no signal" in area.read_out.text()
    window.show_input(from_frame(moving_sequence[0]))
    assert not area.colour_bar.isHidden()


def test_maps_that_are_compared_show_all_of_the_new_axes(qtbot, window, panels, frame):
    window.open_panel("Compare")
    panel = window.side_panels["Compare"]
    qtbot.waitUntil(lambda: panel._is_seen, timeout=PATIENCE_MS)
    panel.keep()
    waveform = frame.radar.waveform
    fine = frame.radar.replace(waveform=waveform.replace(bandwidth=2 * waveform.bandwidth))
    window.show_input(from_frame(ep.simulate(frame.paths.scene, fine, num_rays=300, guard=False)))
    axes, view = window.session.parts.whole.spectrum, panel.panels["now"].view
    assert view.right() == pytest.approx(axes.range[-1] + 0.5 * axes.range[1]) and view.left() < axes.range[0]
    panel._set_view(QtCore.QRectF(-2.0 * view.width(), view.top(), 4.0 * view.width(), view.height()))
    beyond = panel.panels["difference"].grab().toImage().pixelColor(60, 60)  # left of range 0: nothing has changed there
    assert max(beyond.red(), beyond.blue()) - min(beyond.red(), beyond.blue()) < 10
    panel.panels["now"].view_reset.emit()
    assert panel.panels["now"].view == view


def test_of_no_echo_it_is_said_that_there_is_no_signal(qtbot, window, panels, frame):
    with pytest.warns(RuntimeWarning, match="no mesh that takes part"):
        empty = ep.simulate(ep.Scene(), frame.radar, num_rays=100, noise_seed=3)
    window.show_input(from_frame(empty))
    assert window.time_bar.strip._text() == "Power by chirp, all echoes: no signal"
    made = opened(qtbot, window, "Spectrogram")
    assert made.words_of(1.0, 0.0, float(made.map.level.max())).endswith("no signal")
    assert made.colour_bar.limits[1] == 0.0  # and not -2970 dBm, the smallest power there is


def test_twins_of_ghosts_stand_in_the_scene(qtbot, window):
    window.layer_actions["ghost twins"].setChecked(True)
    plotter, twins = window.view3d, window.session.known_data("ghost twins")
    assert len(twins) > 0 and all(f"twin {number}" in plotter.actors for number in range(len(twins)))
    legend = window.map_area.layer_legend
    assert all(f"ghost, type {twin.ghost_type}" in legend.text() for twin in twins) and legend.isVisible()
    window.layer_actions["ghost twins"].setChecked(False)
    assert legend.isHidden()
    assert not any(name.startswith("twin ") for name in plotter.actors)
