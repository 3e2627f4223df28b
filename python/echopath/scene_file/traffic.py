"""The traffic of a scene file: an object for each trajectory of a file, and radars that ride on one."""
from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from .. import _core
from ..actors.vehicles.trucks import DRIVE_AXLE
from ..arguments.checks import refused
from ..arguments.names import first_names
from ..base.storage.files import named_file
from ..scene.scene import Scene
from ..scene.traffic import MakerOfKinds, chosen_of, object_names, put_traffic
from ..trajectories import Trajectory
from ..trajectories.files.rows import KeptRows
from ..trajectories.files.track_file import TrackFile, Way, warn_of_nobody
from ..trajectories.kinds import of_kind, usual_kind
from .errors import ToldValueError, blamed
from .tables.table import yaw_of
from .tables.traffic_tables import TrafficTable
from .traffic_shapes import traffic_shape


class TrafficFiles:
    """What the `[[traffic]]` of a scene file says: where everybody is over time, left out or not."""

    def __init__(self, tables: list[TrafficTable], folder: Path, rows: KeptRows):
        self._files = [_File(table, folder, f"traffic[{index}]", rows) for index, table in enumerate(tables)]

    def add_to(self, scene: Scene) -> None:
        """Puts an object for each trajectory that is not left out into the scene, under its name."""
        for file in self._files:
            file.add_to(scene)

    def objects(self, others: Iterable[str] = ()) -> list[dict[str, str]]:
        """{"name", "actor" and "kind", the type in the file} of each object that `add_to` puts into a scene of others.

        A model counts as the actor that is usual for its types.
        """
        found: list[dict[str, str]] = []
        for file in self._files:
            found += file.objects([*others, *(one["name"] for one in found)])
        return found

    def of(self, name: str, key: str) -> Trajectory:
        """The trajectory of a name, of the first file that has it; key: that asks for it. Raises ValueError."""
        return self._file_of(name, key).trajectories([name])[name]

    def mount(self, name: str, position, key: str) -> _core.CurveMotion:
        """The motion of a place [3] in m in the axes of a name, of trucks in those of the cab. Takes and raises as `of` does."""
        return self.of(name, key).motion(position, axle=self._file_of(name, key).axle(name))

    def _file_of(self, name: str, key: str) -> _File:
        for file in self._files:
            if name in file.ways:
                return file
        names = [one for file in self._files for one in file.ways]
        known = first_names(names) or "none"
        raise refused(ToldValueError, key, f"an id of the [[traffic]], which has {known}; an object needs `during`", name)


class _File:
    """One `[[traffic]]`; key: of its table."""

    def __init__(self, table: TrafficTable, folder: Path, key: str, rows: KeptRows):
        self._table, self._key = table, key
        self._shapes = {glob: traffic_shape(value, glob, f"{key}.actors.{glob}", folder) for glob, value in table.actors.items()}
        path = named_file(folder, table.file)
        with blamed(key, file="file"):
            self._tracks = TrackFile(
                path, origin=table.origin, smoothing=table.smoothing, vehicle_length=self._vehicle_length(), rows=rows.of(path),
                goes_on=table.goes_on, outside=table.outside, position=table.position, yaw=yaw_of(table.yaw_deg))
        self.ways = self._tracks.ways

    def trajectories(self, names: Iterable[str]) -> dict[str, Trajectory]:
        with blamed(self._key, file="file"):
            return self._tracks.trajectories(names)

    def add_to(self, scene: Scene) -> None:
        self._warn()
        trajectories = self.trajectories(self._chosen())
        maker = MakerOfKinds({glob: shape.maker for glob, shape in self._shapes.items()})
        with blamed(self._key):
            put_traffic(scene, trajectories, maker, self._table.during)

    def _warn(self) -> None:
        """Warns (RuntimeWarning) of what the table says and the file has nobody for."""
        self._tracks.warn_of_unused(f"{self._key}.actors", self._shapes)
        if isinstance(self._table.vehicle_length, dict):
            self._tracks.warn_of_unused(f"{self._key}.vehicle_length", self._table.vehicle_length)
        warn_of_nobody(self.ways, self._table.during)

    def _chosen(self) -> dict[str, Way]:
        """Those who are not left out."""
        with blamed(self._key):
            return chosen_of(self.ways, self._table.exclude, self._table.during)

    def objects(self, others: list[str]) -> list[dict[str, str]]:
        chosen = self._chosen()
        actors = {name: self._actor(one) for name, one in chosen.items()}
        names = object_names([name for name, actor in actors.items() if actor], others)
        return [{"name": names[name], "actor": actors[name], "kind": chosen[name].kind} for name in names]

    def axle(self, name: str) -> float:
        """m, of the point ahead of the origin by which a name is steered, as `Trajectory.motion` takes it."""
        shape = of_kind(self._shapes.items(), self.ways[name].kind, None)
        has_model = shape is not None and shape.maker is not None and shape.actor is None
        return DRIVE_AXLE if self._actor(self.ways[name]) == "truck" and not has_model else 0.0

    def _actor(self, way: Way) -> str:
        """The actor of what goes along a way, "" for no object."""
        shape = of_kind(self._shapes.items(), way.kind, None)
        if shape is not None and shape.maker is None:
            return ""
        if shape is None or shape.actor is None:
            return usual_kind(way.kind, way.is_person).actor
        return shape.actor

    def _vehicle_length(self):
        """What read_trajectories takes: m of all vehicles, or of those by globs of their types."""
        given = self._table.vehicle_length
        if given is None or isinstance(given, dict):
            return (given or {}) | {glob: shape.length for glob, shape in self._shapes.items() if glob not in (given or {})}
        return given
