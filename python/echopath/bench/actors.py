"""`echopath bench actors`: cross sections of the actors over aspect beside published ones, as figures and a picture.

Power is averaged over azimuth at level incidence. The mean of large smooth bodies is made by a few flashes, so that their
median says more of a usual aspect; both are given.
"""
from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path

import numpy as np

import echopath as ep

from .. import actors
from ..base.files import write_texts
from ..base.origin import FIXED_SEEDS
from ..plots.style import new_figure, save_png
from ..signals.measures import for_pictures
from .steps import csv_text, told

FREQUENCY = 77e9                     # Hz
AZIMUTH_STEP, QUICK_AZIMUTH_STEP = 5.0, 30.0   # deg
NUM_RAYS, QUICK_NUM_RAYS = 2 ** 16, 2 ** 13
FLOOR = 1e-5                         # m^2, least cross section that is shown

MEMORY = "quoted from memory, unverified"
JRC = "Fortuny-Guasch, Chareau, EUR 25762 EN 2013: means over azimuth of 2 adults, 76-81 GHz"
NAKAMURA = "Nakamura, Hadama, IEICE ComEx 9 (2020) 262: means of 5 drones, -8.1 to -19.1 dBsm, at 24 GHz; more at 79 GHz"


@dataclasses.dataclass(frozen=True)
class Subject:
    """An actor, and what is published of it: a band from low to high in dBsm of the statistic, "mean" or "median"."""

    name: str
    make: Callable
    statistic: str
    low: float
    high: float
    source: str


SUBJECTS = (
    Subject("car, compact", lambda: actors.car(), "median", -5.0, 15.0, f"usual aspects of cars at 76 GHz; {MEMORY}"),
    Subject("car, SUV", lambda: actors.car(kind="suv"), "median", -5.0, 15.0, f"usual aspects of cars at 76 GHz; {MEMORY}"),
    Subject("van", lambda: actors.van(), "median", 0.0, 20.0, f"usual aspects of vans; {MEMORY}"),
    Subject("truck", lambda: actors.truck(), "median", 10.0, 30.0, f"usual aspects of trucks; {MEMORY}"),
    Subject("motorcycle with rider", lambda: actors.motorcycle(), "median", -5.0, 10.0, f"77 GHz; {MEMORY}"),
    Subject("cyclist", lambda: actors.cyclist(), "mean", -8.0, 3.0, f"bicyclists at 77 GHz; {MEMORY}"),
    Subject("pedestrian", lambda: actors.pedestrian(), "mean", -6.9, -3.5, JRC),
    Subject("runner", lambda: actors.runner(), "mean", -6.9, -3.5, f"of standing adults: {JRC}"),
    Subject("child of 1.15 m", lambda: actors.child(), "mean", -14.0, -7.0, f"{MEMORY}; none was found"),
    Subject("dog", lambda: actors.dog(), "mean", -15.0, -5.0, f"{MEMORY}; none was found"),
    Subject("drone", lambda: actors.drone(rotor_rpm=0.0), "mean", -19.1, -5.0, NAKAMURA),
    Subject("tree", lambda: actors.tree(), "mean", -4.0, 6.0,
            f"-15 to -8 dB a square metre of crown (14 m^2) at 95 GHz; {MEMORY}"),
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
    def is_within(self) -> bool:
        """Whether the statistic that is published lies in its band."""
        return self.subject.low <= getattr(self, self.subject.statistic) <= self.subject.high


def run_actors(folder, *, quick: bool = False, progress=None) -> list[Aspect]:
    """Writes actors.csv and actors.png into `folder`, returns what was found of each actor.

    quick: few azimuths and rays; progress: callable (stage, fraction) or None
    """
    found = [aspect_of(subject, quick=quick) for subject in told(SUBJECTS, "actors", progress)]
    rows = [{"actor": one.subject.name, "mean_dbsm": f"{one.mean:.1f}", "median_dbsm": f"{one.median:.1f}",
             "published": one.subject.statistic, "low": one.subject.low, "high": one.subject.high, "within": one.is_within,
             "source": one.subject.source} for one in found]
    write_texts(folder, {"actors.csv": csv_text(rows)})
    draw(found, Path(folder) / "actors.png")
    return found


def aspect_of(subject: Subject, *, quick: bool = False) -> Aspect:
    """Cross section of a subject over azimuth, vertical polarisation."""
    scene = ep.Scene()
    scene.add(subject.make(), name="actor")
    azimuth = np.radians(np.arange(0.0, 360.0, QUICK_AZIMUTH_STEP if quick else AZIMUTH_STEP))
    directions = np.stack([np.cos(azimuth), np.sin(azimuth), 0.0 * azimuth], axis=-1)
    sigma = ep.rcs(scene, frequency=FREQUENCY, incidence=directions, num_rays=QUICK_NUM_RAYS if quick else NUM_RAYS)
    return Aspect(subject, azimuth, np.maximum(sigma, FLOOR))


def draw(found: list[Aspect], path) -> None:
    """Writes a PNG: cross section over aspect, a panel for each actor, with the published band."""
    with new_figure(9.6, 7.9) as figure:
        panels = figure.subplots(3, 4, subplot_kw={"projection": "polar"}).flat
        for axes, one in zip(panels, found):
            _draw_panel(axes, one)
        figure.suptitle("Cross section in dBsm by direction at 77 GHz (0\N{DEGREE SIGN}: from ahead). "
                        "Green: published band; dashed: the statistic that it is of; "
                        "levels below the scale stand at the centre", fontsize=11)
        save_png(figure, path, seed=FIXED_SEEDS)


def _draw_panel(axes, one: Aspect) -> None:
    levels = 10.0 * np.log10(one.sigma)
    bottom, top = 10.0 * np.floor(min(levels.min(), one.subject.low) / 10.0), 10.0 * np.ceil(levels.max() / 10.0)
    bottom = max(bottom, top - 50.0)
    around = np.append(one.azimuth, 2.0 * np.pi)
    axes.plot(around, np.maximum(np.append(levels, levels[0]), bottom), color="#0072b2", linewidth=1.2)
    circle = np.linspace(0.0, 2.0 * np.pi, 181)
    axes.fill_between(circle, max(one.subject.low, bottom), one.subject.high, color="#009e73", alpha=0.25, linewidth=0)
    value = getattr(one, one.subject.statistic)
    axes.plot(circle, np.full_like(circle, value), color="#d55e00", linewidth=1.2, linestyle="--")
    axes.set_theta_zero_location("N")
    axes.set_ylim(bottom, max(top, one.subject.high))
    axes.set_title(for_pictures(f"{one.subject.name}\n{one.subject.statistic} {value:.1f} dBsm (dashed)"), fontsize=8)
    axes.tick_params(labelsize=6)


def describe(found: list[Aspect]) -> list[str]:
    """Lines for people."""
    lines = ["actor                    mean    median   published              "]
    for one in found:
        band = f"{one.subject.statistic} {one.subject.low:.1f} to {one.subject.high:.1f}"
        lines.append(f"{one.subject.name:24s} {one.mean:6.1f}  {one.median:6.1f}  {band:22s} "
                     f"{'within' if one.is_within else 'OUTSIDE'}  {one.subject.source}")
    return lines
