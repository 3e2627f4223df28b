"""Lists that are cut off in reports."""
from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..base.text.counts import named


def strongest(powers: Sequence[float], visible_shares: Sequence[float], count: int) -> list[int]:
    """Indices of the `count` strongest in ascending order, as the rows of a list that is cut off; all where there are fewer.

    visible_shares: by which objects without power are told apart
    """
    order = np.lexsort((-np.asarray(visible_shares, float), -np.asarray(powers, float)))
    return sorted(order[:count].tolist())


def more_line(count: int, shown: int, thing: str = "", indent: int = 4) -> list[str]:
    """The line behind the first `shown` of `count` rows that tells how many more there are; none where all are shown.

    thing: the word for one of them, "node"; indent: columns
    """
    left = count - shown
    return [f"{' ' * indent}and {left:,} more" + (f" {named(left, thing)}" if thing else "")] if left > 0 else []
