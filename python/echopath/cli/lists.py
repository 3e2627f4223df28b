"""Lists that are cut off in reports."""
from __future__ import annotations

from ..base.counts import named


def more_line(count: int, shown: int, thing: str = "", indent: int = 4) -> list[str]:
    """The line behind the first `shown` of `count` rows that tells how many more there are; none where all are shown.

    thing: the word for one of them, "node"; indent: columns
    """
    left = count - shown
    return [f"{' ' * indent}and {left:,} more" + (f" {named(left, thing)}" if thing else "")] if left > 0 else []
