"""Speed against error in one picture."""
from __future__ import annotations

from ...base.storage.origin import FIXED_SEEDS
from ...plots.style import new_figure, save_png
from .. import scale_ends

SHOWN = ("sphere_161", "sphere_3228", "ellipsoid", "plate_5", "plate_20.3", "dihedral")
# Okabe and Ito: told apart with any colour vision. Label of the curve: (text, colour, line, width).
CURVES = {
    "none lattice": ("no footprint", "#666666", "-", 1.8),
    "first_order lattice": ("first-order footprint", "#e69f00", "-", 1.8),
    "second_order lattice": ("second-order footprint: the default", "#0072b2", "-", 3.0),
    "second_order fibonacci": ("second order, Fibonacci rays", "#009e73", "--", 1.1),
    "second_order r2": ("second order, R2 rays", "#cc79a7", "--", 1.1),
    "second_order random": ("second order, random rays", "#d55e00", ":", 1.1),
}
BEST = "second_order lattice"
GOAL_DB = 0.1
ERROR_RANGE = (1e-3, 60.0)         # dB
NAMED_RAYS = {2 ** 10: "1 k rays", 2 ** 13: "8 k", 2 ** 16: "65 k"}


def draw_physics(results: dict, path) -> None:
    """Writes a PNG: rms error of the level against the time of trace and replay, a panel for each target."""
    with new_figure(11.0, 6.4) as figure:
        panels = figure.subplots(2, 3, sharex=True, sharey=True)
        for axes, name in zip(panels.flat, SHOWN):
            target = results["targets"][name]
            axes.set_title(target["title"].partition(", double")[0])
            _draw(axes, target["curves"])
        panels[0, 0].text(0.98, GOAL_DB * 0.8, "within 0.1 dB", fontsize=8, color="#2a6b2a", horizontalalignment="right",
                          verticalalignment="top", transform=panels[0, 0].get_yaxis_transform())
        figure.suptitle("How far off the level is, by the time spent (lower and further left is better)", fontsize=12)
        for axes in panels[-1]:
            axes.set_xlabel("time of trace and replay in ms")
        figure.supylabel("error of the level in dB (rms)", fontsize=9)
        handles = [*panels[0, 0].get_legend_handles_labels()[0], scale_ends.handle()]
        figure.legend(handles=handles, loc="outside lower center", ncols=4, frameon=False)
        save_png(figure, path, seed=FIXED_SEEDS)


def _draw(axes, curves: dict) -> None:
    axes.axhspan(ERROR_RANGE[0], GOAL_DB, color="#dff0d8", zorder=0)
    for label, (text, colour, line, width) in CURVES.items():
        points = [point for point in curves.get(label, []) if point["num_rays"] >= min(NAMED_RAYS)]
        times = [1e3 * point["seconds"] for point in points]
        errors = scale_ends.within(axes, times, [point["rms_db"] for point in points], ERROR_RANGE, colour)
        axes.plot(times, errors, line, color=colour, linewidth=width, label=text, zorder=4 if label == BEST else 3)
        if label == BEST:
            _name_rays(axes, points, times, errors, colour)
    axes.set_xscale("log")
    axes.xaxis.set_major_formatter("{x:g}")
    axes.set_yscale("log")
    axes.set_ylim(ERROR_RANGE)
    axes.yaxis.set_major_formatter("{x:g}")
    axes.grid(alpha=0.25)


def _name_rays(axes, points, times, errors, colour: str) -> None:
    for point, time, error in zip(points, times, errors):
        if point["num_rays"] in NAMED_RAYS:
            axes.plot([time], [error], "o", color=colour, markersize=5, zorder=5)
            axes.annotate(NAMED_RAYS[point["num_rays"]], (time, error), (5, 5), textcoords="offset points", fontsize=7,
                          color=colour, zorder=6)
