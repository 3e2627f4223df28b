"""Templates of scenes: a scene file in which any value may be a distribution."""

import copy
import math
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import numpy as np
from pydantic import AfterValidator, Field

from ...arguments.objects import NamedGlobs, objects_rule
from ...base.numerics.golden import golden_place
from ...base.text.counts import counted
from ...scene_file import SceneFile
from ...scene_file.errors import validated
from ...scene_file.load import parse, scene_file_of
from ...scene_file.tables.run_tables import FOUND
from ...scene_file.tables.schema import SceneTable
from ...scene_file.tables.table import Positive, Table
from ...scene_file.traffic import TrafficFiles
from ...scene_file.trajectories import Trajectories
from ...sequence import Sequence
from ...sequence.keep import Keep
from ...trajectories.files.rows import KeptRows
from ..classes import ClassName, classes_of, warn_of_unused_globs
from .distributions import is_distribution
from .drawing import Drawing, DrawnObjects, possible_names, random_at
from .faults import Faults
from .references import Source, is_reference

MOST_SCENES = 10 ** 6
_SEEDS = 2 ** 32  # of rays and noise


def _shares(split: dict[str, float]) -> dict[str, float]:
    if not split or any(isinstance(share, bool) or not 0.0 <= share for share in split.values()) or (
            abs(math.fsum(split.values()) - 1.0) > 1e-9):
        raise ValueError("must be name = share, whose sum is 1")
    return split


class DatasetTable(Table):
    """The table [dataset] of a template (keys: data/README.md), as `Template.settings` has it."""

    scenes: int = Field(ge=1, le=MOST_SCENES, description="number of scenes, each drawn anew")
    frames: int = Field(1, ge=1, description="of each scene, one after the other")
    interval: Positive | None = Field(None, description="s, from the start of a frame to that of the next; none: of one frame")
    keep: Keep = Field("maps", description="what the file of each frame keeps: all, maps with labels, or labels alone")
    seed: int = Field(0, ge=0, description="of all that is drawn")
    classes: dict[str, ClassName] = Field(
        {}, description="glob of objects' names = class, for exports; else by their actors, \"static\" without one")
    split: Annotated[dict[str, float], AfterValidator(_shares)] = Field(
        {"train": 0.8, "val": 0.1, "test": 0.1}, description="name = share of the scenes, evenly over their numbers")


class DrawnScene(NamedTuple):
    """One scene of a template: its number; the table of a scene file; values: {dotted path: value} of what was drawn."""

    number: int
    table: dict[str, Any]
    values: dict[str, Any]


