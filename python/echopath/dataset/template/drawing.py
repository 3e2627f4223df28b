"""Draws the values of one scene of a template, and the objects that it has."""
from __future__ import annotations

import hashlib
import math
import re
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from ... import _core
from ...arguments.shown import shown, writable
from ...base.numerics.placements import ORIGIN, placement
from ...scene_file.errors import validated
from ...scene_file.objects import motion_of
from ...scene_file.tables.object_tables import ObjectTable
from ...scene_file.trajectories import Trajectories
from .distributions import REFERENCE, drawn, is_distribution, is_number, refuse_misspelt
from .references import Source, changed, is_reference, places_of, refuse_wrong_reference

_OWN_KEYS = ("count", "chance", "apart")  # of an entry, which no scene knows
_MOST_COPIES = 10_000                   # of an entry
_MOST_FOLLOWED = 20                     # values of which each follows the next
_MOST_PLACES = 1000                     # that are tried for an object that is to stand apart from others
_OF_NAMES = (".objects", ".materials")  # tables, beside parts, whose keys are names, which may be any


def random_at(seed: int, scene: int, place: str) -> np.random.Generator:
    """The random numbers of a dotted path in a scene."""
    digest = hashlib.sha256(f"{seed}/{scene}/{place}".encode("utf-8", "surrogatepass")).digest()
    return np.random.Generator(np.random.Philox(key=int.from_bytes(digest[:16], "little")))


def possible_names(entries: list[dict[str, Any]]) -> Iterator[str]:
    """Those that objects of some entries may have, with all copies that there may be."""
    for entry in entries:
        name = entry["name"]
        yield from (f"{name}_{number}" for number in range(1, _MOST_COPIES + 1)) if "count" in entry else (name,)


class Drawing:
    """Draws the values of one scene and remembers them; source: what the template says, to which values may refer."""

    def __init__(self, seed: int, scene: int, source: Source):
        self._seed, self._scene = seed, scene
        self._source = source
        self._followed: list[str] = []  # paths of what is being drawn because others follow it
        self._known: dict[str, Any] = {}  # of paths that were followed
        self.values: dict[str, Any] = {}

    def random(self, place: str) -> np.random.Generator:
        """The random numbers of a dotted path."""
        return random_at(self._seed, self._scene, place)

    def of(self, value: Any, place: str, turn: str = "") -> Any:
        """A value of the template with all its distributions drawn; turn: another word draws others."""
        if is_distribution(value):
            self.values[place] = drawn(value, place, self.random(place + turn))
            return self.of(self.values[place], place, turn + "/chosen")  # a choice may be among distributions
        if is_reference(value):
            self.values[place] = changed(self._same_as(value[REFERENCE], place), value, place)
            return self.values[place]
        if isinstance(value, dict):
            if not (place.startswith("parts") or place.endswith(_OF_NAMES)):
                refuse_wrong_reference(value, place)
                refuse_misspelt(value, place)
            return {key: self.of(one, f"{place}.{key}" if place else str(key), turn) for key, one in value.items()}
        if isinstance(value, list):
            return [self.of(one, f"{place}[{index}]", turn) for index, one in enumerate(value)]
        return value

    def _same_as(self, path: str, place: str) -> Any:
        """What the scene has at a path, for a value at a place: a value is a function of its own path, whoever draws it."""
        rule = f"{place}.{REFERENCE}: must be the dotted path of a key of the template"
        if path in self._known:
            return self._known[path]
        if path in self._followed or len(self._followed) > _MOST_FOLLOWED:
            raise ValueError(f"{rule} that does not follow this one, got {shown(path)}")
        self._followed.append(path)
        try:
            self._known[path] = self._at(path)
            return self._known[path]
        except (KeyError, IndexError):
            raise ValueError(f"{rule}, got {shown(path)}") from None
        finally:
            self._followed.pop()

    def _at(self, path: str) -> Any:
        """Raises KeyError or IndexError where the template has no such value."""
        value, at, steps = self._source.walk(path)
        if "apart" in value and steps[0].key == "position":
            raise KeyError(path)  # which is drawn again until it is free
        is_drawn = False
        for key, beyond in steps:
            if not is_drawn and (is_distribution(value) or is_reference(value)):
                value, is_drawn = self.of(value, at), True
            if not isinstance(value, dict if isinstance(key, str) else list):
                raise KeyError(path)
            value, at = value[key], beyond
        return value if is_drawn else self.of(value, at)


