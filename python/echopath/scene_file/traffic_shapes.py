"""What goes along the trajectories of a type of traffic, as a scene file says: an actor, a model, or nothing."""
from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from ..arguments.checks import refused
from ..scene.scene import Scene
from ..scene.traffic import ActorOf, following_actors
from ..trajectories.kinds import VEHICLES, usual_kind
from .actors import actor_keywords, actor_maker, named_actor
from .errors import ToldValueError, blamed
from .models import model_along, model_of
from .tables.table import yaw_of
from .tables.traffic_tables import TrafficModelTable


class TrafficShape(NamedTuple):
    """What a type of traffic looks like.

    maker: what `add_traffic` takes, None: no object; actor: its name, None where it has none, as a model; length: m, twice from
    the middle to the front, 0 of those whose middles files have
    """

    maker: ActorOf | None
    actor: str | None
    length: float


def traffic_shape(value, glob: str, key: str, folder: Path) -> TrafficShape:
    """That of a value of `actors`. glob: of the types; key: of the value. Raises ValueError and ep.FileError naming the key."""
    if value is False:
        return TrafficShape(None, None, 0.0)
    if isinstance(value, TrafficModelTable):
        return _of_model(value, usual_kind(glob).actor, key, folder)
    return _of_actor(value, key, folder)


def _of_model(table: TrafficModelTable, actor: str, key: str, folder: Path) -> TrafficShape:
    model = model_of(table, folder, key)
    if table.yaw_deg != 0.0 or any(table.position):      # else its meshes have the names that they have in Python
        with blamed(key):
            model = model.placed(position=table.position, yaw=yaw_of(table.yaw_deg))
    length = 2.0 * _front_of(model) if actor in VEHICLES else 0.0
    return TrafficShape(lambda _, trajectory: model_along(model, table, key, trajectory), None, length)


def _of_actor(value, key: str, folder: Path) -> TrafficShape:
    name, parameters, place = (value, {}, key) if isinstance(value, str) else (value.actor, value.parameters, f"{key}.actor")
    if "trajectory" not in actor_keywords(name, place):
        raise refused(ToldValueError, place, f"an actor that takes a trajectory ({', '.join(following_actors())})", name)
    make = actor_maker(name, parameters, folder, key)
    front = _front_of(named_actor(name, parameters, folder, key))  # which tells of wrong parameters at once, too
    length = 2.0 * front if name in VEHICLES else 0.0
    return TrafficShape(lambda _, trajectory: make(trajectory=trajectory), name, length)


def _front_of(shape) -> float:
    """m, how far it reaches ahead of its origin."""
    scene = Scene()
    scene.add(shape, name="shape")
    return max(float(scene.world_vertices(mesh.id, 0.0)[:, 0].max()) for mesh in scene.meshes)
