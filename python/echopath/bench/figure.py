"""Speed against error in one picture."""
from __future__ import annotations

from ..plots.style import new_figure, save_png

SHOWN = ("sphere_161", "sphere_3228", "ellipsoid", "plate_5", "plate_20.3", "dihedral")
# Okabe and Ito: told apart with any colour vision. Label of the curve: (text, colour, line, width).
CURVES = {
    "none lattice": ("no footprint", "#999999", "-", 1.6),
    "first_order lattice": ("first-order footprint", "#e69f00", "-", 1.6),
    "second_order lattice": ("second-order footprint (default)", "#0072b2", "-", 2.6),
    "second_order fibonacci": ("second order, Fibonacci", "#009e73", "--", 1.2),
    "second_order r2": ("second order, R2 sequence", "#cc79a7", "--", 1.2),
    "second_order random": ("second order, random", "#d55e00", ":", 1.2),
}
GOAL_DB = 0.1
TIME_RANGE = (0.3, 1000.0)  # ms


def draw_physics(results: dict, path) -> None:
    """Writes a PNG: rms error against launched rays (above) and against time of trace and replay (below)."""
    with new_figure(14.0, 6.2) as figure:
        axes = figure.subplots(2, len(SHOWN), sharey=True)
        for column, name in enumerate(SHOWN):
            target = results["targets"][name]
            axes[0, column].set_title(target["title"].partition(", double")[0])
            for row, quantity in enumerate(("num_rays", "seconds")):
                _draw(axes[row, column], target["curves"], quantity)
            axes[0, column].set_xlabel("rays launched")
            axes[1, column].set_xlabel("trace and replay [ms]")
        for row in range(2):
            axes[row, 0].set_ylabel("error [dB rms]")
        handles, labels = axes[0, 0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=len(CURVES), frameon=False)
        save_png(figure, path)


def _draw(axes, curves: dict, quantity: str) -> None:
    scale = 1e3 if quantity == "seconds" else 1.0
    for label, (text, colour, line, width) in CURVES.items():
        points = curves.get(label, [])
        axes.plot([scale * point[quantity] for point in points], [max(point["rms_db"], 1e-3) for point in points], line,
                  zorder=3 if width > 2.0 else 2, color=colour, linewidth=width, marker=".", markersize=3 + 1.5 * width, label=text)
    axes.axhline(GOAL_DB, color="black", linewidth=0.8, linestyle=(0, (1, 2)))
    axes.set_xscale("log", base=2 if quantity == "num_rays" else 10)
    if quantity == "seconds":
        axes.set_xlim(TIME_RANGE)
        axes.xaxis.set_major_formatter("{x:g}")
        axes.xaxis.minorticks_off()
    axes.set_yscale("log")
    axes.set_ylim(1e-3, 60.0)
    axes.grid(alpha=0.25)
