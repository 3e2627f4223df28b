"""Names in sentences."""
from __future__ import annotations

from collections.abc import Sequence

MOST_NAMES = 3


def first_names(names: Sequence[str], count: int | None = None) -> str:
    """The first of some names, and how many more there are of `count` in all; None: `names` are all."""
    more = (len(names) if count is None else count) - min(MOST_NAMES, len(names))
    return ", ".join(names[:MOST_NAMES]) + (f" and {more} more" if more > 0 else "")
