"""`echopath bench measured`: metal targets beside measurement and method of moments, with and without edges.

The targets, their measurements and the method of moments are those of the Austin RCS Benchmark Suite: the head of
data/reference/austin_rcs.csv says their source and licence. The error is the mean difference of levels in dB over all azimuths,
of what stands at most FLOOR_DB below the peak; the suite's own counts what stands at most SUITE_FLOOR_DB below that of the
method of moments. The plate is computed with its thickness, where waves that go on from edge to edge count, and as a sheet
without one.
"""
from __future__ import annotations

import dataclasses
import time

import numpy as np

import echopath as ep

from ...base.storage.data_folder import data_folder
from ...base.storage.files import write_texts
from ..steps import csv_text, told
from .figure import draw_patterns
from .targets import (
    INCH,
    Target,
    almond,
    camera_box,
    cavity_of_cobra_duct,
    cobra_duct,
    cylindrical_duct,
    fan_in_a_duct,
    lying_sheet,
    prime_aircraft,
    sheet,
    slab,
)

NUM_RAYS, QUICK_NUM_RAYS = 2 ** 15, 2 ** 13
RAYS_OF_DUCTS = 2                          # as many: neighbouring rays grow apart from bounce to bounce in a round duct
STEP, QUICK_STEP = 1, 3                    # of the table's azimuths
FLOOR_DB, SUITE_FLOOR_DB, PEAK_DB = 60.0, 80.0, 20.0
LEAST = 1e-9                               # m^2, least cross section that is shown
BOUNCES, DUCT_BOUNCES = 4, 40
DUCTS = ("cylindrical duct", "fan in a duct")  # that are wide enough for rays
LIMITS = {("plate", "vv"): 1.3, ("plate", "hh"): 1.5, ("camera box", "vv"): 1.2, ("camera box", "hh"): 1.2,
          **{(name, polarization): 1.5 for name in ("cobra duct", "cylindrical duct") for polarization in ("vv", "hh")}}  # dB

TARGETS = (Target("sheet", "plate", lambda: sheet(6.0 * INCH)),
           Target("sheet IIA", "zero-thickness plate", lambda: sheet(6.0 * INCH)),
           Target("sheet IIA, grazing", "zero-thickness plate from above", lambda: lying_sheet(4.0 * INCH), theta_deg=80.0),
           Target("plate", "plate", lambda: slab((0.064 * INCH, 10.5 * INCH, 6.0 * INCH))),
           Target("camera box", "camera box", camera_box),
           Target("cobra duct", "cobra duct", cobra_duct, smooth=True, cavity=cavity_of_cobra_duct()),
           Target("cylindrical duct", "cylindrical duct", cylindrical_duct, smooth=True),
           Target("fan in a duct", "fan in a duct", fan_in_a_duct, smooth=True),
           Target("almond", "almond", almond, smooth=True))


@dataclasses.dataclass(frozen=True)
class Pattern:
    """Levels [N] in dBsm over azimuth [N] in degrees: measured (NaN where nobody did), by the method of moments, and computed
    without and with edges."""

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
        """dB, mean over azimuth; NaN without a reference."""
        return self._mean(levels, reference, np.nanmax([self.measured, self.moments]) - FLOOR_DB)

    def error_of_suite(self, levels) -> float:
        """dB, the suite's own measure, beside the method of moments."""
        return self._mean(levels, self.moments, self.moments.max() - SUITE_FLOOR_DB)

    def error_at_peaks(self, levels) -> float:
        """dB, rms beside the method of moments of what stands at most PEAK_DB below its peak."""
        high = self.moments > self.moments.max() - PEAK_DB
        return float(np.sqrt(np.mean((levels - self.moments)[high] ** 2)))

    @staticmethod
    def _mean(levels, reference, floor) -> float:
        difference = np.abs(np.maximum(levels, floor) - np.maximum(reference, floor))[~np.isnan(reference)]
        return float(difference.mean()) if difference.size else np.nan


def run_measured(folder, *, quick: bool = False, progress=None, suite=None) -> list[Pattern]:
    """Writes measured.csv and a picture for every two targets into `folder`, returns the patterns.

    quick: few azimuths and rays; progress: callable (stage, fraction) or None; suite: a checkout of the suite, whose mesh of
    the PRIME aircraft is computed, too, or None
    """
    table = read_table()
    cases = [(target, frequency, polarization) for target in targets_with(suite)
             for frequency in np.unique(table["frequency_ghz"][table["target"] == target.measured_as])
             for polarization in ("vv", "hh")]
    found = [pattern_of(*case, table, quick=quick) for case in told(cases, "measured", progress)]
    write_texts(folder, {"measured.csv": csv_text([row_of(one) for one in found])})
    draw_patterns(found, folder)
    return found


def targets_with(suite) -> list[Target]:
    """The targets that can be made, with a checkout of the suite or None."""
    if suite is None:
        return list(TARGETS)
    return [*TARGETS, Target("PRIME", "PRIME", lambda: prime_aircraft(suite), smooth=True)]


