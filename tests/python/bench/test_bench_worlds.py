"""`echopath bench worlds`, its public cities beside a peer and files of others."""
import json
import sys

import numpy as np
import pytest

from echopath.bench.worlds import city, crowd, models, peer, public_cities, run_worlds
from support.files.gltf_files import rig_file

LIGHT = 299792458.0
FLOOR = """<scene version="2.1.0"><bsdf type="itu-radio-material" id="metal"><string name="type" value="metal"/></bsdf>
<shape type="rectangle" id="floor"><transform name="to_world"><scale value="60"/></transform><ref id="metal" name="bsdf"/></shape>
</scene>"""
TRANSMITTER, RECEIVER = (0.0, 0.0, 10.0), (20.0, 0.0, 5.0)
CONDUCTIVITY = 1e7  # S/m
IMAGE_LENGTH = np.hypot(20.0, 15.0)
PEER = """#!{python}
import json, sys
if sys.argv[1] == "-c":
    print({folder!r})
else:
    request = json.load(open(sys.argv[2]))
    assert request["rays"] and [one["name"] for one in request["cities"]] == ["floor"]
    json.dump({answer!r}, open(sys.argv[3], "w"))
"""


def row_of(rows, what):
    return next(row for row in rows if row.get("what") == what)


def test_a_look_at_a_city_is_not_held_to_the_limit_of_all_rays(tmp_path, monkeypatch):
    found = {"seconds": 1.0, "memory": 0, "by_images": 0, "paths": 0}
    monkeypatch.setattr(public_cities, "alone", lambda work, file, materials, settings: found)
    assert row_of(public_cities._alone(tmp_path, 20_000), "Munich, 20,000 rays, s")["limit"] is None
    assert row_of(public_cities._alone(tmp_path, public_cities.RAYS), "Munich, 1,000,000 rays, s")["limit"] == 3.0


@pytest.fixture
def floor(tmp_path, monkeypatch):
    """A folder of scenes with a floor of metal, the only public city."""
    scenes = tmp_path / "scenes"
    scenes.mkdir()
    (scenes / "floor.xml").write_text(FLOOR)
    here = public_cities.City("floor", "floor.xml", TRANSMITTER, (RECEIVER,))
    monkeypatch.setattr(public_cities, "CITIES", (here,))
    return scenes


def says(folder, delay, power):
    """An interpreter of a peer that finds one path."""
    path = [float(delay), float(power), 1]
    found = {"materials": {"metal": [1.0, CONDUCTIVITY]}, "paths": [[path]], "seconds": [1.0, 2.0, 3.0]}
    answer = {"version": "0", "cities": {"floor": found}}
    python = folder / "python"
    python.write_text(PEER.format(python=sys.executable, folder=str(folder), answer=answer))
    python.chmod(0o755)
    return str(python)


def closed_form():
    """(delay in s, power) of the image in a floor of metal, whose surface resistance takes a little of the vertical field."""
    resistance = np.sqrt(np.pi * public_cities.FREQUENCY * 4e-7 * np.pi / CONDUCTIVITY) / (4e-7 * np.pi * LIGHT)
    reflected = 1.0 - 2.0 * resistance / (15.0 / IMAGE_LENGTH)
    return IMAGE_LENGTH / LIGHT, (reflected * LIGHT / public_cities.FREQUENCY / (4.0 * np.pi * IMAGE_LENGTH)) ** 2


@pytest.mark.parametrize("late, missing", [(0.0, 0), (3e-12, 1)])
def test_paths_of_a_peer_are_compared_one_by_one(tmp_path, floor, late, missing):
    """The peer says the closed form, or a delay beside it."""
    delay, power = closed_form()
    rows = public_cities._beside_peer(floor, says(tmp_path, delay + late, power), 2000)
    assert row_of(rows, "floor, paths of Sionna RT")["measured"] == 1
    lost = row_of(rows, "floor, paths of Sionna RT missing")
    assert lost["measured"] == missing and lost["holds"] == (missing == 0)
    assert row_of(rows, "floor, delays differ by, ps")["measured"] < 1e-3
    assert row_of(rows, "floor, powers differ by, dB")["measured"] < 1e-5
    assert row_of(rows, "floor, paths of its power")["measured"] == 1 - missing
    marked = row_of(rows, "floor, all planes marked, paths of Sionna RT missing")
    assert marked["measured"] == missing and marked["holds"] == (missing == 0)
    assert row_of(rows, "floor, all planes marked, powers differ by, dB")["holds"]
    assert row_of(rows, "floor, time over Sionna RT's")["measured"] > 0.0
    assert row_of(rows, "floor, time of Sionna RT, its median, s")["measured"] == 2.0


def test_a_wrong_power_of_a_path_shows():
    delay, power = closed_form()
    found = public_cities.compare([[delay, power], [2.0 * delay, power]], [[delay, 10.0 ** 0.01 * power]])
    assert found["powers differ by, dB"] == pytest.approx(0.1) and found["paths of Sionna RT missing"] == 0
    assert found["paths of its power"] == 0
    assert public_cities.compare(np.empty((0, 2)), [[delay, power]])["paths of Sionna RT missing"] == 1


