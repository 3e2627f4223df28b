"""Selections of paths in Python: the words that the text of a Selection has, too."""
from __future__ import annotations

from .. import _core
from .._core import num_bounces, power
from ..arguments.checks import checked, text

__all__ = ["first", "hits", "last", "num_bounces", "passes", "power"]


@checked(glob=text)
def hits(glob: str) -> _core.Selection:
    """Selection of the paths with at least one hit on a mesh that the glob takes, as in T .* 'glob' .* R.

    glob: of mesh names. Raises TypeError or ValueError naming the argument.
    """
    return _core.hits(glob)


@checked(glob=text)
def first(glob: str) -> _core.Selection:
    """Selection of the paths whose first hit is on a mesh that the glob takes, as in T 'glob' .* R.

    glob: of mesh names. Raises TypeError or ValueError naming the argument.
    """
    return _core.first(glob)


@checked(glob=text)
def last(glob: str) -> _core.Selection:
    """Selection of the paths whose last hit is on a mesh that the glob takes, as in T .* 'glob' R.

    glob: of mesh names. Raises TypeError or ValueError naming the argument.
    """
    return _core.last(glob)


@checked(glob=text)
def passes(glob: str) -> _core.Selection:
    """Selection of the paths that go through a sheet that the glob takes, as in T .* P'glob' .* R.

    glob: of mesh names. Raises TypeError or ValueError naming the argument.
    """
    _core.hits(glob)  # raises for what cannot stand in quotes
    return _core.Selection(f"T .* P'{glob}' .* R")
