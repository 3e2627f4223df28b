"""The objects of a scene file: meshes, models, actors, their materials and motions."""
from __future__ import annotations

import functools
from pathlib import Path

from .. import _core
from ..base.storage.files import named_file
from ..scene.meshes import load_meshes
from ..scene.scene import Scene
from ..weather import Weather
from .actors import actor_keywords, named_actor
from .errors import blamed
from .models import material_of, model_along, model_of
from .tables.object_tables import ObjectTable
from .tables.schema import SceneTable
from .tables.table import yaw_of
from .trajectories import Trajectories


def motion_of(table, key: str):
    if table is None:
        return None
    with blamed(key):
        if table.kind == "linear":
            return _core.LinearMotion(velocity=tuple(table.velocity), angular_velocity=tuple(table.angular_velocity))
        return _core.KeyframeMotion(times=table.times, translations=table.translations, rotations=table.rotations,
                                    interpolation=table.interpolation)


def build_scene(settings: SceneTable, folder: Path, trajectories: Trajectories):
    scene = Scene(weather=None if settings.weather is None else Weather(**settings.weather.model_dump()))
    meshes_of_file = functools.cache(load_meshes)  # objects that name one file share its meshes
    for index, table in enumerate(settings.objects):
        key = f"objects[{index}]"
        placement = {"transform": table.transform} if table.transform is not None else {
            "position": tuple(table.position or (0.0, 0.0, 0.0)), "yaw": yaw_of(table.yaw_deg)}
        material = material_of(table.material, f"{key}.material")
        trajectory = trajectories.of(table, key)
        shape, material = _shape(table, folder, key, material, meshes_of_file, trajectory)
        motion = motion_of(table.motion, f"{key}.motion")
        if trajectory is not None and getattr(shape, "motion", None) is None:
            motion = trajectory
        with blamed(key):
            name = scene.add(shape, name=table.name, material=material, motion=motion, speed=table.speed, parent=table.parent,
                             smooth=bool(table.smooth), visible=table.visible, **placement)
            if table.lifetime is not None:
                scene[name].lifetime = table.lifetime
    return scene


def _shape(table: ObjectTable, folder: Path, key: str, material, meshes_of_file, trajectory):
    """The object's mesh, group of meshes, model, actor or nothing, and the material still to be given to it."""
    if table.group:
        return None, None
    if table.mesh is not None:
        with blamed(f"{key}.mesh"):
            meshes = meshes_of_file(str(named_file(folder, table.mesh)), unit=table.unit or 1.0)
        return (meshes[0][1] if len(meshes) == 1 else meshes), material
    if table.model is not None:
        return model_along(model_of(table, folder, key), table, key, trajectory), material
    own = {}
    if material is not None and "material" in actor_keywords(table.actor, f"{key}.actor"):
        own["material"], material = material, None
    if trajectory is not None and "trajectory" in actor_keywords(table.actor, f"{key}.actor"):
        own["trajectory"] = trajectory
    return named_actor(table.actor, table.parameters, folder, key, **own), material
