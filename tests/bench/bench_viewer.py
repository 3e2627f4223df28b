"""Time that the viewer works for after a filter, a colouring, a pick or a step in time, and until its window is up.

    xvfb-run -a -s "-screen 0 1600x1000x24" python tests/bench/bench_viewer.py [--paths 200000 | --frame FILE]

The street demo with as many paths, or a frame file. Computing is all from the change to data ready to be drawn, lists and
tables included; "to picture" has the drawing, too. Least of several changes. Verdicts go by processor time
of all threads, which other programs do not disturb and which on two cores is no less than the time a person waits; the
latter stands beside it.
"""
from __future__ import annotations

import argparse
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import echopath as ep
from echopath.base.text.mesh_names import object_of
from echopath.live.watch import FEWEST_PREVIEW_RAYS
from echopath.paths.subset import strongest, subset
from echopath_viewer.model import CellBox, Filters, from_file
from echopath_viewer.model.frames.live_session import live_of, session_of_view
from echopath_viewer.model.maps.attribution import Attribution
from echopath_viewer.model.view_state import state_of
from echopath_viewer.window import MainWindow
from echopath_viewer.window.files.demo import NUM_RAYS, simulate_demo
from echopath_viewer.window.qt import QtWidgets

NUM_REPETITIONS, NUM_STARTS = 7, 3
MAX_GROWTH = 1.1   # of memory, from the first opening of a file to the next ones
MAX_START = 2.0  # s, promised for scene and map of a file of 3 million paths, whose rays follow
MORE_RAYS = 1.02   # than paths ask for: their number grows a little less than that of the rays
NUM_TURNS, ORBIT_RATE = 60, 15.0  # pictures; pictures/s promised for 20,000 rays
LIVE_RAYS, NUM_MOVES = 50_000, 4
# s, promised for scene, rays and map of a dragged object, and of full quality; watch and window share the cores.
MAX_PREVIEW, MAX_SETTLED, NUM_CORES = 0.1, 2.0, 2
# s of processor time from a change to its picture, promised for 3 million paths drawn by software.
MAX_TO_PICTURE = {"filter": 0.150, "colour": 0.060, "cell": 0.100, "step in time": 0.100, "what makes": 0.100}
START = """
import os, sys
from echopath_viewer.window import view
from echopath_viewer.window.qt import QtWidgets
window = view(sys.argv[1], block=False)
while window.isHidden() or window.view3d._is_fresh:
    QtWidgets.QApplication.processEvents()
window.view3d.repaint()
if len(sys.argv) > 2:
    window.settle()
    window.view3d.repaint()
os._exit(0)
"""
OPENINGS = """
import gc, os, sys, time
from echopath_viewer.window import MainWindow
from echopath_viewer.window.qt import QtWidgets
application = QtWidgets.QApplication([])
window = MainWindow(remembers=False)
for _ in range(3):
    window.open_file(sys.argv[1])
    window.settle()
    gc.collect()
    rest = time.monotonic() + 2.0
    while time.monotonic() < rest:
        application.processEvents()
    print(4096 * int(open("/proc/self/statm").read().split()[1]), flush=True)
os._exit(0)
"""


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--paths", type=int, default=200_000)
    options.add_argument("--frame")
    given = options.parse_args()
    if given.frame is not None:
        bench_start(Path(given.frame))
        bench_memory(Path(given.frame))
        bench_changes(Path(given.frame))
        return
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "frame.h5"
        save_street(path, given.paths)
        print(f"street demo, {given.paths:,} paths, {path.stat().st_size / 2**20:.0f} MiB")
        bench_start(path)
        bench_memory(path)
        bench_changes(path)


def save_street(path: Path, num_paths: int) -> None:
    """The strongest paths of the demo, with its whole signal and one partition."""
    frame = demo_of(num_paths)
    keep = np.zeros(frame.paths.num_paths, bool)
    keep[strongest(frame.path_power, num_paths)] = True
    frame.paths = subset(frame.paths, keep)
    frame.part_of_path = {name: labels[keep] for name, labels in frame.part_of_path.items()}
    del frame.path_power
    ep.save_frame(frame, path)


