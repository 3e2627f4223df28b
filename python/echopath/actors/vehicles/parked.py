"""Rows of parked cars."""
from __future__ import annotations

from dataclasses import replace
from functools import partial

import numpy as np

from ... import _core
from ...arguments.checks import checked, count, real, seed as seed_rule
from ...base.classes.made_once import MadeOnce
from ..actor import Actor
from ..limits import LONGEST_ROW
from .cars import CARS, car

CLOSEST = 2.3  # m from middle to middle, so that mirrors do not meet
SHARES = {"small": 0.2, "compact": 0.3, "saloon": 0.15, "estate": 0.15, "suv": 0.2}   # of the classes


@checked(number=count(1, 100), spacing=real(CLOSEST, LONGEST_ROW, unit="m"), seed=seed_rule)
def parked_row(*, number: int = 5, spacing: float = 2.5, seed: int = 1) -> Actor:
    """Cars of mixed classes side by side along y, as in a car park; they face along +x or -x.

    The middle of the row is at the origin. Parts: those of `car` under car_1/, car_2/ and so on, from right to left.
    number: of cars. spacing: m from one to the next, at least 2.3 so that their mirrors do not meet. seed: of the classes,
    directions and small differences in place.
    Returns an Actor. Raises TypeError or ValueError naming the argument.
    """
    random = np.random.default_rng(seed)
    parts, made = [], {}
    for n in range(number):
        kind = str(random.choice(list(CARS), p=[SHARES[name] for name in CARS]))
        made.setdefault(kind, car(kind=kind))
        turn = 1.0 if random.random() < 0.5 else -1.0
        place = np.array([random.normal(0.0, 0.12), (n - 0.5 * (number - 1)) * spacing + random.uniform(-0.06, 0.06), 0.0])
        parts += _placed(made[kind].parts, f"car_{n + 1}", place, turn * _about_z(np.radians(random.normal(0.0, 1.0)), turn))
    return Actor(parts)


def _about_z(angle, sign):
    """A turn about z [3, 3], whose x and y axes `sign` reverses."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, sign]])


def _placed(parts, group, place, rotation):
    """Parts at rest at another place; those of one surface stay parts of one."""
    def placed(mesh, position):
        return _core.Mesh((np.asarray(mesh.vertices) + position) @ rotation.T + place, mesh.triangles)

    wholes, moved = MadeOnce(), []
    for part in parts:
        mesh = wholes.of(part.mesh.whole or part.mesh, partial(placed, position=part.position), tuple(part.position))
        if part.mesh.whole is not None:
            mesh = mesh.part(part.mesh.whole_triangle)
        moved.append(replace(part, name=f"{group}/{part.name}", mesh=mesh, position=(0.0, 0.0, 0.0)))
    return moved
