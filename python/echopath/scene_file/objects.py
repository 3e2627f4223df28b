"""The objects of a scene file: meshes, models, actors, their materials and motions."""
from __future__ import annotations

import functools
import inspect
import math
import typing
from pathlib import Path

from pydantic import create_model

from .. import _core, actors
from ..readers import load_model
from ..scene.materials import known_with, material_fields, materials
from ..scene.scene import Scene
from ..weather import Weather
from .errors import blamed, validated
from .object_tables import MODEL_KEYS, ObjectTable
from .schema import SceneTable
from .table import Table, nearest_key
from .trajectories import Trajectories


def motion_of(table, key: str):
    if table is None:
        return None
    with blamed(key):
        if table.kind == "linear":
            return _core.LinearMotion(velocity=tuple(table.velocity), angular_velocity=tuple(table.angular_velocity))
        return _core.KeyframeMotion(times=table.times, translations=table.translations, rotations=table.rotations,
                                    interpolation=table.interpolation)


def _material(value, key: str):
    """The material of an object: None, an ep.Material, or a known name (which must be known)."""
    if value is None:
        return None
    with blamed(key):
        if isinstance(value, str):
            return materials[value]
        given = value.model_dump(exclude_unset=True)
        base = given.pop("base", None)
        given = material_fields(given)
        return known_with(base, **given) if base is not None else _core.Material(**given)


def build_scene(settings: SceneTable, folder: Path, trajectories: Trajectories):
    scene = Scene(weather=None if settings.weather is None else Weather(**settings.weather.model_dump()))
    meshes_of_file = functools.cache(_core.load_meshes)  # objects that name one file share its meshes
    for index, table in enumerate(settings.objects):
        key = f"objects[{index}]"
        placement = {"transform": table.transform} if table.transform is not None else {
            "position": tuple(table.position or (0.0, 0.0, 0.0)), "yaw": math.radians(table.yaw_deg or 0.0)}
        material = _material(table.material, f"{key}.material")
        trajectory = trajectories.of(table, key)
        shape, material = _shape(table, folder, key, material, meshes_of_file, trajectory)
        motion = motion_of(table.motion, f"{key}.motion")
        if trajectory is not None and getattr(shape, "motion", None) is None:
            motion = trajectory
        with blamed(key):
            scene.add(shape, name=table.name, material=material, motion=motion, speed=table.speed, parent=table.parent,
                      smooth=bool(table.smooth), visible=table.visible, **placement)
    return scene


def _shape(table: ObjectTable, folder: Path, key: str, material, meshes_of_file, trajectory):
    """The object's mesh, group of meshes, model, actor or nothing, and the material still to be given to it."""
    if table.group:
        return None, None
    if table.mesh is not None:
        with blamed(f"{key}.mesh"):
            meshes = meshes_of_file(str(folder / table.mesh), unit=table.unit or 1.0)
        return (meshes[0][1] if len(meshes) == 1 else meshes), material
    if table.model is not None:
        return _model(table, folder, key, trajectory), material
    factory = _actor_factory(table.actor, f"{key}.actor")
    model = _parameter_table(table.actor, factory)
    parameters = validated(model, table.parameters, (*_as_location(key), "parameters")).model_dump(exclude_unset=True)
    if "path" in parameters:
        parameters["path"] = folder / parameters["path"]  # of a motion capture, relative to the scene file
    if material is not None and "material" in _parameters(factory):
        parameters["material"], material = material, None
    if trajectory is not None and "trajectory" in _parameters(factory):
        parameters["trajectory"] = trajectory
    with blamed(f"{key}.parameters"):
        return factory(**parameters), material


def _model(table: ObjectTable, folder: Path, key: str, trajectory):
    """The content of a foreign file; with a way, as it goes along its trajectory."""
    settings = {name: getattr(table, name) for name in MODEL_KEYS if getattr(table, name) is not None}
    settings["materials"] = {name: _material(value, f"{key}.materials.{name}") for name, value in table.materials.items()}
    with blamed(f"{key}.model"):
        model = load_model(folder / table.model, **settings)
    if table.way is None:
        return model
    with blamed(f"{key}.way"):
        return model.along(trajectory, way=None if table.way == "auto" else table.way)


def _as_location(key: str) -> tuple:
    """'objects[3]' -> ('objects', 3)."""
    name, _, index = key.rstrip("]").partition("[")
    return (name, int(index))


def actor_names() -> list[str]:
    """Names of the ready-made objects: the public functions of echopath.actors."""
    return [name for name in actors.__all__ if inspect.isfunction(getattr(actors, name))]


def _actor_factory(name: str, key: str):
    if name not in actor_names():
        raise ValueError(f"{key}: unknown actor '{name}'; {nearest_key(name, actor_names()).replace('keys', 'actors')}")
    return getattr(actors, name)


@functools.cache
def _parameters(factory) -> dict:
    return dict(inspect.signature(factory).parameters)


@functools.cache
def _parameter_table(name: str, factory) -> type[Table]:
    """The keywords of an actor as a table: its signature is their only home, their values it checks itself."""
    fields = {parameter.name: (typing.Any, ... if parameter.default is parameter.empty else parameter.default)
              for parameter in _parameters(factory).values() if parameter.name not in ("material", "trajectory")}
    return create_model(f"{name}_parameters", __base__=Table, **fields)
