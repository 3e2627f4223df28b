"""`echopath view` from a shell: what it says where it cannot open a window, and that Ctrl-C closes one."""
from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time

import pytest

import echopath as ep
from echopath.cli import main

PATIENCE = 60  # s
VIEW = [sys.executable, "-m", "echopath", "view"]
HAS_SCREEN = sys.platform != "linux" or bool(os.environ.get("DISPLAY"))
# A picture of a scene that does not come.
WAITING = """
import sys
from echopath.cli import main
from echopath_viewer.window import settling

def late(window):
    print("up", flush=True)
    return ["scene"]

settling.what_is_late = late
sys.exit(main(["view", sys.argv[1], "--picture", "waited_for.png"]))
"""
# A window that announces itself and then does `work` with it.
ANNOUNCED = """
import sys
import echopath as ep
from echopath.cli import main
from echopath.base.process.interrupts import interrupts_are_kept
from echopath_viewer.window.busy import run_with_progress
from echopath_viewer.window.qt import QtCore
from echopath_viewer.window import MainWindow

def work(window):
    print("up", flush=True)
    {work}

shown = MainWindow.showEvent
MainWindow.showEvent = lambda self, event: (shown(self, event), QtCore.QTimer.singleShot(0, lambda: work(self)))
sys.exit(main(["view", sys.argv[1]]))
"""
LONG = 300.0  # s
WORK = {
    "nothing": "pass",
    "work with a progress bar": f"run_with_progress(window, 'Waiting', lambda progress: ep._core._wait({LONG}, progress))",
    "work without": f"ep._core._wait({LONG})",
    "a file": f"""with interrupts_are_kept():
        ep._core._wait({LONG})""",
}
HEAD_START = 1.0  # s, of the work before Ctrl-C: the progress bar is up
STOPS_WITHIN = 10.0  # s, of a busy machine that closes a window, drawn in software


def run(command, **environment) -> subprocess.CompletedProcess:
    names = os.environ | environment
    return subprocess.run(command, env={name: value for name, value in names.items() if value}, capture_output=True,
                          text=True, timeout=PATIENCE)


def test_a_file_that_is_none_of_ours_is_refused_before_a_window_opens(tmp_path, monkeypatch, capsys):
    (tmp_path / "frame.h5").write_text("not HDF5")
    from echopath_viewer.window import MainWindow

    monkeypatch.setattr(MainWindow, "showEvent", None)  # no window opens
    assert main(["view", str(tmp_path / "frame.h5")]) == 2
    told = capsys.readouterr().err
    assert told.startswith("echopath: ") and "frame.h5" in told and len(told.splitlines()) == 1


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have a screen")
def test_without_a_screen_it_says_so_at_once(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    done = run(VIEW, DISPLAY="", WAYLAND_DISPLAY="", QT_QPA_PLATFORM="")
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"):
        monkeypatch.delenv(name, raising=False)
    code = main(["demo", "--view", "--out", "nowhere"])
    for number, told in ((done.returncode, done.stderr), (code, capsys.readouterr().err)):
        assert number == 2 and "needs a screen" in told and "off_screen" in told
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have a screen")
def test_a_platform_of_qt_without_opengl_is_named_instead_of_a_wait_for_its_scene():
    done = run(VIEW, DISPLAY="", WAYLAND_DISPLAY="", QT_QPA_PLATFORM="minimal")
    assert done.returncode == 2 and "OpenGL, which Qt's platform 'minimal'" in done.stderr and "off_screen" in done.stderr


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have one screen")
def test_a_library_of_the_screen_that_cannot_be_loaded_is_named_before_qt_ends_the_program(tmp_path, monkeypatch):
    """As where libxcb-icccm4 is not installed: the loader of the system says which file it is."""
    from echopath_viewer.window import app, qt

    monkeypatch.setenv("DISPLAY", ":1")
    for name in ("WAYLAND_DISPLAY", "QT_QPA_PLATFORM"):
        monkeypatch.delenv(name, raising=False)
    (tmp_path / "platforms").mkdir()
    (tmp_path / "platforms" / "libqxcb.so").write_text("no library")
    monkeypatch.setattr(qt.QtCore.QLibraryInfo, "path", lambda place: str(tmp_path))
    with pytest.raises(OSError, match=r"needs a library of the system: .*libqxcb.so.*apt install .*libxcb-icccm4"):
        app.require_screen()


def test_without_the_extra_it_says_what_to_install():
    script = "import sys; sys.modules['pyvistaqt'] = None; from echopath.cli import main; sys.exit(main(['view']))"
    done = run([sys.executable, "-c", script])
    assert done.returncode == 2 and "pip install 'echopath[viewer]'" in done.stderr


@pytest.mark.hard
@pytest.mark.skipif(not HAS_SCREEN, reason="needs a screen")
@pytest.mark.parametrize("script", [*(ANNOUNCED.format(work=work) for work in WORK.values()), WAITING],
                         ids=[*WORK, "a picture"])
def test_ctrl_c_ends_the_work_and_closes_the_window(frame, tmp_path, script):
    ep.save_frame(frame, tmp_path / "frame.h5")
    command = [sys.executable, "-c", script, str(tmp_path / "frame.h5")]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler)) as viewer:
        watchdog = threading.Timer(PATIENCE, viewer.kill)  # where the window never comes up
        watchdog.start()
        assert viewer.stdout.readline() == "up\n"
        watchdog.cancel()
        time.sleep(HEAD_START)
        viewer.send_signal(signal.SIGINT)
        begin = time.monotonic()
        try:
            _, errors = viewer.communicate(timeout=PATIENCE)
        finally:
            viewer.kill()
    assert viewer.returncode == 130 and errors.splitlines()[-1] == "echopath: stopped; no file was left half written"
    assert "Traceback" not in errors and "Error" not in errors
    assert time.monotonic() - begin < STOPS_WITHIN
