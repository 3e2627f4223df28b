"""Templates of datasets with mistakes, and what the files beside frames in time say of them."""
from __future__ import annotations

import copy
import json
import tomllib
from pathlib import Path
from random import Random

import h5py
import numpy as np

import echopath as ep
from echopath import dataset
from echopath.dataset import template as template_module
from echopath.sequence.contents import Contents, write_contents
from fuzz.folder import memory_folder
from fuzz.seeds import frames
from fuzz.tables import Tables
from support.files.small_dataset import HEAD, SCENE

HUGE = 10**400
DISTRIBUTIONS = [{"uniform": [0.0, 1.0]}, {"uniform": [1, 0]}, {"uniform": [-1e308, 1e308]}, {"uniform": [0, HUGE]},
                 {"uniform": 3}, {"log_uniform": [5e-324, 1e308]}, {"normal": [0.0, 1e308]}, {"normal": [0, 0], "within": [1, 2]},
                 {"normal": [0, 1], "within": 3}, {"integer": [0, 10**30]}, {"integer": [-2**63, 2**63 - 1]},
                 {"integer": [0.5, 3]}, {"choice": []}, {"choice": [1, "a", [], {}]}, {"choice": [{"uniform": [0, 1]}]},
                 {"choice": [1, 2], "weights": [1e308, 1e308]}, {"choice": [1, 2], "weights": [HUGE, 1]},
                 {"uniform": [0, 1], "normal": [0, 1]}, {"same_as": "objects.plate_1.speed", "times": 1e300, "plus": HUGE},
                 {"same_as": "objects.plate_2.parameters", "plus": 1}, {"same_as": "objects.wall"}, {"same_as": "radar"},
                 {"same_as": "trace.num_rays", "plus": 0.5}, {"same_as": "objects.wall.position[1]"}, {"same_as": "a[9].b"},
                 [{"same_as": "radar.waveform"}, {"same_as": "objects.wall.position"}, {"same_as": "labels"}]]
COUNTS = [0, 2, -1, 0.5, 1e300, 10**9, float("nan"), float("inf"), True, "x", [], {}, HUGE]
OWN_KEYS = ("count", "chance", "apart", "position", "weights", "within", "name")
SETTINGS = ["1", "0", "-1", "NaN", "Infinity", "9" * 30, "9" * 5000, "null", "[]", "{}", '"x"', '"all"', "[" * 50_000, "{",
            "1e308", '{"rain_mm_per_hour": 1}', '{"x": 1}', "2.5", "1000000000"]


def feed_template():
    """Cases of templates, past the syntax of TOML: scenes that are drawn, or errors that name the file."""
    folder = memory_folder()
    path = Path(folder.name) / "plates.toml"
    path.write_text(HEAD + SCENE)
    seed = tomllib.loads(HEAD + SCENE)
    alone = {"dataset": {"scenes": 2}, "radar": seed["radar"]}
    tables, parse = Tables([seed, seed, alone]), template_module.parse

    def case(number: int) -> None:
        random = Random(f"template {number}")
        table = tables.mistaken(random)
        for _ in range(random.choice((0, 1, 1, 2))):
            _put_odd(table, random)
        template_module.parse = lambda _: table
        try:
            template = dataset.Template(path)
            for scene in {0, template.settings.scenes - 1}:
                template.check(scene)
        except (ValueError, ep.FileError) as error:
            assert str(error).startswith(f"{path}: "), f"names no file: {error}"
        finally:
            template_module.parse = parse

    case.folder = folder
    return case


def _put_odd(table: dict, random: Random) -> None:
    """Puts a distribution or an odd count somewhere into an object of a template, or into one of its tables."""
    holders = [one for one in (table, *table.values()) if isinstance(one, dict)]
    holders += [one for one in table["objects"] if isinstance(one, dict)] if isinstance(table.get("objects"), list) else []
    holder = random.choice(holders)
    key = random.choice((*OWN_KEYS, *holder)) if holder is not table else random.choice(list(table) or ["noise"])
    holder[key] = copy.deepcopy(random.choice(DISTRIBUTIONS + COUNTS))


def feed_sequence():
    """Cases of sequence.h5 whose settings somebody changed: a sequence that tells what it has, or ep.FileError."""
    folder = memory_folder()
    base = Path(folder.name)
    frame, path = frames()[6], base / "sequence.h5"
    settings = {"frames": 2, "first_number": 0, "number_step": 1, "start_time": 0.0, "interval": 0.1, "keep": "maps",
                "weather": {}}
    contents = []
    for given in ({"times": None}, {"times": [0.0, 0.1], "interval": None}):
        with h5py.File(path, "w") as file:
            write_contents(file, Contents(frame.scene, frame.radar, settings | given))
        contents.append(path.read_bytes())
        ep.load_sequence(base)

    def case(number: int) -> None:
        random = Random(f"sequence {number}")
        path.write_bytes(random.choice(contents))
        with h5py.File(path, "r+") as file:
            for _ in range(random.choice((1, 1, 2))):
                name = random.choice(list(settings))
                file["settings"].attrs[name] = np.bytes_(random.choice((*SETTINGS, json.dumps(settings[name]))))
        try:
            stored = ep.load_sequence(base)
        except ep.FileError as error:
            assert str(error).startswith(f"{path}: "), f"names no file: {error}"
            return
        assert "0 done" in repr(stored) and np.isfinite(stored.times).all()
        assert stored.interval is None or np.isfinite(stored.interval)
        stored.scene  # noqa: B018 (it is made)

    case.folder = folder
    return case
