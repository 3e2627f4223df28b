"""The whole signal and its parts: their maps, and which paths belong to each."""
from __future__ import annotations

import dataclasses
import math

import numpy as np

from echopath.base.numerics.decibels import SMALLEST_POWER, in_dbm
from echopath.plots.maps import cells_of_scene

WHOLE = "whole"
OWN_GROUP = "own"    # parts that were named in the viewer
NO_SIGNAL_DBM = 0.0  # upper end of the colour scale where nothing is received
NOTHING_DBM = -1000.0  # dB re 1 mW: no echo is that weak
MESH_GROUP = "mesh"  # the spectrum of the mesh that is selected
_GROUPS = (WHOLE, OWN_GROUP, MESH_GROUP)


def group_of(partition: str) -> str:
    """The group of the parts of a partition: its name, in quotes where one of the viewer's own groups is called so."""
    return f"'{partition}'" if partition in _GROUPS else partition


def level_text(dbm: float) -> str:
    """A level in dB re 1 mW, as it is read out."""
    return f"{dbm:.1f} dBm" if dbm > NOTHING_DBM else "no signal"


def upper_end(peak_dbm: float) -> float:
    """Of a colour scale in dBm, the next multiple of 5; without any signal so high that the map is dark."""
    return NO_SIGNAL_DBM if peak_dbm <= NOTHING_DBM else 5.0 * math.ceil(peak_dbm / 5.0)


@dataclasses.dataclass
class Part:
    """One map and the paths behind it.

    group, name: its partition and its name there; the whole has both "whole"
    spectrum: RangeDoppler; paths: bool [P], or (part of each path [P], the number of this one), None: all paths
    selection: the same paths in words, None: there are none
    is_known: False for signals that were given without a word on their paths: their mask holds none
    recipe: how to make it again, for saving
    """

    group: str
    name: str
    spectrum: object
    paths: np.ndarray | tuple | None = None
    selection: object = None
    is_known: bool = True
    recipe: dict | None = None
    _levels: dict = dataclasses.field(default_factory=dict)

    @property
    def key(self) -> tuple:
        return self.group, self.name

    @property
    def mask(self):
        """Its paths, bool [P], made at every call; None: all."""
        if not isinstance(self.paths, tuple):
            return self.paths
        part_of_path, number = self.paths
        return part_of_path == number

    def level(self, tx: int, rx: int):
        """Power of a channel in dBm, f32 [velocity, range]."""
        if (tx, rx) not in self._levels:
            power = np.abs(self.spectrum.values[tx, rx]) ** 2
            self._levels[tx, rx] = in_dbm(power, SMALLEST_POWER).astype(np.float32)
        return self._levels[tx, rx]


class PartSet:
    """The parts by key, in the order in which they are shown."""

    def __init__(self, whole: Part, parts=()):
        self._parts = {whole.key: whole}
        for part in parts:
            self.add(part)

    def add(self, part: Part) -> None:
        self._parts[part.key] = part

    def remove(self, key: tuple) -> None:
        self._parts.pop(key, None)

    def __getitem__(self, key: tuple) -> Part:
        return self._parts[key]

    def __contains__(self, key: tuple) -> bool:
        return key in self._parts

    def __iter__(self):
        return iter(self._parts.values())

    @property
    def whole(self) -> Part:
        return self._parts[WHOLE, WHOLE]

    @property
    def partitions(self) -> list[str]:
        """Names of the partitions that came with the signal."""
        names = dict.fromkeys(part.group for part in self)
        return [name for name in names if name not in _GROUPS]

    def of_group(self, group: str) -> list[Part]:
        return [part for part in self if part.group == group]

    def shown_beside(self, partition: str | None) -> list[Part]:
        """The whole, the parts of a partition, those named in the viewer, and the mesh that is selected."""
        groups = (WHOLE, partition, OWN_GROUP, MESH_GROUP)
        return [part for group in groups if group is not None for part in self.of_group(group)]

    def highest_level(self, tx: int, rx: int, ranges=None, velocities=None, leaked: Part | None = None) -> float:
        """The upper end of the colour scale in dBm: the peak of the whole, up to the next multiple of 5.

        ranges in m, velocities in m/s: (first, last), where the peak is looked for; None: everywhere. Without any signal
        it is so high that all maps are dark.
        leaked: the leakage in the whole, which sets no scale; None: there is none
        """
        spectrum, level = self.whole.spectrum, self.whole.level(tx, rx)
        columns, rows = _within(spectrum.range, ranges), _within(spectrum.velocity, velocities)
        if not level[rows, columns].size:
            columns = rows = slice(None)
        seen = None if leaked is None else leaked.level(tx, rx)[rows, columns]
        return upper_end(float(cells_of_scene(level[rows, columns], seen).max()))


def _within(axis, ends) -> slice:
    """The entries of an ascending axis between two values."""
    if ends is None:
        return slice(None)
    return slice(int(np.searchsorted(axis, ends[0], "left")), int(np.searchsorted(axis, ends[1], "right")))
