"""What labels leave out."""
from __future__ import annotations

from typing import NamedTuple


class LeftOut(NamedTuple):
    """Families of paths whose signals were not made for labels, because none of them can own a cell.

    families: how many that have some power; power: W, the sum of their mean received powers
    bound: W, what the strongest of them can show in a cell at most
    """

    families: int
    power: float
    bound: float
