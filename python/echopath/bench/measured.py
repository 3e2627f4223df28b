"""`echopath bench measured`: metal targets beside measurement and method of moments, with and without edges.

The targets, their measurements and the method of moments are those of the Austin RCS Benchmark Suite: the head of
data/reference/austin_rcs.csv says their source and licence. The error is the mean difference of levels in dB over all azimuths,
of what stands at most FLOOR_DB below the peak. The plate is computed with its thickness, where waves that go on from edge to
edge count, and as a sheet without one.
"""
from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

import echopath as ep

from ..base.files import write_texts
from ..base.origin import FIXED_SEEDS
from ..plots.style import CURVE_COLOURS, new_figure, save_png
from ..scene.materials import data_folder
from .steps import csv_text, told

NUM_RAYS, QUICK_NUM_RAYS = 2 ** 15, 2 ** 13
STEP, QUICK_STEP = 1, 3                    # of the table's azimuths
FLOOR_DB = 60.0
INCH, BOX_LENGTH = 0.0254, 0.4             # m
LEAST = 1e-9                               # m^2, least cross section that is shown
LIMITS = {("plate", "vv"): 1.3, ("plate", "hh"): 1.5, ("camera box", "vv"): 1.2, ("camera box", "hh"): 1.2}  # dB


@dataclasses.dataclass(frozen=True)
class Target:
    """A body of metal, and the name of its measurements."""

    name: str
    measured_as: str
    make: Callable


def slab(size) -> ep.Mesh:
    """A box about the origin; size [3] in m."""
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * np.asarray(size) / 2.0
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return ep.Mesh(corners, np.array([half for a, b, c, d in faces for half in ((a, b, c), (a, c, d))]))


def sheet() -> ep.Mesh:
    """The plate without its thickness."""
    corners = [(0.0, y * 10.5 * INCH / 2.0, z * 6.0 * INCH / 2.0) for y in (-1, 1) for z in (-1, 1)]
    return ep.Mesh(np.array(corners), np.array([(0, 1, 3), (0, 3, 2)]))


def camera_box() -> ep.Mesh:
    """A hexagonal prism with its nose along x."""
    outline = np.array([(0, -0.4), (0.75, -0.4), (1, -0.15), (1, 0.15), (0.75, 0.4), (0, 0.4)]) - (0.5, 0.0)
    corners = np.array([(x, y, z) for y in (-0.1625, 0.1625) for x, z in outline]) * BOX_LENGTH
    lids = [face for i in range(1, 5) for face in ((0, i, i + 1), (6, 7 + i, 6 + i))]
    sides = [face for i in range(6) for j in [(i + 1) % 6] for face in ((i, 6 + i, 6 + j), (i, 6 + j, j))]
    return ep.Mesh(corners, np.array(lids + sides))


TARGETS = (Target("sheet", "plate", sheet), Target("plate", "plate", lambda: slab((0.064 * INCH, 10.5 * INCH, 6.0 * INCH))),
           Target("camera box", "camera box", camera_box))


@dataclasses.dataclass(frozen=True)
class Pattern:
    """Levels [N] in dBsm over azimuth [N] in degrees: measured, by the method of moments, and computed without and with edges."""

    target: str
    frequency_ghz: float
    polarization: str
    azimuth: np.ndarray
    measured: np.ndarray
    moments: np.ndarray
    optics: np.ndarray
    with_edges: np.ndarray
    num_rays: int
    seconds: tuple[float, float]  # processor time, without and with edges

    def error(self, levels, reference) -> float:
        """dB, mean over azimuth."""
        floor = max(self.measured.max(), self.moments.max()) - FLOOR_DB
        return float(np.mean(np.abs(np.maximum(levels, floor) - np.maximum(reference, floor))))


def run_measured(folder, *, quick: bool = False, progress=None) -> list[Pattern]:
    """Writes measured.csv and measured.png into `folder`, returns the patterns.

    quick: few azimuths and rays; progress: callable (stage, fraction) or None
    """
    table = read_table()
    cases = [(target, frequency, polarization) for target in TARGETS
             for frequency in (7.0, 10.24) for polarization in ("vv", "hh")]
    found = [pattern_of(*case, table, quick=quick) for case in told(cases, "measured", progress)]
    write_texts(folder, {"measured.csv": csv_text([row_of(one) for one in found])})
    draw(found, Path(folder) / "measured.png")
    return found


