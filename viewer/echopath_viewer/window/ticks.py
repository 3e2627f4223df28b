"""Round numbers along an axis."""
from __future__ import annotations

import math


def nice_ticks(low: float, high: float, max_count: float) -> list[float]:
    """Multiples of 1, 2 or 5 times a power of ten in [low, high], about `max_count` at most."""
    span = high - low
    if not span > 0.0 or max_count < 1.0:
        return []
    rough = span / max_count
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= rough * (1.0 - 1e-9))
    first = math.ceil(low / step - 1e-9)
    return [step * number for number in range(first, math.floor(high / step + 1e-9) + 1)]


def tick_text(value: float) -> str:
    """Without the noise of binary fractions."""
    return f"{round(value, 9) + 0.0:g}"
