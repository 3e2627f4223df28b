"""The step of the golden ratio, whose multiples spread evenly over [0, 1) however many there are."""
from __future__ import annotations

GOLDEN_STEP = 0.5 * (5.0 ** 0.5 - 1.0)  # the golden ratio less one


def golden_place(number: int, first: float = 0.0) -> float:
    """Place `number` in [0, 1), counted from the place `first`."""
    return (first + number * GOLDEN_STEP) % 1.0
