"""What parts cost and how fast expressions are matched, in one picture."""
from __future__ import annotations

import numpy as np

from ...base.storage.origin import FIXED_SEEDS
from ...plots.style import CURVE_COLOURS, new_figure, save_png


def draw_labels(results: dict, path, *, rate_target: float) -> None:
    """Writes a PNG: time of decompose over that of synthesize by number of parts (left), rates of matching (right).

    rate_target: promised hits per second on one core
    """
    with new_figure(11.0, 4.6) as figure:
        left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.35))
        _draw_cost(left, results["parts"])
        _draw_rates(right, results["rates"], rate_target)
        save_png(figure, path, seed=FIXED_SEEDS)


def _draw_cost(axes, cases: list) -> None:
    for colour, case in zip(CURVE_COLOURS, cases):
        counts = [row["num_parts"] for row in case["rows"]]
        axes.plot(counts, [row["over_synthesize"] for row in case["rows"]], "o-", color=colour,
                  label=f"{case['rays']:,} rays, {case['paths']:,} paths")
    axes.plot(counts, counts, color="0.6", linewidth=0.8, linestyle=(0, (1, 2)), label="a synthesis for each part")
    axes.set_xscale("log", base=2)
    axes.set_xticks(counts, [str(count) for count in counts])
    axes.set_ylim(0.0, max(4.0, 1.1 * max(row["over_synthesize"] for case in cases for row in case["rows"])))
    axes.set_xlabel("number of parts")
    axes.set_ylabel("time of decompose over that of synthesize")
    axes.set_title("What parts cost: all from one pass")
    axes.legend(frameon=False, loc="upper center", bbox_to_anchor=(0.5, -0.16))
    axes.grid(alpha=0.25)


def _draw_rates(axes, cases: list, rate_target: float) -> None:
    labels = ["bare loop", *cases[0]["hits_per_second"]]
    height = 0.8 / len(cases)
    for index, (colour, case) in enumerate(zip(CURVE_COLOURS, cases)):
        rates = np.array([case["bare_hits_per_second"], *case["hits_per_second"].values()]) * 1e-6
        axes.barh(np.arange(len(labels)) + (index + 0.5) * height - 0.4, rates, 0.9 * height, color=colour,
                  label=case["title"])
    axes.axvline(rate_target * 1e-6, color="black", linewidth=0.8, linestyle=(0, (1, 2)))
    axes.set_yticks(np.arange(len(labels)), labels, family="monospace", fontsize=7)
    axes.invert_yaxis()
    axes.set_axisbelow(True)
    axes.set_xlabel("million hits per second on one core (dotted: promised)")
    axes.set_title("Path expressions against a bare loop over the same hits")
    axes.legend(frameon=False, loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=2)
    axes.grid(axis="x", alpha=0.25)
