"""`echopath bench actors`: cross sections of the actors over aspect beside published ones, as figures and a picture.

Power is averaged over azimuth at level incidence. The mean of large smooth bodies is made by a few flashes, so that their
median says more of a usual aspect; both are given. What is flat or straight has a closed form where it is square to the radar:
the sign at its peak, the pole from a little above, where its tapering side faces the radar.
"""
from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path

import numpy as np

import echopath as ep

from .. import actors
from ..base.storage.files import write_texts
from ..base.storage.origin import FIXED_SEEDS
from ..plots.style import new_figure, save_png
from ..signals.measures import for_pictures
from .steps import csv_text, told

FREQUENCY = 77e9                     # Hz
AZIMUTH_STEP, QUICK_AZIMUTH_STEP = 5.0, 30.0   # deg
FINE_AZIMUTH_STEP = 0.25             # deg, as wide as the flash of a wheel square to the radar
NUM_RAYS, QUICK_NUM_RAYS = 2 ** 16, 2 ** 13
FLOOR = 1e-5                         # m^2, least cross section that is shown
COLUMNS = 4                          # of panels

MEMORY = "quoted from memory, unverified"
JRC = "Fortuny-Guasch, Chareau, EUR 25762 EN 2013: means over azimuth of 2 adults, 76-81 GHz"
NAKAMURA = "Nakamura, Hadama, IEICE ComEx 9 (2020) 262: means of 5 drones, -8.1 to -19.1 dBsm, at 24 GHz; more at 79 GHz"
NONE_FOUND = "none was found"
WAVELENGTH = ep.speed_of_light / FREQUENCY
SIGN_SIZE = 0.6                      # m, diameter
POLE_HEIGHT, POLE_RADII = 6.0, (0.07, 0.04)   # m, at the ground and the top
POLE_TILT = float(np.arctan((POLE_RADII[0] - POLE_RADII[1]) / (POLE_HEIGHT + 0.05)))  # rad; its foot is 5 cm below the ground
CLOSED_FORM_DB = 1.0                 # of closed forms, either way


@dataclasses.dataclass(frozen=True)
class Subject:
    """An actor, and what is published of it: a band from low to high in dBsm of the statistic, "mean", "median" or "peak"; None
    where nothing is. elevation: rad, of the radar seen from it; step: deg, from azimuth to azimuth, fine where flashes make
    the mean."""

    name: str
    make: Callable
    statistic: str
    low: float | None
    high: float | None
    source: str
    elevation: float = 0.0
    step: float = AZIMUTH_STEP


def _closed_form(sigma: float) -> tuple[float, float]:
    """A band about a cross section in m^2."""
    level = float(10.0 * np.log10(sigma))
    return level - CLOSED_FORM_DB, level + CLOSED_FORM_DB


DISC = _closed_form(4.0 * np.pi * (0.25 * np.pi * SIGN_SIZE ** 2) ** 2 / WAVELENGTH ** 2)
CONE = _closed_form(2.0 * np.pi * 0.5 * sum(POLE_RADII) * POLE_HEIGHT ** 2 / WAVELENGTH)


SUBJECTS = (
    Subject("car, compact", lambda: actors.car(), "median", -5.0, 15.0, f"usual aspects of cars at 76 GHz; {MEMORY}"),
    Subject("car, SUV", lambda: actors.car(kind="suv"), "median", -5.0, 15.0, f"usual aspects of cars at 76 GHz; {MEMORY}"),
    Subject("van", lambda: actors.van(), "median", 0.0, 20.0, f"usual aspects of vans; {MEMORY}"),
    Subject("truck", lambda: actors.truck(), "median", 10.0, 30.0, f"usual aspects of trucks; {MEMORY}"),
    Subject("motorcycle with rider", lambda: actors.motorcycle(), "median", -5.0, 10.0, f"77 GHz; {MEMORY}"),
    Subject("cyclist", lambda: actors.cyclist(), "mean", -8.0, 3.0, f"bicyclists at 77 GHz; {MEMORY}",
            step=FINE_AZIMUTH_STEP),
    Subject("pedestrian", lambda: actors.pedestrian(), "mean", -6.9, -3.5, JRC),
    Subject("runner", lambda: actors.runner(), "mean", -6.9, -3.5, f"of standing adults: {JRC}"),
    Subject("child of 1.15 m", lambda: actors.child(), "mean", -14.0, -7.0, f"{MEMORY}; none was found"),
    Subject("dog", lambda: actors.dog(), "mean", -15.0, -5.0, f"{MEMORY}; none was found"),
    Subject("drone", lambda: actors.drone(rotor_rpm=0.0), "mean", -19.1, -8.1, NAKAMURA),
    Subject("tree", lambda: actors.tree(), "mean", -4.0, 6.0,
            f"-15 to -8 dB a square metre of crown (14 m^2) at 95 GHz; {MEMORY}"),
    Subject("standing person", lambda: actors.standing_person(), "mean", -6.9, -3.5, JRC),
    Subject("bicycle", lambda: actors.bicycle(), "mean", None, None, NONE_FOUND, step=FINE_AZIMUTH_STEP),
    Subject("parked row", lambda: actors.parked_row(), "median", None, None, NONE_FOUND),
    Subject("guard rail of 20 m", lambda: actors.guard_rail(), "median", None, None, NONE_FOUND),
    Subject("traffic sign", lambda: actors.traffic_sign(size=SIGN_SIZE), "peak", *DISC, "4 pi A^2 / wavelength^2 of its disc"),
    Subject("pole, square to its side",
            lambda: actors.pole(height=POLE_HEIGHT, radius=POLE_RADII[0], end_radius=POLE_RADII[1]), "mean", *CONE,
            "2 pi a L^2 / wavelength of a cylinder of its mean radius a", elevation=POLE_TILT),
)