class Template:
    """A template file (keys: data/README.md). Raises what `load_scene` raises, naming the file.

    path: of the file; folder: of the files that it names, None: that of the file; settings: DatasetTable
    A value is a function of the seed, the number of the scene and the dotted path of its key alone, so that keys that are
    added, and scenes that are added, change no other.
    """

    def __init__(self, path: str | Path, folder: str | Path | None = None):
        path = Path(path)
        self.path, self.folder = path, path.parent if folder is None else Path(folder)
        self.table = parse(path)
        scene = copy.deepcopy(self.table)
        self._faults = Faults(path, self.table)
        try:
            if "dataset" not in scene:
                raise ValueError("dataset: is missing, which a template has; a scene file is simulated by `echopath run`")
            self.settings = validated(DatasetTable, scene.pop("dataset", {}), ("dataset",))
            if self.settings.frames > 1 and self.settings.interval is None:
                raise ValueError("dataset.interval: is missing, in s from the start of a frame to that of the next")
            if "sequence" in scene:
                raise ValueError("sequence: must not stand in a template: [dataset] has frames, interval and keep")
            if is_distribution(scene) or is_reference(scene):
                raise ValueError(f"{next(iter(scene))}: must stand below a key, whose value it draws, got it at the top")
        except ValueError as error:
            raise self._faults.told(error) from None
        self._objects = scene.pop("objects", [])
        self._rest = scene
        self._traffic: dict[str, TrafficFiles] = {}  # as it was drawn last
        self._rows = KeptRows()
        self._trajectories = Trajectories(self.folder, [], self._rows)  # for where objects are that stand apart

    def __repr__(self) -> str:
        made = self.settings
        scenes, frames = counted(made.scenes, "scene"), counted(made.frames, "frame")
        return f"Template('{self.path}', {scenes} of {frames}, keep='{made.keep}', seed={made.seed})"

    def _repr_html_(self) -> str:
        from ...presentation.notebook import template_html

        return template_html(self)

    def draw(self, number: int) -> DrawnScene:
        """Scene `number` (from 0). Raises ValueError naming the file, the scene and the dotted path."""
        try:
            drawing = Drawing(self.settings.seed, number, Source(self._rest, self._objects))
            table = drawing.of(self._rest, "")
            for name in ("trace", "noise"):
                if isinstance(settings := table.setdefault(name, {}), dict):  # else the schema of the scene refuses it
                    settings.setdefault("seed", int(drawing.random(f"{name}.seed").integers(_SEEDS)))
            table["objects"] = DrawnObjects(drawing, self._trajectories).of(self._objects)
            return DrawnScene(number, table, drawing.values)
        except ValueError as error:
            raise self._faults.told(error, number) from None

    def objects(self, number: int) -> list[dict[str, Any]]:
        """The objects of scene `number`, as tables that have at least a name, those of its traffic too. Raises as `draw`."""
        scene = self.draw(number)
        if "traffic" not in scene.table:
            return scene.table["objects"]
        told = repr(scene.table["traffic"])
        if told not in self._traffic:  # alike in all scenes, mostly
            with self._faults.of(number, scene.table):
                self._traffic = {told: TrafficFiles(validated(SceneTable, scene.table).traffic, self.folder, self._rows)}
        objects = scene.table["objects"]
        return objects + self._traffic[told].objects(one["name"] for one in objects if not one.get("parent"))

    def classes(self, number: int, named: NamedGlobs = ()) -> dict[str, ClassName]:
        """{name: class} of the objects of scene `number`, by the template's `classes`, else by actors. Raises as `draw`.

        named: objects as labels name them, which follow those of the scene
        """
        return classes_of(self.objects(number), self.settings.classes, named)

    def warn_of_unused_classes(self, number: int) -> None:
        """Warns (RuntimeWarning) of globs of `classes` that take no object, as those with a typo. Raises as `draw`.

        number: of a scene, whose labels name objects, too. Where files of traffic, or what is found in a scene, have names of
        their own, it says nothing.
        """
        table = self.draw(number).table
        asked = [table[key].get("objects") for key in ("labels", "truth") if key in table]
        if self.settings.classes and "traffic" not in table and FOUND not in asked:
            named = tuple(pair for one in asked for pair in objects_rule("objects", one) or ())
            warn_of_unused_globs(self.settings.classes, possible_names(self._objects), named)

    def split_of(self, number: int) -> str:
        """The name of the split that scene `number` (from 0) belongs to. Raises nothing.

        Of any N <= 1000 scenes in a row a split has its share of N to within 4, and a split of a tenth has one of 20 at least:
        steps of the golden ratio, from a place that the seed draws, spread evenly however many there are.
        """
        place = golden_place(number, first=random_at(self.settings.seed, 0, "dataset.split").random())
        names = list(self.settings.split)
        shares = np.cumsum(list(self.settings.split.values()))
        return names[min(int(np.searchsorted(shares, place, side="right")), len(names) - 1)]

    def check(self, number: int) -> None:
        """Raises ValueError, as `draw` does, where what is drawn for scene `number` is no scene file."""
        scene = self.draw(number)
        with self._faults.of(scene.number, scene.table):
            validated(SceneTable, scene.table)

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
        with self._faults.of(scene.number, scene.table):
            return Sequence(scene_file.scene, scene_file.radar, frames=settings.frames, interval=interval, **keywords)

    def _scene_file_of(self, scene: DrawnScene) -> SceneFile:
        with self._faults.of(scene.number, scene.table):
            return scene_file_of(scene.table, self.path, self.folder, self._rows)
