"""How all views of a scene look: colours, lines and numbers of axes."""
from __future__ import annotations

import numpy as np

from ..style import BOUNCE_COLOURS

MIRROR_COLOUR = (0.55, 0.65, 0.80)
TITLE_PAD = 6.0                         # points between axes and title
DASHES = (0, (4, 3))


def colour_of(count: int) -> str:
    return BOUNCE_COLOURS[min(count, len(BOUNCE_COLOURS)) - 1]


def ray_opacity(segments) -> float:
    return float(np.clip(40.0 / max(1, len(segments)), 0.12, 0.8))


def of_equal_length(polygons) -> np.ndarray:
    """Polygons [N, K, D], which end with their last corner as often as the longest has more: Matplotlib takes an array at
    once, but a list one by one."""
    if not polygons:
        return np.empty((0, 3, 3))
    counts, starts = counted(polygons)
    return np.concatenate(polygons)[starts[:, None] + np.minimum(np.arange(counts.max()), counts[:, None] - 1)]


def counted(polygons) -> tuple:
    """Number of corners of each polygon [N], and the place of its first among those of all [N]."""
    counts = np.array([len(polygon) for polygon in polygons], int)
    return counts, np.cumsum(counts) - counts


def set_ticks(axis, count: int) -> None:
    """Gives an axis so many round numbers at the most, and no more than eight."""
    from matplotlib.ticker import MaxNLocator

    axis.set_major_locator(MaxNLocator(nbins=min(max(count, 1), 8), steps=(1, 2, 5, 10), min_n_ticks=1 if count < 2 else 2))
