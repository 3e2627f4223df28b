"""Which object each path belongs to, and by what way: ghost families."""
from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from functools import cached_property

import numpy as np

from .. import _core
from ..arguments.checks import an, checked
from ..arguments.objects import Objects, named_globs, objects_rule
from ..base.classes.equality import is_same
from ..base.classes.made_by import made_by
from ..base.text.counts import counted

NO_OBJECT = -1  # index of the object of a path that touches none


@made_by("ep.families")
@dataclasses.dataclass(frozen=True, eq=False)
class Families:
    """The ghost family of each path; made by `families`. A view for `decompose`.

    objects: names, in order
    families: tuple of Family, those that occur: by object, order, type and surfaces; last the background, always
    family_of_path: u32 [P], index into families
    grouping: the rule, which `decompose` applies to later records of a frame too
    """

    objects: tuple[str, ...]
    families: tuple[_core.Family, ...]
    family_of_path: np.ndarray
    grouping: _core.Grouping

    @cached_property
    def object_of_path(self) -> np.ndarray:
        """Index into objects of each path's owner, -1: it touches none; i32 [P]."""
        index = {name: number for number, name in enumerate(self.objects)}
        return self._of_paths(lambda family: index.get(family.object, NO_OBJECT))

    @property
    def ghost_type(self) -> np.ndarray:
        """Ghost type of each path, 0 for real echoes and the background; i32 [P]."""
        return self._of_paths(lambda family: family.ghost_type)

    @property
    def order(self) -> np.ndarray:
        """Number of bounces of each path, hits that follow each other on one object being one; 0: background; i32 [P]."""
        return self._of_paths(lambda family: family.order)

    @property
    def class_code(self) -> np.ndarray:
        """Family.class_code of each path; i32 [P]."""
        return self._of_paths(lambda family: family.class_code)

    def paths_of(self, family: _core.Family) -> np.ndarray:
        """Indices of the paths of a Family, i64 [N]; none where it does not occur.

        family: one of `families` or of another record of the scene
        Raises TypeError naming the argument.
        """
        an(_core.Family)("family", family)
        if family not in self.families:
            return np.zeros(0, np.int64)
        return np.flatnonzero(self.family_of_path == self.families.index(family))

    def _of_paths(self, value) -> np.ndarray:
        return np.array([value(family) for family in self.families], np.int32)[self.family_of_path]

    def __eq__(self, other) -> bool:
        if not isinstance(other, Families):
            return NotImplemented
        return all(is_same(getattr(self, name), getattr(other, name)) for name in ("objects", "families", "family_of_path"))

    __hash__ = None

    def __len__(self) -> int:
        return len(self.families)

    def __iter__(self) -> Iterator[_core.Family]:
        return iter(self.families)

    def __repr__(self) -> str:
        return f"Families({len(self)} of {counted(len(self.objects), 'object')}, paths={len(self.family_of_path)})"


def check_objects(scene, objects) -> None:
    """Raises what `families` would for `objects` of a scene: to know before a long trace."""
    named = named_globs(objects)
    if named is not None:
        _core.check_objects(scene, named)


@checked(objects=objects_rule)
def families(paths: _core.Paths, objects: Objects = None) -> Families:
    """Which object each path belongs to, and which ghost it makes, after the Radar Ghost Dataset (Kraus et al. 2021).

    A path belongs to the first of the objects, in their order here and not on its way, that it touches; what else it touches
    has mirrored it. Hits that follow each other on one object are one bounce: an echo that touches nothing else is real,
    whatever its number of hits. What mirrored is named by the child of the scene's root, or below one that holds objects or
    several mirrors by the largest group that does not, so that the walls of a street are told apart.
    paths: of `trace`
    objects: {name: glob or list of globs}, or a list of globs, which are then the names; None: the children of the scene's
        root that are neither flagged mirrors, with what `mark_mirrors` cuts from them, nor around the antenna at mid-frame, in a
        `Sequence` at that of its first frame.
        Around it is what it stands in or on, within 0.5 m of the box along the own axes, unless all of it is ahead of the
        transmitters' boresight by more than 5 cm, as a person close by is; and what is flat, as a wall or a
        road, and so wide that its bounding sphere holds the antenna; `find_objects` names what stands in a town that is
        one child
    Returns Families: a family index [P], and of each family object, ghost type, order, surfaces and class code. Raises
    ValueError for bad names and globs that take no mesh.
    """
    names, found, family_of_path, grouping = _core.find_families(paths, named_globs(objects))
    return Families(tuple(names), tuple(found), family_of_path, grouping)
