"""Lists that are cut off in reports."""
from __future__ import annotations


def more_line(count: int, shown: int, what: str = "") -> list[str]:
    """The line behind the first `shown` of `count` rows that tells how many more there are; none where all are shown.

    what: they are, " nodes"
    """
    return [f"    and {count - shown:,} more{what}"] if count > shown else []
