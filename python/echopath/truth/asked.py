"""The keyword `truth` of a simulation: whether its frames carry their Truth, and of which objects."""
from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..arguments.checks import refused
from ..arguments.keywords import refuse_unknown
from ..arguments.objects import Objects, objects_rule
from ..paths.families import check_objects

Asked = bool | Mapping[str, Any] | None


def truth_keywords(scene, asked: Asked, objects: Objects = None) -> dict[str, Any] | None:
    """Keywords of `truth_of_frame`, checked before the long work; None: not at all.

    asked: True, or keywords of `truth`; objects: unless these name others
    Raises TypeError or ValueError naming the argument, also for globs that take no mesh of the scene.
    """
    if asked is None or asked is False:
        return None
    if not (asked is True or isinstance(asked, Mapping)):
        raise refused(TypeError, "truth", "True, False or a dict of keywords of truth", asked)
    keywords = {} if asked is True else dict(asked)
    refuse_unknown("truth", keywords, ["objects"])
    try:
        chosen = objects_rule("objects", keywords.get("objects", objects))
        check_objects(scene, chosen)
    except (TypeError, ValueError) as error:
        raise type(error)(f"truth: {error}") from None
    return {"objects": chosen}
