"""Templates of scenes: a scene file in which any value may be a distribution."""
from __future__ import annotations

import copy
import hashlib
import math
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np
from pydantic import AfterValidator, Field

from ..arguments.shown import shown
from ..scene_file import SceneFile
from ..scene_file.errors import validated
from ..scene_file.load import parse, scene_file_of
from ..scene_file.schema import Positive, SceneTable, Table
from ..sequence import Sequence
from ..sequence.keep import Keep
from .classes import ClassName
from .distributions import drawn, is_distribution, refuse_misspelt, with_kinds

MOST_SCENES = 10 ** 6
_MOST_PLACES = 1000          # that are tried for an object that is to stand apart from others
_SEEDS = 2 ** 32             # of rays and noise
_OF_NAMES = (".objects", ".materials")  # tables, beside parts, whose keys are names, which may be any


def _shares(split: dict[str, float]) -> dict[str, float]:
    if not split or any(isinstance(share, bool) or not 0.0 <= share for share in split.values()) or (
            abs(math.fsum(split.values()) - 1.0) > 1e-9):
        raise ValueError("must be name = share, whose sum is 1")
    return split


class DatasetTable(Table):
    """The table [dataset] of a template."""

    scenes: int = Field(ge=1, le=MOST_SCENES, description="number of scenes, each drawn anew")
    frames: int = Field(1, ge=1, description="of each scene, one after the other")
    interval: Positive | None = Field(None, description="s, from the start of a frame to that of the next; none: of one frame")
    keep: Keep = Field("maps", description="what the file of each frame keeps: all, maps with labels, or labels alone")
    seed: int = Field(0, ge=0, description="of all that is drawn")
    classes: dict[str, ClassName] = Field(
        {}, description="glob of objects' names = class, for exports; else by their actors, \"static\" without one")
    split: Annotated[dict[str, float], AfterValidator(_shares)] = Field(
        {"train": 0.8, "val": 0.1, "test": 0.1}, description="name = share of the scenes; each scene's is drawn")


class DrawnScene(NamedTuple):
    """One scene of a template: its number; the table of a scene file; values: {dotted path: value} of what was drawn."""

    number: int
    table: dict[str, Any]
    values: dict[str, Any]


class Template:
    """A template file (keys: data/README.md). Raises what `load_scene` raises, naming the file.

    path: of the file; settings: DatasetTable
    A value is a function of the seed, the number of the scene and the dotted path of its key alone, so that keys that are
    added, and scenes that are added, change no other.
    """

    def __init__(self, path: Path):
        self.path = path
        self.table = parse(path)
        scene = copy.deepcopy(self.table)
        try:
            self.settings = validated(DatasetTable, scene.pop("dataset", {}), ("dataset",))
            if self.settings.frames > 1 and self.settings.interval is None:
                raise ValueError("dataset.interval: is missing, in s from the start of a frame to that of the next")
            if "sequence" in scene:
                raise ValueError("sequence: must not stand in a template: [dataset] has frames, interval and keep")
        except ValueError as error:
            raise ValueError("\n".join(f"{path}: {line}" for line in str(error).splitlines())) from None
        self._objects = scene.pop("objects", [])
        self._rest = scene

    def __repr__(self) -> str:
        made = self.settings
        frames = f"{made.frames} frames" if made.frames > 1 else "1 frame"
        return f"Template('{self.path}', {made.scenes} scenes of {frames}, keep='{made.keep}', seed={made.seed})"

    def _repr_html_(self) -> str:
        from ..presentation.notebook import template_html

        return template_html(self)

    def draw(self, number: int) -> DrawnScene:
        """Scene `number` (from 0). Raises ValueError naming the file, the scene and the dotted path."""
        try:
            drawing = _Drawing(self.settings.seed, number)
            table = drawing.of(self._rest, "")
            for name in ("trace", "noise"):
                table.setdefault(name, {}).setdefault("seed", int(drawing.random(f"{name}.seed").integers(_SEEDS)))
            table["objects"] = _Objects(drawing).of(self._objects)
            return DrawnScene(number, table, drawing.values)
        except ValueError as error:
            raise self._of_scene(number, error) from None

    def split_of(self, number: int) -> str:
        """The name of the split that scene `number` (from 0) belongs to. Raises nothing."""
        place = _Drawing(self.settings.seed, number).random("dataset.split").random()
        names = list(self.settings.split)
        shares = np.cumsum(list(self.settings.split.values()))
        return names[min(int(np.searchsorted(shares, place, side="right")), len(names) - 1)]

    def check(self, number: int) -> None:
        """Raises ValueError, as `draw` does, where what is drawn for scene `number` is no scene file."""
        try:
            validated(SceneTable, self.draw(number).table)
        except ValueError as error:
            raise self._of_scene(number, error) from None

    def _of_scene(self, number: int, error: ValueError) -> ValueError:
        """The error with the file and the number of the scene before each line."""
        head = f"{self.path}: scene {number}: "
        lines = (line.removeprefix(head).removeprefix(f"{self.path}: ") for line in str(error).splitlines())
        return ValueError("\n".join(line if line.startswith("  ") else head + with_kinds(line) for line in lines))

    def scene_file(self, number: int) -> SceneFile:
        """What scene `number` says, ready to trace. Raises as `draw`."""
        return self._scene_file_of(self.draw(number))

    def sequence(self, number: int) -> Sequence:
        """The frames of scene `number`. Raises as `draw`, also where a motion does not cover them."""
        return self.sequence_of(self.draw(number))

    def sequence_of(self, scene: DrawnScene) -> Sequence:
        """The frames of a scene that is drawn. Raises as `sequence`."""
        scene_file, settings = self._scene_file_of(scene), self.settings
        assert scene_file.radar is not None  # which foreign scenes alone have not
        interval = settings.interval or scene_file.radar.frame_duration
        keywords = scene_file.keywords()
        if settings.keep == "labels" and keywords["labels"] is None:
            keywords["labels"] = True
        try:
            return Sequence(scene_file.scene, scene_file.radar, frames=settings.frames, interval=interval, **keywords)
        except ValueError as error:
            raise self._of_scene(scene.number, error) from None

    def _scene_file_of(self, scene: DrawnScene) -> SceneFile:
        try:
            return scene_file_of(scene.table, self.path)
        except ValueError as error:
            raise self._of_scene(scene.number, error) from None


