"""Objects that a call names: which meshes each consists of."""
from __future__ import annotations

from collections.abc import Iterable, Mapping

from .checks import refused, text

NamedGlobs = tuple[tuple[str, tuple[str, ...]], ...]  # ((name, globs), ...), as objects are kept
# {name: globs}, globs that are names, or None: the usual ones.
Objects = Mapping[str, str | Iterable[str]] | Iterable[str] | NamedGlobs | None


def named_globs(objects: Objects) -> list | None:
    """[(name, [glob, ...]), ...] of the objects of a call; None stays None.

    objects: as in `families`
    """
    if objects is None:
        return None
    found = objects if isinstance(objects, (Mapping, set, frozenset)) else listed(objects)
    if not isinstance(found, (Mapping, list)):  # sets have no first, which is who owns what several globs take
        raise refused(TypeError, "objects", "a dict or a list of globs, as ['walker'] or as ep.find_objects gives it", objects)
    pairs = found.items() if isinstance(found, Mapping) else [_pair(glob) for glob in found]
    return list({_name(name): _globs_of(globs) for name, globs in pairs}.items())


def objects_rule(argument: str, value: Objects) -> NamedGlobs | None:
    """What `families` takes as objects, as values that nobody changes: those of the caller may change or be used up."""
    named = named_globs(value)
    return None if named is None else tuple((name, tuple(globs)) for name, globs in named)


def listed(value):
    """A list of what can be iterated, the value itself where it cannot be."""
    if isinstance(value, (str, bytes)):
        return value
    try:
        return list(value)
    except TypeError:
        return value


def _pair(found) -> tuple:
    """(name, globs) of what a list holds: a glob, which is the name too, or such a pair, as objects are kept."""
    return found if isinstance(found, tuple) and len(found) == 2 else (found, found)


def _name(name) -> str:
    """A name of an object; a list of globs makes them names, too."""
    return text("objects", name)


def _globs_of(globs) -> list:
    found = [globs] if isinstance(globs, str) else listed(globs)
    if not isinstance(found, list):
        raise refused(TypeError, "objects", "a dict or a list of globs", globs)
    return [text("objects", glob) for glob in found]
