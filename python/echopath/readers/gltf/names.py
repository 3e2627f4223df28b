"""Names of files made fit for a scene."""
from __future__ import annotations

LONGEST = 64
UNFIT = frozenset("/*?'\"\x1e\x1f\x7f")


def fit_name(name: str, otherwise: str) -> str:
    """A name that a scene takes: signs that it refuses become '_', long ones are cut; `otherwise` where nothing is left."""
    name = "".join("_" if sign in UNFIT or ord(sign) < 32 or 0xD800 <= ord(sign) < 0xE000 else sign for sign in name[:LONGEST])
    return name.strip() or otherwise


def unique(name: str, taken: dict[str, int]) -> str:
    """The name, with a number where it is taken; takes it."""
    made = name
    while made in taken:
        taken[name] += 1
        made = f"{name}_{taken[name]}"
    taken[made] = 1
    return made
