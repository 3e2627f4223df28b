"""The traffic of a scene file: an object for each trajectory of a file, and radars that ride on one."""
from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ..arguments.checks import refused
from ..arguments.names import first_names
from ..scene.scene import Scene
from ..scene.traffic import add_traffic, chosen_of, object_names
from ..trajectories import Trajectory
from ..trajectories.kinds import of_kind, require_kinds, usual_kind
from ..trajectories.read import read_along
from .errors import ToldValueError, blamed
from .traffic_shapes import TrafficShape, traffic_shape
from .table import yaw_of
from .traffic_tables import TrafficTable


class TrafficFiles:
    """What the `[[traffic]]` of a scene file says: where everybody is over time, left out or not."""

    def __init__(self, tables: list[TrafficTable], folder: Path):
        self._files = [_File(table, folder, f"traffic[{index}]") for index, table in enumerate(tables)]

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
        for file in self._files:
            if name in file.trajectories:
                return file.trajectories[name]
        names = [one for file in self._files for one in file.trajectories]
        raise refused(ToldValueError, key, f"an id of the [[traffic]], which has {first_names(names) or 'none'}", name)


class _File:
    """One `[[traffic]]`; key: of its table."""

    def __init__(self, table: TrafficTable, folder: Path, key: str):
        self._table, self._key = table, key
        self._shapes = {glob: traffic_shape(value, glob, f"{key}.actors.{glob}", folder) for glob, value in table.actors.items()}
        with blamed(key, file="file"):
            self.trajectories = read_along(
                folder / table.file, origin=table.origin, smoothing=table.smoothing, vehicle_length=self._vehicle_length(),
                goes_on=table.goes_on, outside=table.outside, position=table.position, yaw=yaw_of(table.yaw_deg))
            kinds = [one.kind for one in self.trajectories.values()]
            require_kinds("actors", self._shapes, kinds)
            require_kinds("vehicle_length", table.vehicle_length if isinstance(table.vehicle_length, dict) else (), kinds)

    def add_to(self, scene: Scene) -> None:
        makers = {glob: shape.maker for glob, shape in self._shapes.items()}
        with blamed(self._key):
            add_traffic(scene, self.trajectories, actor_of=makers, exclude=self._table.exclude, during=self._table.during)

    def objects(self, others: list[str]) -> list[dict[str, str]]:
        chosen = chosen_of(self.trajectories, self._table.exclude, self._table.during)
        actors = {name: self._actor(one) for name, one in chosen.items()}
        names = object_names([name for name, actor in actors.items() if actor], others)
        return [{"name": names[name], "actor": actors[name], "kind": chosen[name].kind} for name in names]

    def _actor(self, trajectory: Trajectory) -> str:
        """The actor of what goes along a trajectory, "" for no object."""
        shape: TrafficShape | None = of_kind(self._shapes.items(), trajectory.kind, None)
        if shape is not None and shape.maker is None:
            return ""
        if shape is None or shape.actor is None:
            return usual_kind(trajectory.kind, trajectory.is_person).actor
        return shape.actor

    def _vehicle_length(self):
        """What read_along takes: m of all vehicles, or of those by globs of their types."""
        given = self._table.vehicle_length
        if given is None or isinstance(given, dict):
            return (given or {}) | {glob: shape.length for glob, shape in self._shapes.items() if glob not in (given or {})}
        return given
