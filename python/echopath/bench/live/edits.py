"""A scene that is changed while its map is watched: what a moved object costs, how near the view is to a fresh one, memory.

An update is one object moved by 10 cm and the new range-Doppler map. Beside it stands a fresh Live of the same scene in the
same run, and where nearly all rays meet what is moved the first map that a watch shows. Times are by the clock, medians: what
a hand on a mouse feels.
"""
from __future__ import annotations

import queue
import statistics
import time
from importlib.resources import as_file

import numpy as np

import echopath as ep

from ...base.storage.data_folder import data_folder
from ...sequence.unused_memory import resident_memory
from ..alone import alone
from ..crowd.scenes import BACKDROPS, flat_city, radar, rounded_car, street
from ..suite import describe_judged, judged_row
from ..timing import wall_time
from .drive import MIB
from .random_edits import RandomEdits

RAYS, QUICK_RAYS, FEW_RAYS = 100_000, 2_000, 20_000
UPDATES, QUICK_UPDATES = 15, 2
EDITS, QUICK_EDITS = 1000, 5
SOAK_UPDATES, QUICK_SOAK = 2000, 5
SOAK_FROM = 0.1                    # of the updates, after which memory is to be flat
STEP = (0.1, 0.0, 0.0)             # m
LIMITS = {"pedestrian of the demo street": 0.05, "sign of a street of 20 objects": 0.05, "car in a city of 2400 meshes": 0.1}
MOST_SECONDS_OF_FEW = 0.05         # 20 updates a second
WATCHED = "pedestrian of the demo street"
MOST_SECONDS_OF_FIRST = 0.05       # that a watch takes to show the first map after a change
FIRST_VIEWS = 5                    # of a watch, after which it has found how many rays its previews may have
MOST_ERROR, MOST_GROWTH = 1e-12, 1.1


def rows(*, quick: bool = False) -> list[dict]:
    """A row for each figure: what, measured, limit and whether it holds. quick: few rays and updates, for a look"""
    return alone(_rows, quick)


def describe(rows: list[dict]) -> list[str]:
    """What, the figure, its limit, and whether it holds."""
    return describe_judged(rows, "edits", width=72, measured="10.3g", limit="9.3g")


def demo_street() -> tuple[ep.Scene, ep.Radar, str]:
    """(scene, radar, name of what is moved): the pedestrian, at whom or at whose images nearly all rays go."""
    with as_file(data_folder("scenes") / "street.toml") as path:
        file = ep.load_scene(path)
    return file.scene, _with_128_chirps(file.radar), "pedestrian"


def crowded_street() -> tuple[ep.Scene, ep.Radar, str]:
    """A street of twenty objects between flagged mirrors."""
    return street(mirrors=True), _with_128_chirps(radar()), "sign_30"


def city() -> tuple[ep.Scene, ep.Radar, str]:
    """A car before a person among 2400 buildings."""
    scene, of_scene = flat_city()
    scene.add(rounded_car(), name="car", position=(20.0, 3.0, 0.0), material=ep.Material.metal(), smooth=True)
    return scene, _with_128_chirps(of_scene), "car"


SCENES = dict(zip(LIMITS, (demo_street, crowded_street, city)))


def moved_rows(name: str, scene: ep.Scene, of_scene: ep.Radar, moved: str, num_rays: int, limit: float, updates: int
               ) -> list[dict]:
    """Rows of one object that is moved by STEP so many times. name: of the rows; limit: s, of an update"""
    what = f"{name}, {num_rays} rays"
    live = ep.Live(scene, of_scene, num_rays=num_rays)
    live.update()
    views = []
    for _ in range(updates + 1):
        live.scene[moved].position += STEP
        views.append(wall_time(live.update))
    views = views[1:]  # the first one brings memory
    seconds = statistics.median(took for took, _ in views)
    fresh_seconds, fresh = wall_time(ep.Live(live.scene, of_scene, num_rays=num_rays).update)
    stages = {stage: statistics.median(view.stages[stage] for _, view in views) for stage in views[0][1].stages}
    error = float(np.abs(views[-1][1].cube - fresh.cube).max() / np.abs(fresh.cube).max())
    return [judged_row(f"{what}: moved, s", seconds, limit),
            judged_row(f"{what}: moved over fresh", seconds / fresh_seconds, None),
            *(judged_row(f"{what}: of it {stage}, s", value, None) for stage, value in stages.items()),
            judged_row(f"{what}: share of rays shot", views[-1][1].num_rays_shot / views[-1][1].num_rays, None),
            judged_row(f"{what}: error", error, MOST_ERROR)]


