"""Tables of TOML files with mistakes: other values, keys and shapes."""
from __future__ import annotations

import datetime
import pickle
from random import Random

VALUES = [0, 1, -1, 2, 3, 64, 65, 1000, 10**9, 2**31, 2**63 - 1, 2**63, -2**63, 10**30, 0.0, -0.1, 0.5, 1.0, 1e-320, 1e9, 1e19,
          1e308, -1e308, float("nan"), float("inf"), -float("inf"), True, False, "", "x", "\0", "auto", "wall", "wall/ball",
          "wall*", "metal", "T . R", "T (.{64}){64} R", "../wall.obj", "wall.obj", "antenna.csv", "a" * 300, "\u2028", [], {},
          [[]], [0.0, 0.0, 0.0], [0, 0, 0], [5, -0.1], [1e300, 0, 0], [1.0] * 4, [[1.0] * 4] * 4, ["x"], [1, "x"],
          {"kind": "linear"}, {"kind": "isotropic"}, {"permittivity": 3.0}, datetime.date(1979, 5, 27), datetime.time(7, 32)]


class Tables:
    """Seeds, and what stands in them: {key: values} of all their tables."""

    def __init__(self, seeds: list[dict]):
        self._seeds = [(pickle.dumps(seed), _routes(seed)) for seed in seeds]
        self._keys: dict[str, list] = {}
        for seed in seeds:
            for holder, key in _places(seed):
                if isinstance(holder, dict):
                    self._keys.setdefault(key, []).append(pickle.dumps(holder[key]))

    def mistaken(self, random: Random) -> dict:
        """A seed with one to four mistakes."""
        seed, routes = random.choice(self._seeds)
        table = pickle.loads(seed)
        self._mistake(*_follow(table, random.choice(routes)), random)
        for _ in range(random.choice((0, 0, 0, 1, 3))):
            if table:
                self._mistake(*random.choice(_places(table)), random)
        return table

    def _mistake(self, holder, key, random: Random) -> None:
        kind = random.randrange(10)
        if kind <= 3:
            holder[key] = _copy(random.choice(VALUES))
        elif kind == 4:
            holder[key] = self._known(random.choice(list(self._keys)), random)
        elif kind == 5:
            del holder[key]
        elif isinstance(holder, list):
            holder.insert(key, _copy(holder[random.randrange(len(holder))]))
        elif kind == 6:
            holder[_misspelt(key, random)] = holder.pop(key)
        elif kind == 7:
            name = random.choice(list(self._keys))
            holder[name] = self._known(name, random)
        else:
            holder[key] = self._known(key, random) if key in self._keys else _near(holder[key], random)

    def _known(self, key: str, random: Random):
        """A value that stands at a key in some seed."""
        return pickle.loads(random.choice(self._keys[key]))


def _places(item) -> list[tuple]:
    """(table or list, key or index) of whatever stands in an item."""
    places, left = [], [item]
    while left:
        holder = left.pop()
        keys = list(holder) if isinstance(holder, dict) else range(len(holder))
        places += [(holder, key) for key in keys]
        left += [holder[key] for key in keys if isinstance(holder[key], (dict, list))]
    return places


def _routes(item, before: tuple = ()) -> list[tuple]:
    """The keys and indices that lead to whatever stands in an item: `_places` of a copy yet to be made."""
    routes = []
    for key in item if isinstance(item, dict) else range(len(item)):
        routes.append((*before, key))
        if isinstance(item[key], (dict, list)):
            routes += _routes(item[key], routes[-1])
    return routes


def _follow(item, route: tuple) -> tuple:
    """The (table or list, key or index) that a route leads to."""
    for key in route[:-1]:
        item = item[key]
    return item, route[-1]


def _copy(value):
    return pickle.loads(pickle.dumps(value)) if isinstance(value, (dict, list)) else value


def _misspelt(key: str, random: Random) -> str:
    at = random.randrange(len(key) + 1)
    added = key[:at] + chr(random.randrange(32, 0x300)) + key[at:]
    return random.choice((key[:at] + key[at + 1:], added, key.upper(), "", key * 40))


def _near(value, random: Random):
    """A number changed a little or much, and a text by a letter."""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        whole = int(min(max(value, -1e15), 1e15)) if value == value else 0  # NaN has none
        return random.choice((-value, value + 1, value * 1e-9, value * 1e9, float(value), whole))
    return _misspelt(value, random) if isinstance(value, str) else random.choice(VALUES)
