"""Values of a template that are drawn anew for each scene."""
from __future__ import annotations

import difflib
import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ...arguments.shown import shown

_MORE = {"choice": {"weights"}, "normal": {"within"}}  # keys that may stand beside that of a kind
REFERENCE = "same_as"                              # a table with this key follows another value (references.py)
MOST = 1e300                                       # of a number, so that nothing that is drawn of it overflows
_BEYOND = 2**63                                    # whole numbers of 64 bits
_MOST_TRIES = 10_000                                   # of a normal distribution that is to lie within limits


def is_distribution(value: Any) -> bool:
    """Whether a value of a template is to be drawn: a table such as {uniform = [1, 2]}."""
    if not isinstance(value, dict):
        return False
    kinds = [kind for kind in KINDS if isinstance(value.get(kind), list)]
    return len(kinds) == 1 and value.keys() <= {kinds[0]} | _MORE.get(kinds[0], set())


def refuse_misspelt(table: dict[str, Any], place: str) -> None:
    """Raises ValueError naming the key of a table that was to be a distribution, and what it must be.

    table: of a template, no distribution; place: its dotted path. Tables whose lists are named otherwise are those of a scene.
    """
    known = [kind for kind in KINDS if kind in table]
    lists = [key for key, value in table.items() if isinstance(value, list)]
    near = {key: difflib.get_close_matches(key.lower(), KINDS, n=1, cutoff=0.7) for key in lists}
    if len(known) > 1:
        raise ValueError(f"{place}: must be one distribution, got {' and '.join(known)}")
    if known and not isinstance(table[known[0]], list):
        raise ValueError(f"{place}.{known[0]}: must be a list, got {shown(table[known[0]])}")
    if known:
        allowed = {known[0]} | _MORE.get(known[0], set())
        word = next(key for key in table if key not in allowed)
        raise ValueError(f"{place}.{word}: unknown key of a distribution; {known[0]} takes {', '.join(sorted(allowed))}")
    words = [key for key, value in table.items() if isinstance(value, str)]
    near |= {key: difflib.get_close_matches(key.lower(), [REFERENCE], n=1, cutoff=0.7) for key in words if len(table) == 1}
    for key, meant in near.items():
        if meant and table.keys() - {key} <= _MORE.get(meant[0], set()):
            raise ValueError(f"{place}.{key}: unknown distribution; did you mean '{meant[0]}'?")


def with_kinds(line: str) -> str:
    """A line of a fault of a drawn scene; where a table stands for a number, with the names of the distributions."""
    return f"{line}; distributions are {', '.join([*KINDS, REFERENCE])}" if "must be a number, got {" in line else line


def drawn(table: dict[str, Any], place: str, random: np.random.Generator) -> Any:
    """A value of the distribution of a table; place: its dotted path. Raises ValueError naming it for wrong parameters."""
    kind = next(kind for kind in KINDS if kind in table)
    return KINDS[kind](table, f"{place}.{kind}", random)


def is_number(value: Any) -> bool:
    """Whether a value is a number that can be computed with: none of NaN, of infinities and of whole numbers beyond MOST."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) <= MOST


def _pair(values: Any, place: str, rule: str, holds: Callable[[float, float], bool]) -> tuple[float, float]:
    if not isinstance(values, list) or len(values) != 2 or not all(map(is_number, values)) or not holds(*values):
        raise ValueError(f"{place}: must be {rule}, got {shown(values)}")
    return values[0], values[1]


def _ascending(low: float, high: float) -> bool:
    return low <= high


def _uniform(table: dict[str, Any], place: str, random: np.random.Generator) -> float:
    low, high = _pair(table["uniform"], place, "[lowest, highest]", _ascending)
    return float(low + (high - low) * random.random())


def _log_uniform(table: dict[str, Any], place: str, random: np.random.Generator) -> float:
    low, high = _pair(table["log_uniform"], place, "[lowest, highest], both above 0",
                      lambda low, high: 0.0 < low <= high and high / low < math.inf)
    return float(low * (high / low) ** random.random())


def _normal(table: dict[str, Any], place: str, random: np.random.Generator) -> float:
    mean, deviation = _pair(table["normal"], place, "[mean, standard deviation]", lambda _, deviation: deviation >= 0.0)
    within = place.removesuffix("normal") + "within"
    low, high = _pair(table.get("within", [-MOST, MOST]), within, "[lowest, highest]", _ascending)
    for _ in range(_MOST_TRIES):
        value = float(mean + deviation * random.standard_normal())
        if low <= value <= high:
            return value
    rule = f"a distribution with a good share of its values within {shown([low, high])}"
    raise ValueError(f"{place}: must be {rule}, got {shown([mean, deviation])}")


def _integer(table: dict[str, Any], place: str, random: np.random.Generator) -> int:
    low, high = _pair(table["integer"], place, "[lowest, highest], whole numbers, both included",
                      lambda low, high: -_BEYOND <= low <= high < _BEYOND and low == int(low) and high == int(high))
    return int(random.integers(int(low), int(high), endpoint=True))


def _choice(table: dict[str, Any], place: str, random: np.random.Generator) -> Any:
    values, weights = table["choice"], table.get("weights")
    if not values:
        raise ValueError(f"{place}: must have at least one value, got []")
    if weights is None:
        weights = [1.0] * len(values)
    if not isinstance(weights, list) or len(weights) != len(values) or not all(map(_is_weight, weights)) or not any(weights):
        rule = f"{len(values)} numbers of at least 0, not all of them 0"
        raise ValueError(f"{place.removesuffix('choice')}weights: must be {rule}, got {shown(weights)}")
    shares = np.cumsum(weights, dtype=float) / np.sum(weights, dtype=float)
    return values[int(np.searchsorted(shares, random.random(), side="right"))]


def _is_weight(value: Any) -> bool:
    return is_number(value) and value >= 0.0


KINDS: dict[str, Callable[[dict[str, Any], str, np.random.Generator], Any]] = {
    "uniform": _uniform, "log_uniform": _log_uniform, "normal": _normal, "integer": _integer, "choice": _choice}
