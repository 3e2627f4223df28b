"""Errors of the objects of a crowded street and coverage of the true value, in one picture."""
from __future__ import annotations

import numpy as np

from ...base.storage.origin import FIXED_SEEDS
from ...plots.style import CURVE_COLOURS, new_figure, save_png
from .. import scale_ends

SHOWN_DB = -12.0, 6.0  # of the errors


def draw_crowd(results: dict, path, *, wanted_db: float) -> None:
    """Writes a PNG: error of each object with what the run claims (left), coverage over rays (right).

    wanted_db: error that an echo may have without a flag
    """
    with new_figure(11.0, 5.4) as figure:
        left, right = figure.subplots(1, 2, width_ratios=(1.3, 1.0))
        _draw_streets(left, results["streets"], wanted_db)
        _draw_coverage(right, results["coverage"])
        save_png(figure, path, seed=FIXED_SEEDS)


def _draw_streets(axes, streets: list, wanted_db: float) -> None:
    axes.axvspan(-wanted_db, wanted_db, color="0.9")
    for offset, colour, street in zip((-0.15, 0.15), CURVE_COLOURS, streets):
        for index, row in enumerate(street["rows"]):
            places = np.full(len(row["error_db"]), index + offset)
            errors = scale_ends.within(axes, places, row["error_db"], SHOWN_DB, colour, across=True)
            for side in (-1.0, 1.0):
                ends = errors + side * np.asarray(row["claimed_db"])
                ends = scale_ends.within(axes, places, ends, SHOWN_DB, colour, across=True)
                axes.hlines(places, errors, ends, color=colour, alpha=0.4)
            flagged = np.array(row["flagged"])
            axes.plot(errors[~flagged], places[~flagged], "o", color=colour, markersize=4,
                      label=f"{street['title']}; hollow: told as not resolved" if index == 0 else None)
            axes.plot(errors[flagged], places[flagged], "o", color=colour, markersize=4, fillstyle="none")
    axes.set_yticks(range(len(streets[0]["rows"])), [row["name"] for row in streets[0]["rows"]], fontsize=7)
    axes.invert_yaxis()
    axes.set_xlim(SHOWN_DB)
    axes.set_xlabel("error of the direct power in dB, with the interval that the run claims (grey: wanted)")
    axes.set_title("Each object of a street against itself alone")
    handles = [*axes.get_legend_handles_labels()[0], scale_ends.handle(across=True)]
    axes.legend(handles=handles, frameon=False, fontsize=7, loc="lower left")
    axes.grid(axis="x", alpha=0.25)


def _draw_coverage(axes, coverage: dict) -> None:
    axes.axhspan(*coverage["wanted"], color="0.9")
    kinds = dict.fromkeys(row["kind"] for row in coverage["rows"])
    for index, kind in enumerate(kinds):
        rows = [row for row in coverage["rows"] if row["kind"] == kind]
        axes.plot([row["rays"] for row in rows], [row["coverage"] for row in rows], marker="o", markersize=4,
                  color=CURVE_COLOURS[index % len(CURVE_COLOURS)], linestyle="-" if index < len(CURVE_COLOURS) else "--",
                  label=kind)
    axes.set_xscale("log", base=2)
    axes.set_ylim(-0.05, 1.05)
    axes.set_xlabel("number of rays")
    axes.set_ylabel("share of seeds (grey: wanted)")
    axes.set_title("How often intervals of 95 % hold the truth")
    axes.legend(frameon=False, fontsize=7)
    axes.grid(alpha=0.25)
