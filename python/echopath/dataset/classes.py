"""What kinds of road users the objects of a dataset are."""
from __future__ import annotations

from typing import Any, Literal, NamedTuple

from .. import _core
from ..arguments.objects import NamedGlobs

ClassName = Literal["car", "van", "truck", "bus", "train", "cyclist", "motorcycle", "pedestrian", "pedestrian_group", "animal",
                    "other", "static"]


class Codes(NamedTuple):
    """The numbers of a class in public datasets.

    radar_scenes: label of RadarScenes (Schumann et al. 2021)
    ghost: class digit of the Radar Ghost Dataset (Kraus et al. 2021), 0: none there
    """

    radar_scenes: int
    ghost: int


CODES: dict[str, Codes] = {
    "car": Codes(0, 3), "van": Codes(1, 4), "truck": Codes(2, 4), "bus": Codes(3, 4), "train": Codes(4, 0),
    "cyclist": Codes(5, 2), "motorcycle": Codes(6, 5), "pedestrian": Codes(7, 1), "pedestrian_group": Codes(8, 0),
    "animal": Codes(9, 0), "other": Codes(10, 0), "static": Codes(11, 0)}

_OF_ACTORS: dict[str, ClassName] = {
    "car": "car", "van": "van", "truck": "truck", "cyclist": "cyclist", "bicycle": "cyclist", "motorcycle": "motorcycle",
    "pedestrian": "pedestrian", "captured_pedestrian": "pedestrian", "runner": "pedestrian", "standing_person": "pedestrian",
    "child": "pedestrian", "dog": "animal", "drone": "other"}
_OF_TRAFFIC: dict[str, ClassName] = {"bus": "bus", "coach": "bus", "tram": "train"}  # by words of types, before the actor


def classes_of(objects: list[dict[str, Any]], chosen: dict[str, ClassName]) -> dict[str, ClassName]:
    """{name of an object: class} of the objects of a scene's table, by the globs that were chosen, else by their actors,
    before which the types of traffic tell buses and trams."""
    return {one["name"]: next((kind for glob, kind in chosen.items() if _core.glob_takes(glob, one["name"])),
                              _usual_class(one)) for one in objects}


def with_named(classes: dict[str, ClassName], named: NamedGlobs, chosen: dict[str, ClassName]) -> dict[str, ClassName]:
    """Classes of the objects of a scene, and behind them of those that labels name otherwise: by the globs that were chosen, of
    which one takes their name or what they consist of, else of the object of the scene that they are, or are part of."""
    found = dict(classes)
    for name, globs in named:
        if name not in found:
            of_glob = (kind for one in (name, *globs) for glob, kind in chosen.items() if _core.glob_takes(glob, one))
            of_scene = (kind for one in globs for own, kind in classes.items()
                        if _core.glob_takes(own, one) or _core.glob_takes(one, own))
            found[name] = next(of_glob, None) or next(of_scene, "static")
    return found


def _usual_class(one: dict[str, Any]) -> ClassName:
    of_word = next((kind for word, kind in _OF_TRAFFIC.items() if word in str(one.get("kind", "")).lower()), None)
    return of_word or _OF_ACTORS.get(str(one.get("actor")), "static")
