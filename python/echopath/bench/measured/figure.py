"""Pictures of `echopath bench measured`: levels over azimuth."""
from __future__ import annotations

from pathlib import Path

import numpy as np

from ...base.storage.origin import FIXED_SEEDS
from ...plots.style import CURVE_COLOURS, new_figure, save_png

SHOWN_DB = 58.0  # below the strongest level of a panel
ROWS = 3         # of panels in a picture


def draw_patterns(found, folder) -> None:
    """Writes measured_1.png and so on: a row of panels for each target."""
    names = list(dict.fromkeys(one.target for one in found))
    for number, first in enumerate(range(0, len(names), ROWS), start=1):
        shown = names[first:first + ROWS]
        _draw([[one for one in found if one.target == name] for name in shown], Path(folder) / f"measured_{number}.png")


def _draw(rows, path) -> None:
    columns = max(len(row) for row in rows)
    with new_figure(13.0, 1.0 + 3.0 * len(rows)) as figure:
        panels = figure.subplots(len(rows), columns, squeeze=False)
        for row, places in zip(rows, panels):
            for axes, one in zip(places, row):
                _draw_panel(axes, one)
            for axes in places[len(row):]:
                axes.set_visible(False)
        figure.legend(*panels[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
        figure.suptitle("Monostatic cross section, and its mean error beside the method of moments, without \N{RIGHTWARDS ARROW} "
                        "with the echoes of edges\n"
                        f"(data: Austin RCS Benchmark Suite; what is {SHOWN_DB:g} dB below the strongest goes below the panels)")
        save_png(figure, path, seed=FIXED_SEEDS)


def _draw_panel(axes, one) -> None:
    top = np.nanmax([one.measured, one.moments])
    axes.plot(one.azimuth, one.optics, color="0.65", linewidth=1.0, label="physical optics")
    axes.plot(one.azimuth, one.measured, ".", color="black", markersize=2.5, label="measured")
    axes.plot(one.azimuth, one.moments, color=CURVE_COLOURS[0], linewidth=1.0, label="method of moments")
    axes.plot(one.azimuth, one.with_edges, color=CURVE_COLOURS[1], linewidth=1.0, label="with edges")
    axes.set_ylim(top - SHOWN_DB, top + 4.0)
    axes.set(xlabel="azimuth in degrees", ylabel="cross section in dBsm",
             title=f"{one.target}, {one.frequency_ghz:.4g} GHz, {one.polarization.upper()}: "
                   f"{one.error(one.optics, one.moments):.1f} \N{RIGHTWARDS ARROW} "
                   f"{one.error(one.with_edges, one.moments):.1f} dB")
    axes.title.set_fontsize(8)