class _Drawing:
    """Draws the values of one scene and remembers them."""

    def __init__(self, seed: int, scene: int):
        self._key = f"{seed}/{scene}/"
        self.values: dict[str, Any] = {}

    def random(self, place: str) -> np.random.Generator:
        """The random numbers of a dotted path."""
        digest = hashlib.sha256((self._key + place).encode("utf-8", "surrogatepass")).digest()
        return np.random.Generator(np.random.Philox(key=int.from_bytes(digest[:16], "little")))

    def of(self, value: Any, place: str, turn: str = "") -> Any:
        """A value of the template with all its distributions drawn; turn: another word draws others."""
        if is_distribution(value):
            self.values[place] = drawn(value, place, self.random(place + turn))
            return self.of(self.values[place], place, turn + "/chosen")  # a choice may be among distributions
        if isinstance(value, dict):
            if not (place.startswith("parts") or place.endswith(_OF_NAMES)):
                refuse_misspelt(value, place)
            return {key: self.of(one, f"{place}.{key}" if place else str(key), turn) for key, one in value.items()}
        if isinstance(value, list):
            return [self.of(one, f"{place}[{index}]", turn) for index, one in enumerate(value)]
        return value


class _Objects:
    """Draws the objects of a scene: how many of each there are, and where."""

    def __init__(self, drawing: _Drawing):
        self._drawing = drawing
        self._places: list[tuple[np.ndarray, float]] = []  # (x, y) and radius in m of what stands apart

    def of(self, entries: Any) -> list[Any]:
        if not isinstance(entries, list):
            return [entries]  # which the schema of the scene refuses
        objects: list[Any] = []
        for index, entry in enumerate(entries):
            is_table = isinstance(entry, dict) and isinstance(entry.get("name"), str)
            objects += self._copies(dict(entry)) if is_table else [self._drawing.of(entry, f"objects[{index}]")]
        return objects

    def _copies(self, entry: dict[str, Any]) -> list[dict[str, Any]]:
        name = entry.pop("name")
        place = f"objects.{name}"
        chance = self._number(entry.pop("chance", 1.0), f"{place}.chance", "a number from 0 to 1", lambda x: 0.0 <= x <= 1.0)
        is_row = "count" in entry
        count = self._number(entry.pop("count", 1), f"{place}.count", "a whole number of at least 0",
                             lambda x: x == int(x) and x >= 0)
        if self._drawing.random(f"{place}.presence").random() >= chance:
            count = 0
        names = [f"{name}_{number}" for number in range(1, int(count) + 1)] if is_row else [name] * int(count)
        return [self._one(one, dict(entry), f"objects.{one}") for one in names]

    def _number(self, value: Any, place: str, rule: str, holds: Callable[[float], bool]) -> float:
        number = self._drawing.of(value, place)
        if isinstance(number, bool) or not isinstance(number, (int, float)) or not holds(number):
            raise ValueError(f"{place}: must be {rule}, got {shown(number)}")
        return float(number)

    def _one(self, name: str, entry: dict[str, Any], place: str) -> dict[str, Any]:
        apart, position = entry.pop("apart", None), entry.pop("position", None)
        made: dict[str, Any] = {"name": name} | self._drawing.of(entry, place)
        if apart is not None:
            radius = self._number(apart, f"{place}.apart", "a number of m, at least 0", lambda x: 0.0 <= x < math.inf)
            made["position"] = self._free_place(position, radius, place)
        elif position is not None:
            made["position"] = self._drawing.of(position, f"{place}.position")
        return made

    def _free_place(self, position: Any, radius: float, place: str) -> list[float]:
        """A position of which no other that is to stand apart is nearer than both radii together, seen from above."""
        for attempt in range(_MOST_PLACES):
            found: list[float] = self._drawing.of(position, f"{place}.position", f"/try {attempt}")
            try:
                above = np.array(found, float)[:2]
                if above.shape != (2,) or not np.isfinite(above).all():
                    raise ValueError
            except (TypeError, ValueError):
                raise ValueError(f"{place}.position: must be [x, y, z] in m beside apart, got {shown(found)}") from None
            if all(np.hypot(*(above - other)) >= radius + own for other, own in self._places):
                self._places.append((above, radius))
                return found
        raise ValueError(f"{place}.apart: must leave a free place within {_MOST_PLACES} tries, got {shown(radius)}")