def test_what_is_not_installed_is_not_measured():
    assert peer.scenes_of(sys.executable) is None
    assert public_cities.describe(public_cities.rows(quick=True)) == [
        "public cities: not measured: sionna-rt is not installed, and no folder of its scenes is given"]
    assert models.describe(models.rows(quick=True)) == ["models: not measured: no folder of models is given"]


def test_what_holds_nothing_does_not_pass(tmp_path, floor):
    (tmp_path / "notes.txt").write_text("no model")
    (row,) = models.rows(quick=True, folder=tmp_path / "scenes" / "none")
    assert "holds no file of a kind that is read" in row["not_measured"]
    answer = {"materials": {"metal": [1.0, CONDUCTIVITY]}, "paths": [[]], "seconds": [1.0]}
    (row,) = public_cities._city_beside_peer(floor, public_cities.CITIES[0], 2000, answer)
    assert row == {"what": "floor, beside Sionna RT", "not_measured": "it finds no path"}
    (tmp_path / "flat.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    rows = models.rows(quick=True, folder=tmp_path)
    assert row_of(rows, "files refused")["holds"]
    assert all("not_measured" in row_of(rows, what) for what in list(models.LIMITS)[1:])


@pytest.mark.parametrize("option, value", [("cities", "/no/such/folder"), ("models", "/no/such/folder"),
                                           ("sionna", "/no/such/python"), ("sionna", __file__)])
def test_options_are_checked_before_anything_is_measured(tmp_path, option, value):
    with pytest.raises(ValueError, match=f"^--{option}: must be a .*, got {value}"):
        run_worlds(tmp_path / "out", quick=True, **{option: value})
    assert not (tmp_path / "out").exists()


def test_a_named_python_without_the_peer_is_told_by_its_name(tmp_path):
    (row,) = public_cities.rows(quick=True, python=sys.executable)
    assert row["not_measured"].startswith(f"{sys.executable} has no sionna-rt, and no folder")
    greets = tmp_path / "python"
    (tmp_path / "scenes").mkdir()
    greets.write_text(f"#!/bin/sh\necho a greeting\necho {tmp_path}\n")
    greets.chmod(0o755)
    assert peer.scenes_of(str(greets)) == tmp_path / "scenes"


def test_modules_beside_the_script_are_not_those_of_the_peer(tmp_path, monkeypatch):
    """Nor those of the working folder."""
    (tmp_path / "models.py").write_text("raise SystemExit(3)")
    script = tmp_path / "script.py"
    script.write_text("import sys\ntry:\n    import models\nexcept ImportError:\n    open(sys.argv[2], 'w').write('[1]')\n")
    monkeypatch.setattr(peer, "SCRIPT", script)
    monkeypatch.chdir(tmp_path)
    assert peer.asked(None, {}) == [1]


def test_a_peer_that_fails_is_quoted():
    with pytest.raises(RuntimeError, match="No module named"):
        peer.asked(sys.executable, {"cities": []})


def nodding():
    """The tube of two bones, whose upper one bends toward who looks at it."""
    file = rig_file()
    file.json["animations"] = []
    file.animation((2, "rotation", (0.0, 1.0, 2.0), [[0, 0, 0, 1], [np.sqrt(0.5), 0, 0, np.sqrt(0.5)], [0, 0, 0, 1]], "LINEAR"))
    return file


def test_models_of_a_folder_load_or_say_why_not(tmp_path):
    (tmp_path / "rig.gltf").write_text(nodding().gltf())
    (tmp_path / "broken.glb").write_bytes(b"glTF")
    (tmp_path / "city" / "meshes").mkdir(parents=True)
    (tmp_path / "city" / "city.xml").write_text(FLOOR)
    (tmp_path / "city" / "meshes" / "part.obj").write_text("v 0 0 0\n")
    (tmp_path / "city" / "cars").mkdir()
    (tmp_path / "city" / "cars" / "car.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    rows = models.rows(quick=True, folder=tmp_path)
    by_file = {row["file"]: row for row in rows if "file" in row}
    assert set(by_file) == {"rig.gltf", "broken.glb", "city/city.xml", "city/cars/car.obj"}
    assert "broken.glb" in by_file["broken.glb"]["refused"]
    assert row_of(rows, "files refused")["measured"] == 1 and not row_of(rows, "files refused")["holds"]
    rig = by_file["rig.gltf"]
    assert rig["parts that move"] > 0 and rig["speeds of echoes differ by, m/s"] < 0.01
    assert row_of(rows, "sum of parts over whole - 1")["holds"]
    assert len(models.describe(rows)) == 1 + len(by_file) + 1 + len(models.LIMITS)
    json.dumps(rows)


def test_verdicts_stand_on_the_rows_of_cities():
    row = {"name": "unmarked walls", "walls": 1, "rays": 1, "seconds": 1.0, "bare_share": 0.5, "paths": 3, "missing": 0,
           "beside": 0, "delay_error_s": 0.0, "level_error_db": 0.0}
    many = {"name": "meshes", "meshes": 1, "rays": 1, "seconds": 0.4, "seconds_of_a_tenth": 0.1, "timed": True}
    said = [line.split("  ")[-1] for line in city.describe([row, row | {"missing": 1}, row | {"level_error_db": 0.4}, many,
                                                            many | {"paces": [2.0, 2.0]}])]
    assert said[:4] == ["holds", "MISSED", "MISSED", "MISSED"] and said[4].startswith("holds")
    assert "labels beyond synthesis, over it" in crowd.LIMITS
