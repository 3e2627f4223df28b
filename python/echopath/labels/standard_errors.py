"""How well the rays know the powers of parts in cells, from batches of rays (cpp/echopath/label/cells/cell_errors.h)."""
from __future__ import annotations

import numpy as np

from .. import _core
from .powers import decomposed

IMAGES = (None, "coherent")  # key of the paths that belong to every batch


class BatchSums:
    """Sums of batches of all parts: cross, coherent and diffuse powers [K, B, V, R] in W, mean over the channels.

    Powers of sums and differences of fields give the products, so that any map of mean powers will do.
    """

    def __init__(self, part_names, num_batches: int, plane):
        self._names, self._num_batches, self._plane = part_names, num_batches, plane
        shape = (len(part_names), num_batches, len(plane.rows), len(plane.range))
        self.cross, self.coherent, self.diffuse = np.zeros(shape), np.zeros(shape), np.zeros(shape)

    def add(self, cubes: dict, radar, weight: float) -> None:
        """cubes: {(part, (batch, "coherent" or "diffuse")): cube}; weight: of these receivers."""
        for index, name in enumerate(self._names):
            of_part = {key: cube for (part, key), cube in cubes.items() if part == name}
            self._add_diffuse(index, of_part, radar, weight)
            if any(kind == "coherent" for _, kind in of_part):
                self._add_coherent(index, of_part, radar, weight)

    def _add_diffuse(self, index: int, cubes: dict, radar, weight: float) -> None:
        for batch in range(self._num_batches):
            if (batch, "diffuse") in cubes:
                power = self._plane.power(cubes[batch, "diffuse"], radar)
                self.diffuse[index, batch] += weight * self._num_batches * power

    def _add_coherent(self, index: int, cubes: dict, radar, weight: float) -> None:
        coherent = [cube for (_, kind), cube in cubes.items() if kind == "coherent"]
        mean, nothing = sum(coherent), np.zeros_like(coherent[0])
        mean_power = self._plane.power(mean, radar)
        images = cubes.get(IMAGES, nothing)
        for batch in range(self._num_batches):
            field = self._num_batches * cubes.get((batch, "coherent"), nothing) + images
            power = self._plane.power(field, radar)
            apart = self._plane.power(field - mean, radar)
            self.coherent[index, batch] += weight * power
            self.cross[index, batch] += weight * 0.5 * (mean_power + power - apart)


def require_batches(num_batches: int) -> None:
    """Raises ValueError where there is nothing to make errors from."""
    if num_batches < 2:
        raise ValueError("errors: need 2 independent batches of rays at least, as batches=8 of the trace and --batches 8 of "
                         "`echopath run` make them, got a trace with one")


def share_errors(labels, work, selections: dict, known: dict):
    """(mean_power, power_error, mean_share, share_error [K, V, R], certain [V, R]) of the parts of a partition.

    labels: of the partition; work: Labelling; selections: {name: selection}; known: {part: power [V, R] in W} of those that no
    path makes, which have no error.
    """
    paths, part_names = work.paths, labels.part_names
    radar, plane = work.request.radar, work.request.plane
    num_batches = paths.frame.num_batches
    grouping = _core.Grouping
    view = grouping.all_of([grouping.selections(list(selections.items())), grouping.batches()])
    sums = BatchSums(part_names, num_batches, plane)
    num_parts = len(part_names) * (2 * num_batches + 1)
    for cube_set in decomposed(paths, radar, {"batches": view}, num_parts, plane, work.settings):
        sums.add(cube_set.views["batches"], cube_set.radar, cube_set.weight)
    for name, power in known.items():
        sums.diffuse[part_names.index(name)] = power
    return _core.share_errors(sums.cross, sums.coherent, sums.diffuse, labels.dominant)
