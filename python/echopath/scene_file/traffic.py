"""The traffic of a scene file: an object for each trajectory of a file, and radars that ride on one."""
from __future__ import annotations

import math
from pathlib import Path

from ..arguments.checks import refused
from ..arguments.names import first_names
from ..scene.scene import Scene
from ..readers.names import fit_name
from ..scene.traffic import add_traffic, chosen_of, following_actors
from ..trajectories import Trajectory, read_trajectories
from ..trajectories.kinds import VEHICLES, takes_kind, usual_kind
from .actors import actor_keywords, actor_maker, named_actor
from .errors import ToldValueError, blamed
from .traffic_tables import TrafficTable


class TrafficFiles:
    """What the `[[traffic]]` of a scene file says: where everybody is over time, left out or not."""

    def __init__(self, tables: list[TrafficTable], folder: Path):
        self._tables, self._folder = tables, folder
        self._found = [_read(table, folder, f"traffic[{index}]") for index, table in enumerate(tables)]

    def add_to(self, scene: Scene) -> None:
        """Puts an object for each trajectory that is not left out into the scene, under its name."""
        for index, (table, found) in enumerate(zip(self._tables, self._found)):
            key = f"traffic[{index}]"
            makers = {glob: _maker(value, f"{key}.actors.{glob}", self._folder) for glob, value in table.actors.items()}
            with blamed(key):
                add_traffic(scene, found, actor_of=makers, exclude=table.exclude, during=table.during)

    def objects(self) -> list[dict[str, str]]:
        """{"name", "actor" and "kind", the type in the file} of each object that `add_to` puts into a scene."""
        found = []
        for table, trajectories in zip(self._tables, self._found):
            for name, one in chosen_of(trajectories, table.exclude, table.during).items():
                value = next((value for glob, value in table.actors.items() if takes_kind(glob, one.kind)),
                             usual_kind(one.kind).actor)
                if value is not False:
                    actor = value if isinstance(value, str) else value.actor
                    found.append({"name": fit_name(name, "object"), "actor": actor, "kind": one.kind})
        return found

    def of(self, name: str, key: str) -> Trajectory:
        """The trajectory of a name, of the first file that has it; key: that asks for it. Raises ValueError."""
        for found in self._found:
            if name in found:
                return found[name]
        names = [one for found in self._found for one in found]
        raise refused(ToldValueError, key, f"an id of the [[traffic]], which has {first_names(names) or 'none'}", name)


def _read(table: TrafficTable, folder: Path, key: str) -> dict[str, Trajectory]:
    lengths = table.vehicle_length
    if lengths is None or isinstance(lengths, dict):
        lengths = (lengths or {}) | {glob: _length(value, f"{key}.actors.{glob}", folder) for glob, value in table.actors.items()
                                     if glob not in (lengths or {})}
    with blamed(key, file="file"):
        return read_trajectories(folder / table.file, origin=table.origin, smoothing=table.smoothing,
                                 vehicle_length=lengths, goes_on=table.goes_on, outside=table.outside,
                                 position=table.position, yaw=math.radians(table.yaw_deg))


def _length(value, key: str, folder: Path) -> float:
    """m, twice from the middle to the front of the actor of a value of `actors`; 0 of those whose middles files have."""
    if value is False:
        return 0.0
    name, parameters = _actor_of(value, key)
    scene = Scene()
    scene.add(named_actor(name, parameters, folder, key), name="actor")
    fronts = [float(scene.world_vertices(mesh.id, 0.0)[:, 0].max()) for mesh in scene.meshes]
    return 2.0 * max(fronts) if name in VEHICLES else 0.0


def _maker(value, key: str, folder: Path):
    """What add_traffic takes for a value of `actors`."""
    if value is False:
        return None
    make = actor_maker(*_actor_of(value, key), folder, key)
    return lambda _, trajectory: make(trajectory=trajectory)


def _actor_of(value, key: str) -> tuple[str, dict]:
    """(name, parameters) of a value of `actors` that is an actor. Raises ValueError for one that takes no trajectory."""
    name, parameters, place = (value, {}, key) if isinstance(value, str) else (value.actor, value.parameters, f"{key}.actor")
    if "trajectory" not in actor_keywords(name, place):
        raise refused(ToldValueError, place, f"an actor that takes a trajectory ({', '.join(following_actors())})", name)
    return name, parameters
