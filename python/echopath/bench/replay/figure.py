"""What replay gains and errs, in one picture."""
from __future__ import annotations

import numpy as np

from ...base.storage.origin import FIXED_SEEDS
from ...plots.style import CURVE_COLOURS, new_figure, save_png
from .. import scale_ends

MARKERS = {"interpolated, 1e-1 rad": "v", "interpolated, 1e-3 rad": "^", "interpolated, 1e-5 rad (default)": "o",
           "every chirp": "s",
           "Newton step": "D", "renewed 4 times": "P", "renewed 16 times": "X"}
FLOOR_RAD = 1e-6
FLOOR_DB = -150.0  # errors below stand there, with a mark at the end of the scale
BOTTOM_DB, TOP_DB = FLOOR_DB - 5.0, -20.0
LIMIT_DB = -40.0   # what an error of one record should stay below
LIMIT_LOOK = {"color": "black", "linewidth": 0.8, "linestyle": (0, (1, 2))}


def draw_replay(results: dict, path) -> None:
    """Writes a PNG: error against time of the ways to replay (left), phase error over an array's aperture (right)."""
    with new_figure(12.5, 6.6) as figure:
        left, right = figure.subplots(1, 2, width_ratios=(1.25, 1.0))
        _draw_variants(left, results["cases"])
        _draw_apertures(right, results["apertures"])
        save_png(figure, path, seed=FIXED_SEEDS)


def _draw_variants(axes, cases: dict) -> None:
    for colour, case in zip(CURVE_COLOURS, cases.values()):
        for row in case["variants"]:
            share, error = row["share_of_every_chirp"], row["error_db"]
            scale_ends.within(axes, [share], [error], (BOTTOM_DB, TOP_DB), colour)
            axes.plot(share, np.clip(error, FLOOR_DB, TOP_DB), MARKERS[row["label"]], color=colour, markersize=7,
                      markerfacecolor="none" if row["label"] != "interpolated, 1e-5 rad (default)" else colour)
        axes.plot([], [], "-", color=colour, linewidth=3, label=case["title"])
    for label, marker in MARKERS.items():
        axes.plot([], [], marker, color="#444444", markerfacecolor="none", label=label)
    axes.axhline(LIMIT_DB, label="1 % of the peak", **LIMIT_LOOK)
    axes.set_xscale("log")
    axes.set_xlabel("time of the signal, as a share of renewing the hits at every chirp")
    axes.set_ylabel("largest error of the map in dB of its peak")
    axes.set_ylim(BOTTOM_DB, TOP_DB)
    axes.set_title("One record for all chirps of a frame: error against time")
    handles = [*axes.get_legend_handles_labels()[0], scale_ends.handle()]
    axes.legend(handles=handles, fontsize=8, ncols=2, loc="upper center", bbox_to_anchor=(0.5, -0.13), frameon=False)
    axes.grid(alpha=0.25)


def _draw_apertures(axes, rows: list) -> None:
    for colour, distance in zip(CURVE_COLOURS, sorted({row["distance_m"] for row in rows})):
        shown = [row for row in rows if row["distance_m"] == distance and row["paths"]]
        for key, line, text in (("material_rad", "-", "recorded points"), ("fermat_rad", "--", "Newton step")):
            apertures = [row["aperture_m"] for row in shown]
            errors = scale_ends.within(axes, apertures, [row[key] for row in shown], (FLOOR_RAD, 1e3), colour)
            axes.plot(apertures, errors, line, color=colour, marker=".", label=f"target at {distance:g} m, {text}")
    axes.axhline(0.3, label="limit of `validity`: 0.3 rad", **LIMIT_LOOK)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xticks(sorted({row["aperture_m"] for row in rows}))
    axes.xaxis.set_major_formatter("{x:g}")
    axes.set_xticks([], minor=True)
    axes.set_xlabel("width of the array in m")
    axes.set_ylabel("phase error of the echo over a wall 1 m aside, in rad")
    axes.set_title("One record for all antennas of an array")
    handles = [*axes.get_legend_handles_labels()[0], scale_ends.handle()]
    axes.legend(handles=handles, fontsize=8, ncols=2, loc="upper center", bbox_to_anchor=(0.5, -0.13), frameon=False)
    axes.grid(alpha=0.25)
