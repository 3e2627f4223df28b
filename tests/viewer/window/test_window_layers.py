"""Labels, detections and truth over maps and scene."""
from __future__ import annotations

import numpy as np
import pytest

import echopath as ep
from echopath_viewer.model.maps.layers import BOX_EDGES, LAYERS, Marker
from echopath_viewer.window.qt import QtCore
from support.window import LEFT, panel_of, settle

WHOLE = ("whole", "whole")


@pytest.fixture
def layered(qtbot, window):
    yield window
    for action in window.layer_actions.values():
        action.setChecked(False)
    settle(qtbot)


def test_labels_lie_over_the_cells_that_they_label(qtbot, layered, frame):
    layered.layer_actions["labels"].setChecked(True)
    settle(qtbot)
    labels = ep.annotate_frame(frame)["route"]
    panel = panel_of(layered, *WHOLE)
    drawn = np.frombuffer(panel._overlay.constBits(), np.uint8).reshape(*labels.dominant.shape, 4)[::-1]
    assert np.array_equal(drawn[..., 3] > 0, labels.dominant >= 0) and (labels.dominant >= 0).any()
    for part in np.unique(labels.dominant[labels.dominant >= 0]):
        assert len(np.unique(drawn[labels.dominant == part], axis=0)) == 1
        assert labels.part_names[part] in layered.map_area.layer_legend.text()
    assert panel_of(layered, "route", "ghost")._overlay is None
    layered.layer_actions["labels"].setChecked(False)
    assert panel._overlay is None and layered.map_area.layer_legend.isHidden()


def test_a_click_on_a_detection_lights_its_paths(qtbot, layered, frame):
    layered.layer_actions["detections"].setChecked(True)
    settle(qtbot)
    panel, detections = panel_of(layered, *WHOLE), ep.detect_frame(frame)
    markers = [marker for marker in panel.markers if marker.kind == "detection"]
    assert len(markers) == len(detections.range) > 0
    index = int(np.argmax(np.where(detections.is_noise, 0.0, detections.power)))
    marker = markers[index]
    layered.map_area.set_view(QtCore.QRectF(marker.range - 0.5, marker.velocity - 0.5, 1.0, 1.0))
    qtbot.mouseClick(panel, LEFT, pos=panel.to_pixel(marker.range, marker.velocity).toPoint())
    settle(qtbot)
    session = layered.session
    assert session.cell == tuple(int(value) for value in detections.cells[index][::-1])
    assert set(np.flatnonzero(session.lit)) == set(detections.paths(index)[0])
    assert f"of detection {index}" in layered.filter_box.count_label.text()


def test_a_click_takes_the_detection_below_the_marker_of_an_object(qtbot, layered, monkeypatch):
    panel, spectrum, clicked = panel_of(layered, *WHOLE), layered.session.parts.whole.spectrum, []
    at = float(spectrum.range[20]), float(spectrum.velocity[16])
    layered.map_area.set_view(QtCore.QRectF(at[0] - 0.5, at[1] - 0.5, 1.0, 1.0))
    panel.show_layers(None, [Marker("object", *at, "walker", (9, 9, 9)), Marker("detection", *at, "one", (9, 9, 9), detection=7)])
    monkeypatch.setattr(layered.map_area, "_pick_detection", lambda key, index: clicked.append(index))
    qtbot.mouseClick(panel, LEFT, pos=panel.to_pixel(*at).toPoint())
    assert clicked == [7]


def test_detections_and_true_boxes_stand_in_the_scene(qtbot, layered, frame):
    for layer in ("detections", "truth"):
        layered.layer_actions[layer].setChecked(True)
    settle(qtbot)
    known = layered.view3d.builder.known
    points = np.asarray(ep.detect_frame(frame).points)
    has_place = np.isfinite(points).all(axis=1)
    assert known._points.GetMapper().GetInput().GetNumberOfPoints() == np.count_nonzero(has_place) > 0
    truth = frame.truth
    assert known._boxes.GetMapper().GetInput().GetNumberOfLines() == 12 * len(truth.name) > 0
    lengths = np.linalg.norm(np.diff(truth.corners[:, BOX_EDGES], axis=2)[:, :, 0], axis=-1)
    assert np.sort(lengths, axis=1) == pytest.approx(np.sort(np.repeat(truth.size, 4, axis=1), axis=1))
    crosses = [marker for marker in panel_of(layered, *WHOLE).markers if marker.kind == "truth"]
    assert [marker.range for marker in crosses] == pytest.approx(list(truth.range))


def test_names_of_objects_stand_on_no_others(qtbot, layered):
    panel = panel_of(layered, *WHOLE)
    spot = layered.session.parts.whole.spectrum
    at = float(spot.range[20]), float(spot.velocity[16])
    near = [Marker("object", at[0] + 0.01 * number, at[1], f"walker_{number}", (9, 9, 9)) for number in range(4)]
    far = Marker("object", float(spot.range[60]), float(spot.velocity[4]), "far", (9, 9, 9))
    panel.show_layers(None, [*near, far])
    names = panel.names_of_objects(panel.fontMetrics())
    assert [text for text, _ in names] == ["walker_0", "far"]
    assert not names[0][1].intersects(names[1][1])


@pytest.mark.parametrize("share", [(0.01, 0.01), (0.01, 0.99), (0.99, 0.01), (0.99, 0.99)])
def test_names_of_objects_at_the_edges_stand_within_the_map(qtbot, layered, share):
    panel = panel_of(layered, *WHOLE)
    place = panel.view.left() + share[0] * panel.view.width(), panel.view.top() + share[1] * panel.view.height()
    panel.show_layers(None, [Marker("object", *place, "pedestrian", (9, 9, 9))])
    (_, rect), = panel.names_of_objects(panel.fontMetrics())
    assert panel.plot_rect().contains(rect) and not rect.contains(panel.to_pixel(*place))


def test_every_layer_comes_and_goes(qtbot, layered):
    for layer in LAYERS:
        layered.layer_actions[layer].setChecked(True)
        assert layer in layered.session.layers
    settle(qtbot)
    assert not layered.banner.isVisible() and layered.map_area.layer_legend.isVisible()
    for layer in LAYERS:
        layered.layer_actions[layer].setChecked(False)
    assert not layered.session.layers and not panel_of(layered, *WHOLE).markers


def test_paths_alone_know_no_detections(frame):
    from echopath_viewer.model import Session, from_paths
    session = Session(from_paths(None, frame.paths))
    with pytest.raises(ValueError, match="detections: only frames have them, not paths alone or live views"):
        session.set_layer("detections", True)
    with pytest.raises(ValueError, match="layer: must be one of labels, .*, detections, truth, ghost twins, names, got 'x'"):
        session.set_layer("x", True)