class DrawnObjects:
    """Draws the objects of a scene: how many of each there are, and where.

    trajectories: makes those of their tables
    """

    def __init__(self, drawing: Drawing, trajectories: Trajectories):
        self._drawing, self._trajectories = drawing, trajectories
        self._left_out: list[tuple[re.Pattern[str], int]] = []  # of full names, the number of a copy that follows, and the last
        self._frames: dict[str, np.ndarray] = {}  # world_from_object [4, 4] by full name, at time 0
        self._places: list[tuple[np.ndarray, float]] = []  # (x, y) in the world and radius in m of what stands apart
        self._stand_apart = False  # whether some objects are to

    def of(self, entries: Any) -> list[Any]:
        if not isinstance(entries, list):
            return [entries]  # which the schema of the scene refuses
        self._stand_apart = any(isinstance(entry, dict) and "apart" in entry for entry in entries)
        objects: list[Any] = []
        for index, (entry, place) in enumerate(zip(entries, places_of(entries))):
            objects += self._copies(dict(entry), place) if place else [self._drawing.of(entry, f"objects[{index}]")]
        return objects

    def _copies(self, entry: dict[str, Any], place: str) -> list[dict[str, Any]]:
        """The tables of the objects of an entry; place: its dotted path."""
        name = entry.pop("name")
        _refuse_misspelt_own(entry, place)
        chance = self._number(entry.pop("chance", 1.0), f"{place}.chance", "a number from 0 to 1", lambda x: 0.0 <= x <= 1.0)
        is_row, is_fixed = "count" in entry, is_number(entry.get("count", 1))
        count = self._number(entry.pop("count", 1), f"{place}.count", f"a whole number from 0 to {_MOST_COPIES}",
                             lambda x: 0 <= x <= _MOST_COPIES and x == int(x))
        if self._drawing.random(f"{place}.presence").random() >= chance:
            count = 0
        names = [f"{name}_{number}" for number in range(1, int(count) + 1)] if is_row else [name] * int(count)
        if not is_fixed or not names:
            self._leave_out(name, entry.get("parent"), int(count), is_row)
        made = (self._one(one, dict(entry), place + one.removeprefix(name)) for one in names)
        return [one for one in made if one is not None]

    def _leave_out(self, name: str, parent: Any, last: int, is_row: bool) -> None:
        """Notes that an entry has no copies behind the last; of an entry without copies, that it is not there."""
        if parent is None or isinstance(parent, str):
            number = r"_(\d{1,9})" if is_row else "()"
            self._left_out.append((re.compile(re.escape(_full_name(parent, name)) + number + "(/|$)"), last))

    def _is_left_out(self, carrier: Any) -> bool:
        """Whether an object, or what carries it, is one that chance or count leave out."""
        found = [(pattern.match(carrier), last) for pattern, last in self._left_out if isinstance(carrier, str)]
        return any(name is not None and int(name[1] or 1) > last for name, last in found)

    def _number(self, value: Any, place: str, rule: str, holds: Callable[[float], bool]) -> float:
        number = self._drawing.of(value, place)
        if not is_number(number) or not holds(number):
            raise ValueError(f"{place}: must be {rule}, got {shown(number)}")
        return float(number)

    def _one(self, name: str, entry: dict[str, Any], place: str) -> dict[str, Any] | None:
        """The table of an object; None: what carries it is left out of the scene."""
        carrier = self._drawing.of(entry.get("parent"), f"{place}.parent")
        if self._is_left_out(carrier):
            return None
        frame = self._frame_of(carrier)
        apart, position = entry.pop("apart", None), entry.pop("position", None)
        made: dict[str, Any] = {"name": name} | self._drawing.of(entry, place)
        motion = self._motion_of(made) if self._stand_apart else np.eye(4)
        if apart is not None:
            radius = self._number(apart, f"{place}.apart", "a number of m, at least 0", lambda x: x >= 0.0)
            made["position"] = self._free_place(position, radius, place, frame, motion[:3, 3])
        elif position is not None:
            made["position"] = self._drawing.of(position, f"{place}.position")
        self._frames[_full_name(carrier, name)] = frame @ _moved(_placement_of(made), motion)
        return made

    def _motion_of(self, made: dict[str, Any]) -> np.ndarray:
        """[4, 4], where trajectory or motion of a table of an object have it at time 0; of a refused one the identity."""
        if not made.keys() & {"trajectory", "motion"}:
            return np.eye(4)
        try:
            table = validated(ObjectTable, made)
            motion = self._trajectories.of(table, "") or motion_of(table.motion, "")
            return np.eye(4) if motion is None else motion.at(0.0)
        except (ValueError, OSError):  # of what the schema of the scene refuses, or a file that is not there
            return np.eye(4)

    def _frame_of(self, carrier: Any) -> np.ndarray:
        """World_from_carrier [4, 4] at time 0; of a part of an object that of the object."""
        path = carrier if isinstance(carrier, str) else ""
        while path and path not in self._frames:
            path = path.rpartition("/")[0]
        return self._frames.get(path, np.eye(4))

    def _free_place(self, position: Any, radius: float, place: str, frame: np.ndarray, way: np.ndarray) -> list[float]:
        """A position of which no other that is to stand apart is nearer than both radii together, seen from above.

        frame: world_from_carrier [4, 4] of what carries the object; way: [3] m from its position at time 0, in the axes of that
        """
        for attempt in range(_MOST_PLACES):
            found: list[float] = self._drawing.of(position, f"{place}.position", f"/try {attempt}")
            try:
                own = np.atleast_1d(np.array(found, float))[:3]
                if len(own) < 2 or not np.isfinite(own[:2]).all():
                    raise ValueError
            except (TypeError, ValueError, OverflowError):
                raise ValueError(f"{place}.position: must be [x, y, z] in m beside apart, got {shown(found)}") from None
            above = frame[:2, :len(own)] @ own + frame[:2, :3] @ way + frame[:2, 3]
            if all(np.hypot(*(above - other)) >= radius + beside for other, beside in self._places):
                self._places.append((above, radius))
                return found
        raise ValueError(f"{place}.apart: must leave a free place within {_MOST_PLACES} tries, got {shown(radius)}")


