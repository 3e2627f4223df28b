"""A small frame that all tests of the viewer look at."""
from __future__ import annotations

import gc
import os
import sys
import tempfile

import pytest

import echopath as ep
from support import shapes

NEEDS_SCREEN = "test_window_"  # how their files' names begin


def pytest_configure(config):
    """Settings that windows remember are not those of the person who runs the tests."""
    folder = tempfile.TemporaryDirectory(prefix="echopath-settings-")
    config.add_cleanup(folder.cleanup)
    os.environ["XDG_CONFIG_HOME"] = folder.name


def pytest_collection_modifyitems(items):
    """Without a screen Qt would end the program: bootstrap.sh runs these tests under a virtual one."""
    if sys.platform != "linux" or os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"):
        return
    skip = pytest.mark.skip(reason="needs a screen: xvfb-run -a -s '-screen 0 1600x1000x24' python -m pytest tests/viewer")
    for item in items:
        if item.path.name.startswith(NEEDS_SCREEN):
            item.add_marker(skip)


@pytest.fixture(scope="session")
def frame():
    """A walker of two parts between two rough walls, seen by two transmitters and two receivers; some thousand paths."""
    rough = shapes.lambert(0.8)
    scene = ep.Scene()
    scene.add(None, name="walker", motion=ep.LinearMotion(velocity=(-3.0, 0.5, 0.0)))
    for name, height in (("head", 0.5), ("legs", -0.5)):
        scene.add(shapes.plate((6.0, 0.0, height), (-1.0, 0.0, 0.0), 0.9), name=name, parent="walker", material=rough)
    for name, side in (("left", 1.0), ("right", -1.0)):
        scene.add(shapes.plate((5.0, 3.0 * side, 0.0), (0.0, -side, 0.0), 8.0), name=f"wall_{name}", material=rough)
    radar = ep.Radar(ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=128, sampling_rate=10e6,
                                      num_chirps=32, chirp_interval=2e-4),
                     transmitters=[ep.Antenna((0, 0, 0)), ep.Antenna((0, 0.4, 0))],
                     receivers=[ep.Antenna((0, 0.01, 0)), ep.Antenna((0, -0.4, 0.2))])
    parts = {"route": {"direct": "T 'walker' R", "ghost": "T .* 'walker' .* R"}, "count": {"one": "T . R"}}
    return ep.simulate(scene, radar, num_rays=4000, max_bounces=3, seed=3, parts=parts)


@pytest.fixture(autouse=True)
def no_question_to_nobody(request, monkeypatch):
    """Who asks for a file by a dialog would wait for ever; a test that chooses one puts it in the dialog's place."""
    if not request.path.name.startswith(NEEDS_SCREEN):
        return
    from echopath_viewer.window.qt import QtWidgets

    def refuse(*_):
        raise AssertionError("a dialog asks for a file, and nobody is there to answer")

    for name in ("getOpenFileName", "getOpenFileNames", "getSaveFileName", "getExistingDirectory"):
        monkeypatch.setattr(QtWidgets.QFileDialog, name, refuse)


@pytest.fixture(autouse=True)
def close_plotters(request):
    """VTK keeps plotters that were not closed; windows close their own."""
    yield
    if request.path.name.startswith(NEEDS_SCREEN):
        return
    pyvista = sys.modules.get("pyvista")
    if pyvista is not None:
        pyvista.close_all()
        gc.collect()


@pytest.fixture(scope="module")
def shared_window(qapp):
    """One window for all tests of a file: what a window costs is mostly its first picture."""
    from echopath_viewer.window import MainWindow

    window = MainWindow()
    window.resize(1210, 700)
    window.show()
    window.activateWindow()
    yield window
    window.close()


@pytest.fixture
def window(qtbot, shared_window, frame):
    """Fresh, as far as it shows."""
    from echopath_viewer.model import from_frame
    from support.window import Qt, open_on_screen

    window = shared_window
    window.show_input(from_frame(frame, title="frame"))
    window.map_area.show_one(False)
    window.map_area.set_view(window.map_area.whole_view)
    window.filter_box.hits_check.setChecked(False)
    window.docks["Rays"].raise_()
    window.filter_box.name_edit.clear()
    window.filter_box.show_name_error("")
    window.table.view.sortByColumn(3, Qt.SortOrder.DescendingOrder)
    open_on_screen(qtbot, window)
    return window


@pytest.fixture(scope="session")
def moving_sequence():
    """A plate that drives at a radar of four receivers with 4 m/s before a wall, three frames every 0.2 s, with detections."""
    scene = ep.Scene()
    scene.add(shapes.plate((6.0, 0.5, 0.0), (-1.0, 0.0, 0.0), 0.6), name="plate", material=shapes.lambert(0.8),
              motion=ep.LinearMotion(velocity=(-4.0, 0.0, 0.0)))
    scene.add(shapes.plate((12.0, 0.0, 0.0), (-1.0, 0.0, 0.0), 6.0), name="wall", material=shapes.lambert(0.8))
    chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=600e6, num_samples=64, sampling_rate=10e6, num_chirps=32,
                              chirp_interval=2e-4)
    radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 0))],
                     receivers=[ep.Antenna((0, 0.5 * index * chirps.wavelength, 0)) for index in range(4)], transmit_power=0.1)
    return ep.Sequence(scene, radar, frames=3, interval=0.2, num_rays=3000, max_bounces=2, detections=True)


@pytest.fixture(scope="session")
def stored_run(moving_sequence, tmp_path_factory):
    """The same in a folder of files."""
    return moving_sequence.save(tmp_path_factory.mktemp("run"))
