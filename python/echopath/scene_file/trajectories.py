"""The trajectories that a scene file gives its objects and its radar."""
from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ..base.storage.files import named_file
from ..trajectories import Trajectory
from ..trajectories.files.rows import KeptRows
from ..trajectories.files.track_file import TrackFile, Way
from .errors import blamed
from .tables.object_tables import ObjectTable
from .tables.radar_tables import RadarTable
from .tables.traffic_tables import TrafficTable
from .traffic import TrafficFiles


class Trajectories:
    """Makes the trajectories of a scene file; rows: of the files that it names."""

    def __init__(self, folder: Path, traffic: list[TrafficTable], rows: KeptRows):
        self._folder, self._rows = folder, rows
        self.traffic = TrafficFiles(traffic, folder, rows)
        self._files: dict[Path, TrackFile] = {}

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
            file = self._file(named_file(self._folder, given))
        with blamed(f"{key}.id"):
            name = _chosen(file.ways, table.id)
        with blamed(f"{key}.trajectory"):
            chosen = file.trajectories([name])[name]
        ends = {name: getattr(table, name, None) for name in ("goes_on", "outside")}
        return chosen.replace(**{name: value for name, value in ends.items() if value is not None})

    def _file(self, path: Path) -> TrackFile:
        if path not in self._files:
            self._files[path] = TrackFile(path, rows=self._rows.of(path))
        return self._files[path]


def _chosen(found: Mapping[str, Way], name: str | None) -> str:
    """A name that there is, or the only one."""
    if name is not None and name in found:
        return name
    known = ", ".join(list(found)[:10]) + (", ..." if len(found) > 10 else "")
    if name is None and len(found) == 1:
        return next(iter(found))
    said = "is missing" if name is None else f"there is no '{name}'"
    raise ValueError(f"{said}; the file has {known}")
