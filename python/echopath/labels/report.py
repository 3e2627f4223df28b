"""Labels in words."""
from __future__ import annotations

import numpy as np

from ..base.numerics.decibels import in_dbm
from ..base.text.counts import counted, named
from ..paths.visibility import occluder_words

LEAST_POWER = 1e-33  # W: what is weaker, as what rounding leaves of an echo, is told as that


def text_of(labels) -> str:
    """A table of the parts, objects and ghosts of Labels, with the cells that each has and its peak."""
    rows = [_header(labels), *_parts(labels), *(f"object {object_words(label)}" for label in labels.objects),
            *(f"ghost  {ghost_words(ghost)}" for ghost in _with_cells(labels))]
    hidden = len(labels.ghosts) - len(_with_cells(labels))
    rows += [f"{hidden:,} more {named(hidden, 'ghost')} {'have' if hidden > 1 else 'has'} no cells"] if hidden else []
    rows += _left_out(labels.left_out)
    return "\n".join(rows)


def _left_out(left_out) -> list[str]:
    """What was left out of the signals."""
    if left_out is None or not left_out.families:
        return []
    several = left_out.families > 1
    words = "families can own no cell and have no signals of their own" if several else (
        "family can own no cell and has no signal of its own")
    below = "" if left_out.power >= LEAST_POWER else "below "
    level, bound = in_dbm(left_out.power, LEAST_POWER), in_dbm(left_out.bound, LEAST_POWER)
    return [f"{left_out.families} {words}: {below}{level:.0f} dBm{' together' if several else ''}, at most {bound:.0f} dBm "
            "in a cell"]


def _header(labels) -> str:
    rows, columns = labels.shape
    above, labelled = np.count_nonzero(labels.above_noise), np.count_nonzero(labels.mask)
    certain = "" if labels.certain is None else f", {np.count_nonzero(labels.certain)} of them certain"
    return (f"{labels.plane.replace('_', '-')} map of {rows} x {counted(columns, 'cell')}: {above} above the noise, "
            f"{labelled} labelled{certain}")


def _parts(labels) -> list[str]:
    counts = np.bincount(labels.dominant[labels.mask].astype(np.int64), minlength=len(labels.part_names))
    return [f"part   {name}: {cell_words(count)}" for name, count in zip(labels.part_names, counts)]


def cell_words(count) -> str:
    """1 cell, 2 cells."""
    return counted(count, "cell")


def object_words(label) -> str:
    """What a map shows of one object, in a line."""
    return f"{label.name}: {label.status}{_occluders(label)}{_cells(label)}{_resolution(label)}"


def _occluders(label) -> str:
    hidden = occluder_words(label.occluders)
    return f", hidden by {hidden}" if hidden else ""


def _with_cells(labels) -> list:
    return [ghost for ghost in labels.ghosts if ghost.cells]


def ghost_words(label) -> str:
    """What a map shows of one ghost, in a line."""
    way = f"type {label.ghost_type}, order {label.order}, via {', '.join(label.via)}"
    return f"{label.object}: {way}{_cells(label)}{_resolution(label)}"


def _resolution(label) -> str:
    """Of a power that the rays do not know, its interval."""
    return f", NOT resolved ({label.received})" if label.received and label.received.is_in_doubt else ""


def _cells(label) -> str:
    if label.peak is None:
        return ""
    return f", {cell_words(label.cells)}, peak {peak_words(label.peak)} {in_dbm(label.peak.power):.0f} dBm"


def peak_words(peak, width: int = 0) -> str:
    """Where the peak of a label lies, in m and m/s or degrees; each number at least `width` characters wide."""
    distance, row, _ = peak
    if hasattr(peak, "velocity"):
        return f"{distance:{width}.2f} m {row:+z{width}.2f} m/s"
    return f"{distance:{width}.2f} m {np.degrees(row):+z{width}.1f} deg"
