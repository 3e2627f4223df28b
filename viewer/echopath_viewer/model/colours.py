"""Colours of rays and meshes, and what they mean."""
from __future__ import annotations

import dataclasses
from collections import Counter

import numpy as np

from echopath.base.text.mesh_names import object_of
from echopath.plots.style import BOUNCE_COLOURS

from .palette import rgb_of

COLOUR_MODES = ("bounces", "mesh", "power", "range", "speed")
POWER_SPAN_DB = 40.0  # below the strongest ray, where no limits are given
LEAST_SPAN = 1e-3     # m and m/s, of the scales of range and speed: what differs by less has one colour
MAX_LEGEND_ROWS = 12
_SCALES = {"power": ("Power in dBm", "viridis"), "range": ("Range in m", "viridis"),
           "speed": ("Radial speed in m/s (away: +)", "coolwarm")}


@dataclasses.dataclass(frozen=True)
class Legend:
    """What colours mean: either `rows` [(label, (r, g, b))] or a scale `clim` (low, high) in the unit of `title`.

    cmap: of the scale, a matplotlib colour map or the name of one; num_more: rows that are left out
    """

    title: str
    rows: tuple = ()
    clim: tuple | None = None
    cmap: object = ""
    num_more: int = 0

    def texts(self) -> list[str]:
        """The lines below the title, of which the first have colours."""
        return [label for label, _ in self.rows] + ([f"and {self.num_more} more"] if self.num_more else [])


@dataclasses.dataclass(frozen=True)
class Colouring:
    """rgb: u8 [S, 3] of segments; legend: what they mean."""

    rgb: np.ndarray
    legend: Legend


def colour_rays(mode: str, columns, segments, palette, mesh_names, *, cmap=None, clim=None) -> Colouring:
    """The colours of segments.

    mode: one of COLOUR_MODES; palette: u8 [M, 3] of meshes and mesh_names [M], for "mesh"
    cmap, clim: of the scales, matplotlib colour map or the name of one and (low, high) in dBm, m or m/s; None: by mode and data.
    """
    if mode == "bounces":
        return _by_bounces(columns, segments)
    if mode == "mesh":
        return _by_mesh(segments, palette, mesh_names)
    if mode not in _SCALES:
        raise ValueError(f"color_by: must be one of {', '.join(COLOUR_MODES)}, got {mode!r}")
    title, usual_cmap = _SCALES[mode]
    values = _values(mode, columns, segments.rays)
    if not len(values) and clim is None:  # there is no scale of nothing
        return Colouring(np.zeros((0, 3), np.uint8), Legend(title))
    clim = _limits(mode, values) if clim is None else clim
    if clim[0] > clim[1]:
        raise ValueError(f"clim: must be (low, high), got {tuple(clim)}")
    legend = Legend(title=title, clim=clim, cmap=cmap or usual_cmap)
    return Colouring(np.take(scale_colours(values, clim, legend.cmap), segments.ray, axis=0), legend)


def scale_colours(values, clim, cmap):
    """Colours u8 [N, 3] of values on a scale; what lies beyond its ends takes theirs."""
    return np.take(colour_table(cmap), levels_of(values, clim), axis=0)


def levels_of(values, clim):
    """Rows 0 to 255 of a colour table for values on a scale: u8, same shape."""
    low, high = clim
    share = (np.asarray(values, np.float32) - np.float32(low)) * np.float32(255.0 / max(high - low, 1e-12))
    return np.clip(share, 0.0, 255.0).astype(np.uint8)


def colour_table(cmap):
    """u8 [256, 3] of a matplotlib colour map, of however many colours, or of the name of one. Raises ValueError for anything
    else."""
    import matplotlib

    if isinstance(cmap, str) and cmap in matplotlib.colormaps:
        cmap = matplotlib.colormaps[cmap]
    if not isinstance(cmap, matplotlib.colors.Colormap):
        raise ValueError(f"cmap: must be a matplotlib colour map or the name of one, got {cmap!r}")
    return cmap(np.arange(256) / 255.0, bytes=True)[:, :3].astype(np.uint8)


def _values(mode: str, columns, rays):
    return columns.power_dbm(rays) if mode == "power" else {"range": columns.range, "speed": columns.velocity}[mode][rays]


def _limits(mode: str, values) -> tuple:
    if mode == "power":
        return float(values.max()) - POWER_SPAN_DB, float(values.max())
    if mode == "speed":
        fastest = max(float(np.abs(values).max()), LEAST_SPAN)
        return -fastest, fastest
    return float(values.min()), max(float(values.max()), float(values.min()) + LEAST_SPAN)


def _by_bounces(columns, segments) -> Colouring:
    table = np.array([rgb_of(text) for text in BOUNCE_COLOURS], np.uint8)
    row = np.clip(columns.num_bounces[segments.rays], 1, len(table)) - 1
    present = np.flatnonzero(np.bincount(row, minlength=len(table)))
    labels = [f"{row + 1}{' or more' if row == len(table) - 1 else ''}" for row in present]
    rows = tuple((label, tuple(map(int, table[row]))) for label, row in zip(labels, present))
    return Colouring(np.take(table, row[segments.ray], axis=0), Legend("Bounces", rows=rows))


def _by_mesh(segments, palette, mesh_names) -> Colouring:
    table = np.vstack([palette, np.full((1, 3), 128, np.uint8)])  # the last, -1, for rays without a hit
    return Colouring(np.take(table, segments.mesh_id, axis=0), _legend_of_objects(segments, palette, mesh_names))


def _legend_of_objects(segments, palette, mesh_names) -> Legend:
    """A row for each object that rays go to, those of most segments, in the mean of the shades of its meshes."""
    tops = [object_of(name) for name in mesh_names]
    counts = np.bincount(segments.mesh_id[segments.mesh_id >= 0], minlength=len(tops))
    totals: Counter = Counter()
    for mesh in np.flatnonzero(counts):
        totals[tops[mesh]] += int(counts[mesh])
    kept = [name for name, _ in totals.most_common(MAX_LEGEND_ROWS)]
    rows = tuple((name, _mean_colour(palette, [top == name for top in tops])) for name in totals if name in kept)
    return Legend("Object that the ray goes to", rows=rows, num_more=len(totals) - len(rows))


def _mean_colour(palette, meshes) -> tuple:
    return tuple(int(value) for value in np.rint(palette[np.asarray(meshes)].mean(axis=0)))
