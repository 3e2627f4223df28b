"""Pictures of the gallery: every figure that a script has made, those of `echopath.plots` too, which no window manages."""
from __future__ import annotations

import matplotlib.pyplot as plt
from matplotlib.figure import Figure
from sphinx_gallery.scrapers import figure_rst

DPI = 100


def save_figures(block, block_vars: dict, gallery_conf: dict) -> str:
    """Saves the figures that the block made and returns the lines that show them; the script's own names keep the order."""
    figures = [value for value in block_vars["example_globals"].values() if isinstance(value, Figure)]
    figures += [plt.figure(number) for number in plt.get_fignums()]
    shown = block_vars["example_globals"].setdefault("_shown_figures", [])
    paths = []
    for figure in figures:
        if any(figure is one for one in shown):
            continue
        shown.append(figure)
        path = next(block_vars["image_path_iterator"])
        figure.savefig(path, format="png", dpi=DPI)
        paths.append(path)
    plt.close("all")
    return figure_rst(paths, gallery_conf["src_dir"])