def read_table() -> np.ndarray:
    """The rows of austin_rcs.csv, structured."""
    source = data_folder("reference") / "austin_rcs.csv"
    lines = [line for line in source.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    kinds = [("target", "U40"), ("frequency_ghz", float), ("polarization", "U2"), ("azimuth_deg", float),
             ("measured_dbsm", float), ("moments_dbsm", float)]
    return np.genfromtxt(lines[1:], delimiter=",", dtype=kinds, encoding="utf-8")


def scene_of(target: Target) -> ep.Scene:
    """The target of metal."""
    scene = ep.Scene()
    for number, mesh in enumerate(target.make()):
        scene.add(mesh, name=f"part_{number}", material=ep.Material.metal(), smooth=target.smooth)
    return scene


def directions(azimuth, theta) -> np.ndarray:
    """Unit vectors [N, 3] toward the radar; azimuth [N] and theta, from +z, in rad."""
    return np.stack([np.sin(theta) * np.cos(azimuth), np.sin(theta) * np.sin(azimuth), np.cos(theta) + 0.0 * azimuth], axis=-1)


def rows_of(target: Target, frequency_ghz: float, polarization: str, table, *, quick: bool = False) -> np.ndarray:
    """The table's rows of a target at one frequency and polarisation, every third one where it is quick."""
    rows = table[(table["target"] == target.measured_as) & (table["frequency_ghz"] == frequency_ghz)
                 & (table["polarization"] == polarization)]
    return rows[::QUICK_STEP if quick else STEP]


def rays_for(target: Target, quick: bool) -> int:
    """Rays for each direction."""
    return (QUICK_NUM_RAYS if quick else NUM_RAYS) * (RAYS_OF_DUCTS if target.name in DUCTS else 1)


def levels_of(target: Target, rows, *, edges: bool, quick: bool = False) -> np.ndarray:
    """Levels [N] in dBsm at the azimuths of rows of one frequency and polarisation, without or with edges."""
    toward = directions(np.radians(rows["azimuth_deg"]), np.radians(target.theta_deg))
    sigma = ep.rcs(scene_of(target), frequency=rows["frequency_ghz"][0] * 1e9, incidence=toward,
                   polarization=[str(rows["polarization"][0])], num_rays=rays_for(target, quick),
                   max_bounces=DUCT_BOUNCES if target.name in DUCTS else BOUNCES, edges=edges, cavities=target.cavity)[:, 0]
    return 10.0 * np.log10(np.maximum(sigma, LEAST))


def pattern_of(target: Target, frequency_ghz: float, polarization: str, table, *, quick: bool = False) -> Pattern:
    """One target at one frequency and polarisation."""
    rows = rows_of(target, frequency_ghz, polarization, table, quick=quick)
    levels, seconds = [], []
    for edges in (False, True):
        start = time.process_time()
        levels.append(levels_of(target, rows, edges=edges, quick=quick))
        seconds.append(time.process_time() - start)
    return Pattern(target.name, frequency_ghz, polarization, rows["azimuth_deg"], rows["measured_dbsm"], rows["moments_dbsm"],
                   *levels, rays_for(target, quick), tuple(seconds))


def row_of(one: Pattern) -> dict:
    """The errors of a pattern in dB."""
    errors = {"optics_measured_db": one.error(one.optics, one.measured),
              "edges_measured_db": one.error(one.with_edges, one.measured),
              "optics_moments_db": one.error(one.optics, one.moments), "edges_moments_db": one.error(one.with_edges, one.moments),
              "moments_measured_db": one.error(one.moments, one.measured),
              "optics_suite_db": one.error_of_suite(one.optics), "edges_suite_db": one.error_of_suite(one.with_edges),
              "optics_peaks_db": one.error_at_peaks(one.optics), "edges_peaks_db": one.error_at_peaks(one.with_edges)}
    return {"target": one.target, "frequency_ghz": one.frequency_ghz, "polarization": one.polarization,
            **{name: f"{value:.2f}" for name, value in errors.items()}, "rays": one.num_rays,
            "optics_s": f"{one.seconds[0]:.1f}", "edges_s": f"{one.seconds[1]:.1f}"}


def describe(found: list[Pattern]) -> list[str]:
    """Lines for people."""
    lines = ["dB, without -> with edges  mean beside the  method of       the suite's own  rms within 20 dB moments -  processor",
             "target               GHz  pol measurement     moments         measure          of the peak      measured   s"]
    for one in found:
        row = row_of(one)
        pairs = "".join(f"{_told(row[f'optics_{name}_db']):>9s} -> {_told(row[f'edges_{name}_db']):<5s}"
                        for name in ("measured", "moments", "suite", "peaks"))
        lines.append(f"{one.target:19s} {one.frequency_ghz:5.4g}   {one.polarization} {pairs}"
                     f"{_told(row['moments_measured_db']):>9s}   {row['optics_s']:>6s}, {row['edges_s']}")
    return [*lines, *_verdicts(found)]


def _told(error: str) -> str:
    """An error in dB, "-" beside what nobody has measured."""
    return "-" if error == "nan" else error


def _verdicts(found: list[Pattern]) -> list[str]:
    """Bounds of the plate beside measurement, and of the boxes beside the method of moments."""
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
