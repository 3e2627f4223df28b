"""What kinds of road users the objects of a dataset are."""
from __future__ import annotations

import itertools
from collections.abc import Iterable
from typing import Any, Literal, NamedTuple

from .. import _core
from ..arguments.names import first_names
from ..arguments.objects import NamedGlobs
from ..base.process.callers import warn_user

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
_OF_PERSON = ".bvh"  # files of motion captures, which the walking person moves by
_OF_TRAFFIC: dict[str, ClassName] = {"bus": "bus", "coach": "bus", "tram": "train"}  # by words of types, before the actor


def classes_of(objects: list[dict[str, Any]], chosen: dict[str, ClassName], named: NamedGlobs = ()) -> dict[str, ClassName]:
    """{name of an object: class} of the objects of a scene's table, by the globs that were chosen, else by their actors,
    before which the types of traffic tell buses and trams, as motion captures of people, or as groups of what they carry;
    and behind them of those that labels name otherwise.

    named: of the labels: a glob that was chosen takes their name or what they consist of, else they have the class of the
        object of the table that they are, or are part of
    """
    paths = {_full_name(one): _chosen_class(chosen, one["name"]) or _usual_class(one) for one in objects}
    groups = [_full_name(one) for one in objects if one.get("group") and not _chosen_class(chosen, one["name"])]
    for group in sorted(groups, key=lambda path: path.count("/"), reverse=True):  # those that others carry first
        paths[group] = _joint_class({kind for path, kind in paths.items() if path.rpartition("/")[0] == group})
    found = {one["name"]: paths[_full_name(one)] for one in objects}
    # Labels call the objects of the root by their names: what another one carries may have the same name.
    of_root = {name: paths[name] for name in found if name in paths}
    found |= of_root
    for name, globs in named:
        if name not in of_root or tuple(globs) != (name,):
            found[name] = _chosen_class(chosen, name, *globs) or _class_below(paths, globs)
    return found


def warn_of_unused_globs(chosen: Iterable[str], names: Iterable[str], named: NamedGlobs) -> None:
    """Warns (RuntimeWarning) of globs that were chosen and take no object, as those with a typo.

    names: that objects may have; named: of the labels
    """
    unused = list(chosen)
    for name in itertools.chain(*([name, *globs] for name, globs in named), names):
        unused = [glob for glob in unused if not _core.glob_takes(glob, name)]
        if not unused:
            break
    if unused:
        told = first_names([repr(glob) for glob in unused])
        warn_user(f"dataset.classes: {told} {'takes' if len(unused) == 1 else 'take'} no object of the template")


def _chosen_class(chosen: dict[str, ClassName], *names: str) -> ClassName | None:
    """Of the first glob that takes the first of the names that any takes."""
    return next((kind for name in names for glob, kind in chosen.items() if _core.glob_takes(glob, name)), None)


def _class_below(paths: dict[str, ClassName], globs: Iterable[str]) -> ClassName:
    """Of the objects, by their full names, that globs take or are within: of those that carry each other the ones carried."""
    found = set()
    for glob in globs:
        owners = [path for path in paths if _core.glob_takes(path, glob) or _core.glob_takes(glob, path)]
        deepest = max((path.count("/") for path in owners), default=0)
        found |= {paths[path] for path in owners if path.count("/") == deepest}
    return _joint_class(found)


def _joint_class(kinds: set[ClassName]) -> ClassName:
    """Of several objects together: road users of several classes are "other"."""
    users = kinds - {"static"}
    return users.pop() if len(users) == 1 else "other" if users else "static"


def _full_name(one: dict[str, Any]) -> str:
    return "/".join(filter(None, (one.get("parent"), one["name"])))


def _usual_class(one: dict[str, Any]) -> ClassName:
    of_word = next((kind for word, kind in _OF_TRAFFIC.items() if word in str(one.get("kind", "")).lower()), None)
    of_model: ClassName = "pedestrian" if str(one.get("model", "")).lower().endswith(_OF_PERSON) else "static"
    return of_word or _OF_ACTORS.get(str(one.get("actor")), of_model)