def _refuse_misspelt_own(entry: dict[str, Any], place: str) -> None:
    """Raises ValueError for a key that is nearest to one of `_OWN_KEYS`, of which the schema of the scene cannot tell."""
    for key in entry.keys() - ObjectTable.model_fields.keys() - set(_OWN_KEYS):
        meant = _core.meant_name(writable(key), [*ObjectTable.model_fields, *_OWN_KEYS])
        if meant in _OWN_KEYS:
            raise ValueError(f"{place}.{key}: unknown key; did you mean '{meant}'?")


def _full_name(parent: Any, name: str) -> str:
    return f"{parent}/{name}" if isinstance(parent, str) and parent else name


def _moved(placed: np.ndarray, motion: np.ndarray) -> np.ndarray:
    """The placement [4, 4] of an object that a motion has turned about its position and carried on."""
    return np.block([[motion[:3, :3] @ placed[:3, :3], placed[:3, 3:] + motion[:3, 3:]], [placed[3:]]])


def _placement_of(made: dict[str, Any]) -> np.ndarray:
    """[4, 4], of a table of an object, carrier_from_object; of values that the schema of the scene refuses none."""
    try:
        yaw = math.radians(made.get("yaw_deg", 0.0))
        return placement(tuple(made.get("position", ORIGIN)), yaw, made.get("transform"))
    except (TypeError, ValueError, OverflowError):
        return np.eye(4)
