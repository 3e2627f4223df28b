"""The trajectories that a scene file gives its objects and its radar."""
from __future__ import annotations

import functools
from pathlib import Path

import numpy as np

from ..trajectories import Trajectory, read_trajectories
from .errors import blamed
from .object_tables import ObjectTable
from .radar_tables import RadarTable
from .traffic import TrafficFiles
from .traffic_tables import TrafficTable


class Trajectories:
    """Makes the trajectories of a scene file; those of one file are read once."""

    def __init__(self, folder: Path, traffic: list[TrafficTable]):
        self._folder = folder
        self.traffic = TrafficFiles(traffic, folder)
        self._read = functools.cache(read_trajectories)

    def of(self, table: ObjectTable | RadarTable, key: str) -> Trajectory | None:
        """That of a table with the key `trajectory` and those beside it, None where it has none."""
        given = table.trajectory
        if given is None:
            return None
        with blamed(f"{key}.trajectory"):
            if not isinstance(given, str):
                values = given.model_dump()
                yaw = values.pop("yaw_deg")
                return Trajectory(**values, yaw=None if yaw is None else np.radians(yaw))
            found = self._read(self._folder / given)
        with blamed(f"{key}.id"):
            chosen = _chosen(found, table.id)
        ends = {name: getattr(table, name, None) for name in ("goes_on", "outside")}
        return chosen.replace(**{name: value for name, value in ends.items() if value is not None})


def _chosen(found: dict[str, Trajectory], name: str | None) -> Trajectory:
    """The trajectory of a name, or the only one."""
    if name in found:
        return found[name]
    known = ", ".join(list(found)[:10]) + (", ..." if len(found) > 10 else "")
    if name is None and len(found) == 1:
        return next(iter(found.values()))
    said = "is missing" if name is None else f"there is no '{name}'"
    raise ValueError(f"{said}; the file has {known}")
