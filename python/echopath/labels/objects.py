"""What a map shows of each object of the scene, and of its ghosts."""
from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .. import _core
from ..paths.resolution import Interval, Unmet
from .labels import COMES_INTO_VIEW, NONE, UNRESOLVED, GhostLabel, ObjectLabel, is_occluded

_MOST_NUMBERED = np.iinfo(np.int16).max + 1  # labels, from 0 on, in the maps of objects and ghosts


class FamilyCells(NamedTuple):
    """The cells of all families: list of Family; received: power of each, [F] W; regions: of each, dict or None;

    strongest: i32 [V, R], index of the family that a cell belongs to, -1: none; is_above_noise: [F] whether the family's
    own power is above the noise in some cell; peak: W, of each in its strongest cell, [F]; intervals: of each, list [F] of
    Interval in W; of_object: {object: indices of its families}; noise_floor: W, that echoes must exceed to stand out.
    """

    families: list
    received: list
    regions: list
    strongest: np.ndarray
    is_above_noise: list
    peak: list
    intervals: list
    of_object: dict
    noise_floor: float


def family_cells(owners, mask, noise_floor: float, plane, intervals: dict) -> FamilyCells:
    """owners: CellOwners; mask: bool [V, R]; noise_floor in W; intervals: {family: Interval}."""
    families = owners.families
    strongest, of_object = np.where(mask, owners.family, NONE), {}
    for number, family in enumerate(families):
        of_object.setdefault(family.object, []).append(number)
    return FamilyCells(families=families, received=owners.received.tolist(),
                       regions=_regions(strongest, owners.own, len(families), plane.rows_wrap),
                       strongest=strongest, is_above_noise=(owners.peak > noise_floor).tolist(), peak=owners.peak.tolist(),
                       intervals=[intervals.get(family) for family in families], of_object=of_object,
                       noise_floor=noise_floor)


def _regions(strongest, own, count: int, rows_wrap: bool) -> list:
    """Cells of each of `count` families, dict or None. The core numbers those that have cells alone, in 16 bits."""
    present = np.unique(strongest[strongest != NONE])
    numbers = np.where(strongest == NONE, NONE, np.searchsorted(present, strongest)).astype(np.int16)
    regions = [None] * count
    for family, region in zip(present.tolist(), _core.label_regions(numbers, own, len(present), rows_wrap)):
        regions[family] = region
    return regions


def occluded_objects(names, found: FamilyCells, visibility: dict, plane) -> list:
    """Names of the objects of which nothing but what hides them at the time of the trace explains that they have no cells."""
    return [name for name in names if _status_of(name, found, visibility[name], False, plane, None) == "occluded"]


def label_objects(names, found: FamilyCells, visibility: dict, appearing, plane, paths):
    """The labels of the objects and i16 [V, R], index of the object in each cell, -1: none.

    names: of the objects; visibility: {name: ObjectVisibility} at the time of the trace; appearing: names of those that are
    hidden then, but not throughout the frame; paths: of the trace, with the radar that is to receive them
    """
    labels, chosen = [], {}
    unmet = Unmet(paths) if paths.num_paths == paths.frame.statistics.num_paths else None
    for index, name in enumerate(names):
        real, _ = _families_of(name, found)
        if real is not None:
            chosen[real] = index
        labels.append(_object_label(name, real, found, visibility[name], name in appearing, plane, unmet))
    return labels, _map_of(found, chosen)


def _families_of(name: str, found: FamilyCells):
    """(index of the family of direct echoes of an object or None, indices of all its families)."""
    mine = found.of_object.get(name, [])
    return next((f for f in mine if not found.families[f].is_ghost), None), mine


def label_ghosts(found: FamilyCells, plane):
    """The labels of the ghosts and i16 [V, R], index of the ghost in each cell, -1: none.

    Ghosts are in the order of the families; those with cells go first where there are more than the map can number.
    """
    ghosts = [f for f, family in enumerate(found.families) if family.is_ghost]
    if len(ghosts) > _MOST_NUMBERED:
        ghosts.sort(key=lambda f: found.regions[f] is None)
    labels = []
    for f in ghosts:
        family = found.families[f]
        labels.append(GhostLabel(object=family.object, ghost_type=family.ghost_type, order=family.order, via=family.via,
                                 class_code=family.class_code, power=found.received[f], received=found.intervals[f],
                                 **_cells(found.regions[f], plane)))
    return labels, _map_of(found, {f: index for index, f in enumerate(ghosts) if found.regions[f] is not None})


def _object_label(name, real, found: FamilyCells, seen, appears: bool, plane, unmet: Unmet | None) -> ObjectLabel:
    """unmet: of the paths; None where the record leaves paths out, which tells nothing of objects without any"""
    region = None if real is None else found.regions[real]
    received = found.intervals[real] if real is not None else unmet and unmet.interval(seen)
    return ObjectLabel(name=name, status=_status_of(name, found, seen, appears, plane, received),
                       power=0.0 if real is None else found.received[real], visible_share=seen.visible_share,
                       occluders=dict(seen.occluders), **_cells(region, plane), received=received)


def _status_of(name: str, found: FamilyCells, seen, appears: bool, plane, received: Interval | None) -> str:
    """Why there are cells of an object, or why there are none; the first that holds (labels.ObjectLabel).

    received: of its direct echoes
    """
    real, mine = _families_of(name, found)
    is_above_noise = real is not None and found.is_above_noise[real]
    reasons = {"seen": real is not None and found.regions[real] is not None,
               "ghosts only": any(found.regions[f] is not None for f in mine if f != real),
               "outside the map": not seen.in_view or seen.distance > plane.range[-1],
               "masked": is_above_noise,
               COMES_INTO_VIEW: appears,
               "occluded": is_occluded(seen),
               UNRESOLVED: received is not None and _may_stand_out(real, found, received),
               "hidden in noise": real is not None and found.received[real] > 0.0}
    return next((status for status, holds in reasons.items() if holds), "not seen")


def _may_stand_out(real: int | None, found: FamilyCells, received: Interval) -> bool:
    """Whether direct echoes may be above the noise, as far as the rays know. real: index of their family, None: no paths"""
    return received.is_in_doubt and _most_in_a_cell(real, found, received) > found.noise_floor


def _most_in_a_cell(real: int | None, found: FamilyCells, received: Interval) -> float:
    """W, of direct echoes at the upper end of their interval: spread over cells as those of their paths, or in one cell.

    A cell has the mean power of what is in it alone; echoes that the map had no need to show have no peak.
    """
    if real is None or not found.peak[real] > 0.0:
        return received.high
    return found.peak[real] / found.received[real] * received.high


def _cells(region, plane) -> dict:
    """The fields of a label that tell of its cells."""
    if region is None:
        return {"cells": 0, "peak": None, "box": None}
    row, column, power = region["peak"]
    ranges = (float(plane.range[i]) for i in region["columns"])
    rows = (float(plane.rows[i]) for i in region["rows"])
    return {"cells": region["cells"], "peak": plane.make_peak(float(plane.range[column]), float(plane.rows[row]), power),
            "box": plane.make_box(*ranges, *rows)}


def _map_of(found: FamilyCells, index_of: dict):
    """i16 [V, R] from {family: index}."""
    table = np.full(len(found.families) + 1, NONE, np.int16)  # the last one for cells of no family
    for family, index in index_of.items():
        table[family] = index
    return table[found.strongest]
