"""Numbers in words: of one thing and of several, and in warnings so coarse that frames in a row do not say the same in many
ways, as Python shows each text once."""
from __future__ import annotations

_LONG_ENDS = ("s", "x", "sh", "ch")


def counted(count: int, thing: str) -> str:
    """A count with the word for one thing or for several: "1 mesh", "2 meshes", "1,000 rays"."""
    return f"{count:,} {named(count, thing)}"


def named(count: int, thing: str) -> str:
    """The word for one thing, or for several: "mesh", "meshes"."""
    if count == 1:
        return thing
    if thing.endswith("vertex"):
        return f"{thing[:-2]}ices"
    return f"{thing}es" if thing.endswith(_LONG_ENDS) else f"{thing}s"


def at_least(count: int) -> str:
    """The largest of 1, 2, 5, 10, 20, 50 and so on that a count of 1 or more reaches: "at least 20"."""
    decade = 10 ** (len(str(count)) - 1)
    step = max(times for times in (1, 2, 5) if times * decade <= count)
    return f"at least {step * decade:,}"


def rounded(number: float) -> int:
    """To one digit."""
    return int(float(f"{number:.0e}"))