def demo_of(num_paths: int):
    """The frame of the demo with as many rays as it takes to have so many paths."""
    num_rays = NUM_RAYS
    while (frame := simulate_demo(None, num_rays)).paths.num_paths < num_paths:
        num_rays = 1 + int(MORE_RAYS * num_rays * num_paths / max(frame.paths.num_paths, 1))
    return frame


def bench_start(path: Path) -> None:
    """From the start of Python to the first picture, and to that with rays, each in processes of its own; the least of three,
    the first of which reads the files of the program from the disk."""
    for words, more, limit in (("scene and map", (), MAX_START), ("and rays", ("all",), None)):
        found = []
        for _ in range(NUM_STARTS):
            watch, before = Stopwatch(), children_seconds()
            subprocess.run([sys.executable, "-c", START, str(path), *more], check=True, stdout=subprocess.DEVNULL)
            found.append((children_seconds() - before, watch.wall()))
        seconds, wall = min(found)
        verdict(f"{words}, from the command line {seconds:6.2f} s (waited {wall:.2f} s)", seconds, limit)


def bench_memory(path: Path) -> None:
    """Resident memory after each opening of the same file in one window: Linux alone tells."""
    done = subprocess.run([sys.executable, "-c", OPENINGS, str(path)], check=True, capture_output=True, text=True)
    first, *others = (int(line) / 2**20 for line in done.stdout.split())
    words = "holds" if max(others) < MAX_GROWTH * first else "MISSES"
    print(f"memory {first:.0f} MiB, opened again {', '.join(f'{one:.0f}' for one in others)} MiB   {words} {MAX_GROWTH} times")


def children_seconds() -> float:
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


class Stopwatch:
    """Time passed and processor time of all threads, in s."""

    def __init__(self):
        self._wall, self._processor = time.perf_counter(), time.process_time()

    def wall(self) -> float:
        return time.perf_counter() - self._wall

    def processor(self) -> float:
        return time.process_time() - self._processor


def bench_changes(path: Path) -> None:
    application = QtWidgets.QApplication([])
    window = MainWindow()
    window.show_input(from_file(path))
    window.show()
    application.processEvents()
    watch = Stopwatch()
    window.session.attribution = Attribution(window.session.signals)
    seconds = watch.processor()
    verdict(f"signals of {len(window.session.attribution.groups)} families, once {seconds:.2f} s", seconds, None)
    for max_rays in (2000, 20_000):
        window.session.set_max_rays(max_rays)
        settle(window)
        print(f"at most {max_rays:,} rays drawn")
        for name, change in changes(window.session).items():
            bench_change(window, name, change)
        bench_drawing(window)
    bench_live(window)
    window.close()


def bench_live(window) -> None:
    """An object, the antenna and a material change: processor time of a preview with as many rays as a watch comes down to, of
    its picture, and of the full view with its own."""
    live = live_of(window.session, LIVE_RAYS)
    settings = window.session.signals.spectrum_settings
    window._take_live(session_of_view(live, live.update(), None, settings), live.update())
    names = dict.fromkeys(object_of(mesh.name) for mesh in live.scene.meshes if not mesh.material.mirror)
    print(f"live scene, {LIVE_RAYS:,} rays, previews of {FEWEST_PREVIEW_RAYS}")
    for what, change in {**{name: mover(live, name) for name in names}, "antenna": antenna_mover(live)}.items():
        for kind, view_of, limit in (("preview", lambda: live.preview(num_rays=FEWEST_PREVIEW_RAYS), MAX_PREVIEW),
                                     ("full view", live.update, MAX_SETTLED)):
            seconds = [live_seconds(window, live, change, view_of, settings) for _ in range(NUM_MOVES)]
            of_view, of_window = np.median(seconds[1:], axis=0)
            text = f"  {what + ' moved, ' + kind:28} {1e3 * of_view:7.1f} ms, scene, rays and map {1e3 * of_window:7.1f} ms"
            verdict(text, (of_view + of_window) / NUM_CORES, limit)


def live_seconds(window, live, change, view_of, settings) -> tuple:
    change()
    watch = Stopwatch()
    view = view_of()
    of_view = watch.processor()
    window._take_live(session_of_view(live, view, state_of(window.session), settings), view)
    picture(window)
    seconds = of_view, watch.processor() - of_view
    settle(window)
    return seconds


def mover(live, name: str):
    return lambda: setattr(live.scene[name], "position", live.scene[name].position + (0.02, 0.0, 0.0))