@dataclasses.dataclass(frozen=True)
class Aspect:
    """What was found: azimuth [N] in rad from ahead to the left, sigma [N] in m^2."""

    subject: Subject
    azimuth: np.ndarray
    sigma: np.ndarray

    @property
    def mean(self) -> float:
        """dBsm, of the power."""
        return float(10.0 * np.log10(np.mean(self.sigma)))

    @property
    def median(self) -> float:
        """dBsm."""
        return float(10.0 * np.log10(np.median(self.sigma)))

    @property
    def peak(self) -> float:
        """dBsm, of the directions that were computed."""
        return float(10.0 * np.log10(np.max(self.sigma)))

    @property
    def is_within(self) -> bool | None:
        """Whether the statistic that is published lies in its band; None without one."""
        if self.subject.low is None:
            return None
        return self.subject.low <= getattr(self, self.subject.statistic) <= self.subject.high


def run_actors(folder, *, quick: bool = False, progress=None) -> list[Aspect]:
    """Writes actors.csv and actors.png into `folder`, returns what was found of each actor.

    quick: few azimuths and rays; progress: callable (stage, fraction) or None
    """
    found = [aspect_of(subject, quick=quick) for subject in told(SUBJECTS, "actors", progress)]
    rows = [{"actor": one.subject.name, "mean_dbsm": f"{one.mean:.1f}", "median_dbsm": f"{one.median:.1f}",
             "peak_dbsm": f"{one.peak:.1f}", "published": one.subject.statistic, "low": one.subject.low,
             "high": one.subject.high, "within": one.is_within, "source": one.subject.source} for one in found]
    write_texts(folder, {"actors.csv": csv_text(rows)})
    draw(found, Path(folder) / "actors.png")
    return found


def aspect_of(subject: Subject, *, quick: bool = False) -> Aspect:
    """Cross section of a subject over azimuth, vertical polarisation."""
    scene = ep.Scene()
    scene.add(subject.make(), name="actor")
    azimuth = np.radians(np.arange(0.0, 360.0, QUICK_AZIMUTH_STEP if quick else subject.step))
    level, rise = np.cos(subject.elevation), np.sin(subject.elevation)
    directions = np.stack([level * np.cos(azimuth), level * np.sin(azimuth), rise + 0.0 * azimuth], axis=-1)
    sigma = ep.rcs(scene, frequency=FREQUENCY, incidence=directions, num_rays=QUICK_NUM_RAYS if quick else NUM_RAYS)
    return Aspect(subject, azimuth, np.maximum(sigma, FLOOR))


def draw(found: list[Aspect], path) -> None:
    """Writes a PNG: cross section over aspect, a panel for each actor, with the published band."""
    with new_figure(9.6, 10.2) as figure:
        panels = list(figure.subplots(-(-len(found) // COLUMNS), COLUMNS, squeeze=False,
                                      subplot_kw={"projection": "polar"}).flat)
        for axes, one in zip(panels, found):
            _draw_panel(axes, one)
        for axes in panels[len(found):]:
            axes.set_visible(False)
        figure.suptitle("Cross section in dBsm by direction at 77 GHz (0\N{DEGREE SIGN}: from ahead). Green: published band or\n"
                        "closed form; dashed: the statistic that it is of; levels below the scale stand at the centre",
                        fontsize=11)
        save_png(figure, path, seed=FIXED_SEEDS)


def _draw_panel(axes, one: Aspect) -> None:
    levels = 10.0 * np.log10(one.sigma)
    low, high = one.subject.low, one.subject.high
    bottom = 10.0 * np.floor(min(levels.min(), np.inf if low is None else low) / 10.0)
    top = 10.0 * np.ceil(max(levels.max(), -np.inf if high is None else high) / 10.0)
    bottom = max(bottom, top - 50.0)
    around = np.append(one.azimuth, 2.0 * np.pi)
    axes.plot(around, np.maximum(np.append(levels, levels[0]), bottom), color="#0072b2", linewidth=1.2)
    circle = np.linspace(0.0, 2.0 * np.pi, 181)
    if low is not None:
        axes.fill_between(circle, max(low, bottom), high, color="#009e73", alpha=0.25, linewidth=0)
    value = getattr(one, one.subject.statistic)
    axes.plot(circle, np.full_like(circle, value), color="#d55e00", linewidth=1.2, linestyle="--")
    axes.set_theta_zero_location("N")
    axes.set_ylim(bottom, top)
    axes.set_title(for_pictures(f"{one.subject.name}\n{one.subject.statistic} {value:.1f} dBsm (dashed)"), fontsize=8)
    axes.tick_params(labelsize=6)


def describe(found: list[Aspect]) -> list[str]:
    """Lines for people."""
    lines = ["over azimuth, dBsm         mean  median    peak  published"]
    for one in found:
        known = one.subject.low is not None
        band = f"{one.subject.statistic} {one.subject.low:.1f} to {one.subject.high:.1f}" if known else "no band"
        said = {True: "within", False: "OUTSIDE", None: ""}[one.is_within]
        lines.append(f"{one.subject.name:24s} {one.mean:6.1f}  {one.median:6.1f}  {one.peak:6.1f}  {band:22s} {said:7s}  "
                     f"{one.subject.source}")
    return lines
