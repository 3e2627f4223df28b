"""Numbers in warnings, so coarse that frames in a row do not say the same in many ways: Python shows each text once."""
from __future__ import annotations


def at_least(count: int) -> str:
    """The largest of 1, 2, 5, 10, 20, 50 and so on that a count of 1 or more reaches: "at least 20"."""
    decade = 10 ** (len(str(count)) - 1)
    step = max(times for times in (1, 2, 5) if times * decade <= count)
    return f"at least {step * decade:,}"


def rounded(number: float) -> int:
    """To one digit."""
    return int(float(f"{number:.0e}"))