def read_table() -> np.ndarray:
    """The rows of austin_rcs.csv, structured."""
    source = data_folder("reference") / "austin_rcs.csv"
    lines = [line for line in source.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    return np.genfromtxt(lines, delimiter=",", names=True, dtype=None, encoding="utf-8")


def pattern_of(target: Target, frequency_ghz: float, polarization: str, table, *, quick: bool = False) -> Pattern:
    """One target at one frequency and polarisation."""
    rows = table[(table["target"] == target.measured_as) & (table["frequency_ghz"] == frequency_ghz)
                 & (table["polarization"] == polarization)][::QUICK_STEP if quick else STEP]
    scene = ep.Scene()
    scene.add(target.make(), name="target", material=ep.Material.metal())
    azimuth, num_rays = np.radians(rows["azimuth_deg"]), QUICK_NUM_RAYS if quick else NUM_RAYS
    toward = np.stack([np.cos(azimuth), np.sin(azimuth), 0.0 * azimuth], axis=-1)
    levels, seconds = [], []
    for edges in (False, True):
        start = time.process_time()
        sigma = ep.rcs(scene, frequency=frequency_ghz * 1e9, incidence=toward, polarization=[polarization], num_rays=num_rays,
                       edges=edges)[:, 0]
        seconds.append(time.process_time() - start)
        levels.append(10.0 * np.log10(np.maximum(sigma, LEAST)))
    return Pattern(target.name, frequency_ghz, polarization, rows["azimuth_deg"], rows["measured_dbsm"], rows["moments_dbsm"],
                   *levels, num_rays, tuple(seconds))


def row_of(one: Pattern) -> dict:
    """The errors of a pattern in dB."""
    errors = {"optics_measured_db": (one.optics, one.measured), "edges_measured_db": (one.with_edges, one.measured),
              "optics_moments_db": (one.optics, one.moments), "edges_moments_db": (one.with_edges, one.moments),
              "moments_measured_db": (one.moments, one.measured)}
    return {"target": one.target, "frequency_ghz": one.frequency_ghz, "polarization": one.polarization,
            **{name: f"{one.error(*pair):.2f}" for name, pair in errors.items()}, "rays": one.num_rays,
            "optics_s": f"{one.seconds[0]:.1f}", "edges_s": f"{one.seconds[1]:.1f}"}


SHOWN_DB = 58.0  # below the strongest level of a panel


def draw(found: list[Pattern], path) -> None:
    """Writes a PNG: a panel for each pattern."""
    with new_figure(13.0, 10.0) as figure:
        panels = figure.subplots(len(TARGETS), 4, squeeze=False).flat
        for axes, one in zip(panels, found):
            _draw_panel(axes, one)
        next(iter(figure.axes)).legend(loc="upper right", fontsize=7)
        figure.suptitle("Monostatic cross section, and its mean error beside the method of moments, without \N{RIGHTWARDS ARROW} "
                        "with the echoes of edges\n"
                        f"(data: Austin RCS Benchmark Suite; what is {SHOWN_DB:g} dB below the strongest goes below the panels)")
        save_png(figure, path, seed=FIXED_SEEDS)


def _draw_panel(axes, one: Pattern) -> None:
    top = max(one.measured.max(), one.moments.max())
    axes.plot(one.azimuth, one.optics, color="0.65", linewidth=1.0, label="physical optics")
    axes.plot(one.azimuth, one.measured, ".", color="black", markersize=2.5, label="measured")
    axes.plot(one.azimuth, one.moments, color=CURVE_COLOURS[0], linewidth=1.0, label="method of moments")
    axes.plot(one.azimuth, one.with_edges, color=CURVE_COLOURS[1], linewidth=1.0, label="with edges")
    axes.set_ylim(top - SHOWN_DB, top + 4.0)
    axes.set(xlabel="azimuth in degrees", ylabel="cross section in dBsm",
             title=f"{one.target}, {one.frequency_ghz:g} GHz, {one.polarization.upper()}: "
                   f"{one.error(one.optics, one.moments):.1f} \N{RIGHTWARDS ARROW} "
                   f"{one.error(one.with_edges, one.moments):.1f} dB")
    axes.title.set_fontsize(8)


def describe(found: list[Pattern]) -> list[str]:
    """Lines for people."""
    lines = ["mean error in dB              beside measurement       beside method of moments   moments-   seconds",
             "target       GHz   pol        optics   with edges      optics   with edges         measured   without, with"]
    for one in found:
        row = row_of(one)
        lines.append(f"{one.target:12s} {one.frequency_ghz:5g} {one.polarization}     {row['optics_measured_db']:>8s} "
                     f"{row['edges_measured_db']:>12s}    {row['optics_moments_db']:>8s} {row['edges_moments_db']:>12s}    "
                     f"{row['moments_measured_db']:>12s}   {row['optics_s']:>6s}, {row['edges_s']}")
    return [*lines, *_verdicts(found)]


def _verdicts(found: list[Pattern]) -> list[str]:
    """Bounds of the plate beside measurement, and of the box beside the method of moments."""
    lines = ["", "must reach"]
    for one in found:
        limit = LIMITS.get((one.target, one.polarization))
        if limit is None:
            continue
        beside = "measurement" if one.target == "plate" else "method of moments"
        error = one.error(one.with_edges, one.measured if one.target == "plate" else one.moments)
        lines.append(f"  {one.target} {one.frequency_ghz:g} GHz {one.polarization} beside {beside}: at most {limit:.1f} dB, "
                     f"{error:.2f}  {'holds' if error <= limit else 'MISSED'}")
    return lines
