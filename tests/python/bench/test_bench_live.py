"""`echopath bench live`: its street, its rows, what it prints."""
import functools
import subprocess
import sys

import numpy as np
import pytest

import echopath as ep
from echopath.base.text.mesh_names import object_of
from echopath.bench import live
from echopath.bench.live import drive, edits, street

STREET_TRIANGLES = 40_000
CLEARANCE = 0.1   # m between things that do not touch
SECONDS = 5.1


@functools.cache
def drive_scene() -> ep.Scene:
    return street.city_street(SECONDS)


def bounds_of(scene, name: str, time: float):
    """Lowest and highest corner [3] in m of an object."""
    ids = [mesh.id for mesh in scene.meshes if object_of(mesh.name) == name]
    vertices = np.concatenate([np.asarray(scene.world_vertices(index, time)) for index in ids])
    return vertices.min(axis=0), vertices.max(axis=0)


def test_the_street_has_the_triangles_cars_and_people_that_it_is_named_for():
    scene = drive_scene()
    roots = {object_of(mesh.name) for mesh in scene.meshes}
    assert sum(name.startswith("car_") for name in roots) == 20 and sum(name.startswith("person_") for name in roots) == 20
    at_rest = sum(len(mesh.triangles) for mesh in scene.meshes if not mesh.name.startswith(("car_", "person_")))
    assert abs(at_rest - STREET_TRIANGLES) < 0.01 * STREET_TRIANGLES
    scene.require_times(0.0, SECONDS)


def test_nobody_drives_or_walks_into_a_house_and_the_radar_meets_nobody():
    scene = drive_scene()
    names = sorted({object_of(mesh.name) for mesh in scene.meshes if mesh.name.startswith(("car_", "person_"))})
    for time in np.linspace(0.0, SECONDS, 4):
        radar_x = street.RADAR_SPEED * time
        for name in names:
            low, high = bounds_of(scene, name, time)
            assert max(-low[1], high[1]) < street.HOUSE_FRONT - CLEARANCE, name
            ahead = low[0] > radar_x + CLEARANCE or high[0] < radar_x - CLEARANCE
            aside = low[1] > street.OWN_LANE + CLEARANCE or high[1] < street.OWN_LANE - CLEARANCE
            assert ahead or aside, (name, time)


def test_a_house_has_its_walls_its_roof_and_the_reveals_of_its_windows():
    vertices, triangles = street.house()
    a, b, c = np.moveaxis(vertices[triangles], 1, 0)
    area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()
    long, high, deep = street.HOUSE_LENGTH, street.HOUSE_HEIGHT, 10.0
    wide, tall = (size / (2 * count + 1) for size, count in zip((long, high), street.WINDOWS))
    reveals = street.WINDOWS[0] * street.WINDOWS[1] * 2.0 * street.WINDOW_DEPTH * (wide + tall)
    assert abs(area - (2.0 * long * high + 2.0 * deep * high + long * deep + reveals)) < 1e-9 * area


def test_rows_say_what_holds():
    found = {"triangles": 5, "all stages, s a frame": 2.5, "person, s": 1.0}
    rows = [{"what": what, "measured": value, "limit": drive.LIMITS.get(what),
             "holds": None if what not in drive.LIMITS else value <= drive.LIMITS[what]} for what, value in found.items()]
    lines = live.describe({"machine": {"processor": "any", "threads": 2}, "rows": {"edits": [], "drive": rows}})
    assert lines[0] == "any, 2 threads"
    assert [line.split()[-1] for line in lines[-3:]] == ["5", "MISSED", "holds"]


def test_a_moved_object_is_measured_beside_a_fresh_scene():
    rows = {row["what"]: row for row in edits.moved_rows("sign", *edits.crowded_street(), 500, 1e9, 1)}
    assert rows["sign, 500 rays: error"]["holds"] and rows["sign, 500 rays: moved, s"]["holds"]
    assert 0.0 < rows["sign, 500 rays: share of rays shot"]["measured"] < 0.5
    assert [line.split()[-1] for line in edits.describe(list(rows.values())) if "error" in line] == ["holds"]


def test_a_dragged_object_is_timed_by_what_a_watch_shows():
    rows = {row["what"]: row for row in edits.first_map_rows("sign", *edits.crowded_street(), 500, 2)}
    assert rows["sign, 500 rays, dragged: first map, s"]["measured"] > 0.0
    assert 0 < rows["sign, 500 rays, dragged: rays of it"]["measured"] <= 1.19 * 500  # shares of rays are rounded


class Broken(Exception):
    pass


def test_what_ends_the_watch_of_what_is_dragged_ends_the_measurement(monkeypatch):
    update = ep.Live.update

    def breaks_with_a_change(live, *, progress, num_rays=None):
        if live.number > 0:
            raise Broken
        return update(live, progress=progress)

    monkeypatch.setattr(ep.Live, "preview", breaks_with_a_change)
    monkeypatch.setattr(ep.Live, "update", breaks_with_a_change)
    with pytest.raises(Broken):
        edits.first_map_rows("sign", *edits.crowded_street(), 500, 2)


def test_stages_go_by_the_names_of_the_table():
    frame = ep.simulate(street.city_street(0.2, num_cars=1, num_people=0, length=20.0), street.radar(), num_rays=500,
                        labels=True, guard=False)
    by_name = drive._by_name(frame.stages)
    assert list(by_name) == ["trace", "signal", "maps", "labels"]
    assert sum(by_name.values()) == np.float64(sum(stage.processor_seconds for stage in frame.stages))


# A process of its own: in that of the tests, threads that end meanwhile give memory back.
TELLS_WHAT_AN_ARRAY_ADDS = """
import numpy as np
from echopath.bench.live import drive
before = drive.resident_memory()
held = np.ones(1 << 24)
print((drive.resident_memory() - before) / held.nbytes)
"""


def test_memory_is_told_in_bytes():
    added = subprocess.run([sys.executable, "-c", TELLS_WHAT_AN_ARRAY_ADDS], capture_output=True, text=True, check=True)
    assert abs(float(added.stdout) - 1.0) < 0.05
