"""What the colours of rays mean, drawn into the picture."""
from __future__ import annotations

import pyvista as pv

ROW_HEIGHT, LETTER_WIDTH = 19.0, 9.5  # pixels
SCALE_SIZE, EDGE = (320.0, 44.0), 12.0
TEXT_COLOUR = "black"


def show_legend(plotter, legend) -> None:
    """Replaces the legend; legend: model.Legend."""
    plotter.remove_legend(render=False)
    for title in list(plotter.scalar_bars.keys()):
        plotter.remove_scalar_bar(title, render=False)
    if legend.clim is not None:
        _show_scale(plotter, legend)
    elif legend.rows:
        longest = max(len(text) for text in [legend.title, *(label for label, _ in legend.rows)])
        size = _share(plotter, 30.0 + LETTER_WIDTH * longest, ROW_HEIGHT * (len(legend.rows) + 1))
        rows = [[legend.title, TEXT_COLOUR, "none"],
                *([label, [value / 255.0 for value in rgb], "rectangle"] for label, rgb in legend.rows)]
        plotter.add_legend(rows, bcolor=(1.0, 1.0, 1.0), background_opacity=0.75, border=False, loc="lower right",
                           size=size)


def _show_scale(plotter, legend) -> None:
    mapper = pv.DataSetMapper()
    mapper.lookup_table = pv.LookupTable(cmap=legend.cmap, scalar_range=legend.clim, n_values=256)
    mapper.scalar_range = legend.clim
    width, height = _share(plotter, *SCALE_SIZE)
    left, bottom = _share(plotter, EDGE, EDGE)
    plotter.add_scalar_bar(title=legend.title, mapper=mapper, interactive=False, color=TEXT_COLOUR, fmt="%.3g", n_labels=5,
                           width=width, height=height, position_x=1.0 - width - left, position_y=bottom,
                           title_font_size=14, label_font_size=12, render=False)


def _share(plotter, width: float, height: float) -> tuple:
    """A size in pixels as shares of the picture, at most half of it each."""
    picture_width, picture_height = plotter.window_size
    return min(0.5, width / max(picture_width, 1)), min(0.5, height / max(picture_height, 1))
