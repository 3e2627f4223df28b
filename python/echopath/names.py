"""Names in sentences."""
from __future__ import annotations

from collections.abc import Iterable

MOST_NAMES = 3


def first_names(names: Iterable[str]) -> str:
    """The first of some names, each once, with dots where there are more."""
    each = list(dict.fromkeys(names))
    return ", ".join(each[:MOST_NAMES]) + (", ..." if len(each) > MOST_NAMES else "")
