"""What moves along trajectories of files, by the words of its kind."""
from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple, TypeVar

from .. import _core
from ..arguments.names import first_names
from ..base.process.callers import warn_user

T = TypeVar("T")


class Kind(NamedTuple):
    """actor: of `ep.actors`, that is usual for the kind; keywords: of it; length: m, twice from its middle to its front, of
    vehicles, whose fronts files have."""

    actor: str
    keywords: dict[str, Any]
    length: float


_CAR = Kind("car", {}, 4.3)
_TRUCK, _BUS, _VAN = Kind("truck", {}, 16.6), Kind("van", {"kind": "large"}, 5.95), Kind("van", {"kind": "small"}, 4.95)
_MOTORCYCLE, _CYCLIST = Kind("motorcycle", {}, 2.0), Kind("cyclist", {}, 1.95)
_PERSON, _DOG = Kind("pedestrian", {}, 0.0), Kind("dog", {}, 0.0)  # files have their middles
# The first word that is in the name of a kind is taken.
_KINDS = {"truck": _TRUCK, "trailer": _TRUCK, "lorry": _TRUCK, "tram": _TRUCK, "bus": _BUS, "coach": _BUS, "delivery": _BUS,
          "van": _VAN, "motorcycle": _MOTORCYCLE, "motorbike": _MOTORCYCLE, "moped": _MOTORCYCLE, "bicycle": _CYCLIST,
          "bike": _CYCLIST, "cyclist": _CYCLIST, "ped": _PERSON, "person": _PERSON, "walk": _PERSON, "dog": _DOG}


VEHICLES = "bicycle", "car", "cyclist", "motorcycle", "truck", "van"  # actors whose fronts files have, not their middles


def takes_kind(glob: str, kind: str) -> bool:
    """Whether a glob takes a kind, in whatever case."""
    return _core.glob_takes(glob.lower(), kind.lower())


def of_kind(values: Iterable[tuple[str, T]], kind: str, usual: T) -> T:
    """The value of the first glob that takes the kind; the usual one where none does."""
    return next((value for glob, value in values if takes_kind(glob, kind)), usual)


def warn_of_unused_kinds(argument: str, globs: Iterable[str], kinds: Iterable[str]) -> None:
    """Warns (RuntimeWarning) of globs that take none of the kinds that there are, as those with a typo."""
    there = list(dict.fromkeys(kinds))
    unused = [glob for glob in globs if not any(takes_kind(glob, kind) for kind in there)]
    if unused:
        take = "takes" if len(unused) == 1 else "take"
        known = first_names([kind for kind in there if kind]) or "of the file, which tells none"
        warn_user(f"{argument}: {first_names(unused)} {take} none of the kinds {known}")


def usual_kind(name: str, is_person: bool = False) -> Kind:
    """What is usual for a kind of that name, as files have it; where no word of it is known a compact car, or a pedestrian.

    is_person: whether the file says that it is no vehicle
    """
    name = name.lower()
    found = next((kind for word, kind in _KINDS.items() if word in name), _CAR)
    return _PERSON if is_person and found.actor in VEHICLES else found