def antenna_mover(live):
    def move():
        live.radar = live.radar.replace(position=tuple(np.add(live.radar.position, (0.0, 0.01, 0.0))))
    return move


def changes(session) -> dict:
    """{name: callable (n)}: a change that is another one for each n."""
    modes = ("mesh", "power", "range", "speed", "bounces")
    cells = [session.cell_of(int(path)) for path in session.shown_rays(50)[::7]]
    return {
        "filter by bounces": lambda n: session.set_filters(Filters(max_bounces=3 + n % 2)),
        "filter by power": lambda n: session.set_filters(Filters(min_power_dbm=-250.0 - n)),
        "filter by path expression": lambda n: session.set_filters(Filters(expression=f"T .{{1,{3 + n}}} R")),
        "part": lambda n: session.set_part([("route", "side wall"), ("route", "floor")][n % 2]),
        "whole": lambda n: session.set_part(("whole", "whole")),
        "colour": lambda n: session.set_color_by(modes[n % len(modes)]),
        "step in time": lambda n: session.set_chirp(100 + n),
        "cell": lambda n: session.select_cells(CellBox.around(*cells[n % len(cells)], 1)),
        "what makes the cell": lambda n: (session.select_cells(CellBox.around(*cells[n % len(cells)], 1), cells[n % len(cells)]),
                                          session.cell_attribution()),
        "filter, cell selected": lambda n: session.set_filters(Filters(max_bounces=3 + n % 2)),
        "no cell": lambda n: session.select_cells(None),
    }


def bench_change(window, name: str, change) -> None:
    computing, drawn = [], []
    for number in range(NUM_REPETITIONS):
        watch = Stopwatch()
        change(number)
        window._refresh_lists()
        computing.append(watch.processor())
        picture(window)
        drawn.append((watch.processor(), watch.wall()))
        settle(window)
    seconds, wall = min(drawn)
    text = f"  {name:28} computing {1e3 * min(computing):7.1f} ms, to picture {1e3 * seconds:7.1f} ms"
    text += f" (waited {1e3 * wall:.1f} ms)"
    verdict(text, seconds, next((limit for start, limit in MAX_TO_PICTURE.items() if name.startswith(start)), None))


def bench_drawing(window) -> None:
    window.session.select_cells(None)
    picture(window)
    settle(window)
    watch = Stopwatch()
    window.view3d.render_soon()
    picture(window)
    text = f"  {'drawing once':28} {1e3 * watch.processor():7.1f} ms (waited {1e3 * watch.wall():.1f} ms)"
    verdict(text, watch.processor(), None)
    bench_orbit(window)


def bench_orbit(window) -> None:
    """The camera turns, as by the mouse: pictures a second of processor time, once their number of rays has settled."""
    view, pace, seconds = window.view3d, window.view3d._turning, []
    view.clock = time.process_time  # as fast as on a machine that does nothing else
    view.set_moving(pace)
    for _ in range(NUM_TURNS):
        watch = Stopwatch()
        view.camera.azimuth += 1.0
        view.render_soon()
        picture(window)
        seconds.append((watch.processor(), watch.wall()))
    view.set_moving(None)
    view.clock = time.perf_counter
    picture(window)
    taken, waited = np.median(seconds[NUM_TURNS // 2:], axis=0)
    num_rays = min(pace.num_rays, window.session.max_rays)
    text = f"  {'orbit':28} {1.0 / taken:7.1f} pictures/s ({1.0 / waited:.1f} by the clock), {num_rays:,} rays, pixels"
    text += f" {pace.coarseness} wide"
    verdict(text, taken, 1.0 / ORBIT_RATE)


def picture(window) -> None:
    """Returns when the scene is drawn, maps and lists with it."""
    window._listing.stop()
    while window.view3d.is_behind():
        QtWidgets.QApplication.processEvents()


def settle(window) -> None:
    """Forgets what waits for the next turn of the event loop: it has been done."""
    window._listing.stop()
    window._pause.stop()


def verdict(text: str, seconds: float, limit: float | None) -> None:
    held = "" if limit is None else f"   {'holds' if seconds < limit else 'MISSES'} {limit:g} s"
    print(text + held, flush=True)


if __name__ == "__main__":
    main()