def first_map_rows(name: str, scene: ep.Scene, of_scene: ep.Radar, moved: str, num_rays: int, updates: int) -> list[dict]:
    """Rows of one object that is dragged by STEP so many times, each time as soon as a watch has shown the last one."""
    live, shown = ep.Live(scene, of_scene, num_rays=num_rays), queue.Queue()

    def drag():
        live.change(lambda of: setattr(of[moved], "position", of[moved].position + STEP))
        begin = time.perf_counter()
        while (view := _taken(shown)).number != live.number:
            pass
        return time.perf_counter() - begin, view.num_rays

    with live.watch(shown.put, failed=shown.put) as watch:
        watch.wait()
        found = [drag() for _ in range(FIRST_VIEWS + updates)][FIRST_VIEWS:]
    what = f"{name}, {num_rays} rays, dragged"
    return [judged_row(f"{what}: first map, s", statistics.median(took for took, _ in found), MOST_SECONDS_OF_FIRST),
            judged_row(f"{what}: rays of it", statistics.median(rays for _, rays in found), None)]


def _taken(shown: queue.Queue) -> ep.LiveView:
    """The next view that a watch shows. Raises what has ended the watch: there is no other then."""
    found = shown.get()
    if isinstance(found, Exception):
        raise found
    return found


def _with_128_chirps(of: ep.Radar) -> ep.Radar:
    return of.replace(waveform=of.waveform.replace(num_chirps=128))


def _rows(quick: bool) -> list[dict]:
    found = []
    many, few = (RAYS, LIMITS), (FEW_RAYS, dict.fromkeys(LIMITS, MOST_SECONDS_OF_FEW))
    for num_rays, limits in ((QUICK_RAYS, LIMITS),) if quick else (many, few):
        for name, made in SCENES.items():
            found += moved_rows(name, *made(), num_rays, limits[name], QUICK_UPDATES if quick else UPDATES)
    found += first_map_rows(WATCHED, *SCENES[WATCHED](), QUICK_RAYS if quick else RAYS, QUICK_UPDATES if quick else UPDATES)
    edits, soak = (QUICK_EDITS, QUICK_SOAK) if quick else (EDITS, SOAK_UPDATES)
    found.append(judged_row(f"{edits} random edits of the street of 20 objects: error", _error_of_edits(edits), MOST_ERROR))
    found.append(judged_row(f"{soak} updates: memory over that after {int(SOAK_FROM * soak)}", _growth(soak), MOST_GROWTH))
    return found


def random_edits() -> RandomEdits:
    """Of the street of twenty objects."""
    scene, of_scene, _ = crowded_street()
    names = [name for name in scene if "/" not in name and name not in BACKDROPS]
    return RandomEdits(ep.Live(scene, of_scene, num_rays=QUICK_RAYS), names, list(BACKDROPS))


def _error_of_edits(count: int) -> float:
    """Largest difference of a sample over the largest sample, from a fresh Live after all edits and at twenty places before."""
    edits, worst = random_edits(), 0.0
    for number in range(count):
        edits.make()
        view = edits.live.update()
        if number % max(1, count // 20) == 0 or number == count - 1:
            fresh = edits.fresh_view()
            worst = max(worst, float(np.abs(view.cube - fresh.cube).max() / np.abs(fresh.cube).max()))
    return worst


def _growth(count: int) -> float:
    """Most memory over that after SOAK_FROM of the updates, each after an edit, every other one with previews before it."""
    edits, memory = random_edits(), []
    for number in range(count):
        edits.make()
        if number % 2:
            edits.live.preview(num_rays=QUICK_RAYS // (4 + number % 4))
        edits.live.update()
        memory.append(resident_memory() / MIB)
    return max(memory[int(SOAK_FROM * count):]) / memory[int(SOAK_FROM * count)]
