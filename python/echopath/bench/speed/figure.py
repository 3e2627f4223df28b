"""Speed against error of synthesis, and how whole frames grow."""
from __future__ import annotations

import numpy as np

from ...base.storage.origin import FIXED_SEEDS
from ...plots.style import new_figure, save_png

OURS, OWN_SPEED, FINUFFT, SUMS, GREY = "#0072b2", "#56b4e9", "#d55e00", "#009e73", "#666666"  # Okabe and Ito
SUM_WORDS = {"direct": "direct sum", "recurrence": "sum by a recurrence"}
NAMED_TOLERANCES = (1e-1, 1e-4, 1e-7, 1e-10, 1e-13)


def draw_synthesis(results: dict, path) -> None:
    """Writes a PNG: processor time per echo and chirp against the error."""
    found = results["synthesis"]
    with new_figure(8.6, 5.6) as figure:
        axes = figure.subplots()
        rows = found["rows"]
        _curve(axes, rows, "error", "ns", OURS, "o-", "echopath: states, phases and samples of moving bodies")
        _curve(axes, rows, "error", "scattered_ns", OWN_SPEED, "o--", "echopath, each echo at a speed of its own")
        if results["finufft"]:
            _curve(axes, rows, "finufft_error", "finufft_ns", FINUFFT, "s-",
                   f"FINUFFT {results['finufft']}, points and strengths given")
        for row, marker in zip(found["sums"], "D^"):
            axes.plot(row["error"], row["ns"], marker, color=SUMS, markersize=8,
                      label=f"echopath, {SUM_WORDS.get(row['method'], row['method'])}")
        for row in rows:
            if any(abs(row["tolerance"] / named - 1.0) < 1e-6 for named in NAMED_TOLERANCES):
                axes.annotate(f"$10^{{{np.log10(row['tolerance']):.0f}}}$", (row["error"], row["ns"]), (0, -12),
                              textcoords="offset points", ha="center", fontsize=7, color=OURS)
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_ylim(1.0, 1000.0)
        axes.yaxis.set_major_formatter("{x:g}")
        axes.set_xlabel("relative error of the samples (numbers in the picture: tolerance that was asked for)")
        axes.set_ylabel("processor time per echo and chirp in ns, one thread")
        axes.set_title(f"IF synthesis: {found['paths']:,} echoes, {found['samples']} samples, {found['chirps']} chirps; "
                       f"{results['machine']['processor']}, {results['machine']['instruction_set']}")
        axes.legend(frameon=False, loc="upper right")
        axes.grid(alpha=0.25, which="both")
        save_png(figure, path, seed=FIXED_SEEDS)


def _curve(axes, rows, error: str, time: str, colour: str, style: str, label: str) -> None:
    axes.plot([row[error] for row in rows], [row[time] for row in rows], style, color=colour, markersize=4, label=label)


def draw_frames(results: dict, path) -> None:
    """Writes a PNG: processor time of frames against paths, chirps, channels and parts; peak memory against paths."""
    frames = results["frames"]
    with new_figure(11.0, 3.8) as figure:
        paths, others, memory = figure.subplots(1, 3)
        counts = [row["paths"] for row in frames["paths"]]
        paths.loglog(counts, [row["processor_s"] for row in frames["paths"]], "o-", color=OURS, label="measured")
        last = frames["paths"][-1]
        each = last["processor_s"] / last["paths"]
        paths.loglog(counts, [each * count for count in counts], ":", color=GREY, label="in proportion to the paths")
        paths.set_xlabel("number of paths")
        paths.set_ylabel("processor time of a frame in s")
        paths.set_title("Time over paths")
        paths.legend(frameon=False)
        for colour, kind in zip((OURS, FINUFFT, SUMS), ("chirps", "channels", "parts")):
            rows = frames[kind]
            others.loglog([row[kind] for row in rows], [row["processor_s"] for row in rows], "o-", color=colour, label=kind)
        others.set_xlabel("number of chirps, channels or parts")
        others.set_ylabel("processor time of a frame in s")
        others.xaxis.set_major_formatter("{x:g}")
        others.set_title("Time over chirps, channels and parts")
        others.legend(frameon=False)
        memory.loglog(counts, [row["peak_bytes"] / 2 ** 20 for row in frames["paths"]], "o-", color=OURS)
        memory.axhline(4096.0, color=GREY, linestyle=":")
        memory.annotate("4 GiB: promised at most", (counts[0], 4096.0), (2, -11), textcoords="offset points", fontsize=8,
                        color=GREY)
        memory.set_xlabel("number of paths")
        memory.set_ylabel("peak memory in MiB")
        memory.set_title("Memory, with the record of the paths")
        for axes in (others, memory):
            axes.yaxis.set_minor_formatter("")
            axes.yaxis.set_major_formatter("{x:g}")
        most = max(row["processor_s"] for kind in ("chirps", "channels", "parts") for row in frames[kind])
        others.set_ylim(most / 100.0, most * 2.0)
        for axes in (paths, others, memory):
            axes.grid(alpha=0.25, which="both")
        save_png(figure, path, seed=FIXED_SEEDS)
