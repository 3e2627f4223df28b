"""What a dataset holds, in numbers: objects, ghosts, detections, and how well the rays know them."""
from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from ..detections.detections import Detections
from ..paths.resolution import Interval
from .classes import ClassName
from .exports import are_echoes
from .opened import Dataset, DatasetFrame

MOST_FRAMES = 2000  # that are read, evenly spread


class SeenObject(NamedTuple):
    """An object of a frame: its class, the split and status of its label; range in m and power in W of its strongest cell, None
    without one; cells: that it has; error_db: how far the 95 % interval of its received power reaches, by the rays (bias and
    chance), dB to the farther side, infinite where it reaches to nothing, None without paths."""

    kind: ClassName
    split: str
    status: str
    range: float | None
    power: float | None
    cells: int
    error_db: float | None


@dataclass
class Statistics:
    """What was counted in the frames of a dataset.

    frames: that were read; objects: of all of them; ghosts: cells by (class, ghost type); detections: number by what made
    them: a class, a ghost of one, noise, interference, rain, leakage or residue; drawn: {dotted path: values}, one for each scene
    """

    frames: int = 0
    objects: list[SeenObject] = field(default_factory=list)
    ghosts: Counter[tuple[str, int]] = field(default_factory=Counter)
    detections: Counter[str] = field(default_factory=Counter)
    drawn: dict[str, list[Any]] = field(default_factory=dict)

    def errors_db(self, kind: ClassName) -> list[float]:
        """Of the objects of a class that have cells, `error_db`."""
        return [one.error_db for one in self.objects if one.kind == kind and one.cells and one.error_db is not None]


def statistics_of(dataset: Dataset) -> Statistics:
    """Reads the frames, at most MOST_FRAMES of them. Raises ep.FileError for a damaged file."""
    found = Statistics()
    for scene in dataset.scenes:
        for place, value in dataset.drawn(scene).items():
            found.drawn.setdefault(place, []).append(value)
    step = max(1, -(-len(dataset) // MOST_FRAMES))
    kinds: dict[int, dict[str, ClassName]] = {}
    for one in dataset[::step]:
        if one.scene not in kinds:
            kinds = {one.scene: dataset.classes(one.scene)}
        _count(one, kinds[one.scene], found)
    return found


def _count(one: DatasetFrame, kinds: dict[str, ClassName], found: Statistics) -> None:
    found.frames += 1
    for labels in list(one.frame.labels.values())[:1]:  # objects and ghosts are the same in all partitions
        found.objects += _objects(labels, kinds, one.split)
        for ghost in labels.ghosts:
            found.ghosts[kinds.get(ghost.object, "static"), ghost.ghost_type] += ghost.cells
    detections = one.frame.detections
    if isinstance(detections, Detections):
        no_echoes = np.where(are_echoes(detections), "", detections.part)
        for no_echo, name, ghost_type in zip(no_echoes, detections.object, detections.ghost_type):
            kind = kinds.get(str(name), "static")
            found.detections[str(no_echo) or (f"ghost of {kind}" if ghost_type else kind)] += 1


def _objects(labels: Any, kinds: dict[str, ClassName], split: str) -> Iterator[SeenObject]:
    for one in labels.objects:
        place, power = (None, None) if one.peak is None else (one.peak.range, one.peak.power)
        yield SeenObject(kinds.get(one.name, "static"), split, one.status, place, power, one.cells, _error_db(one.received))


def _error_db(received: Interval | None) -> float | None:
    """How far an interval reaches to its farther side."""
    if received is None or received.power <= 0.0:
        return None
    if received.low <= 0.0:
        return math.inf
    return 10.0 * math.log10(max(received.high / received.power, received.power / received.low))
