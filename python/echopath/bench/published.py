"""`echopath bench targets`: levels of materials and actors beside published ones, and how far they are apart.

Where a model has no closed form to be held against, measurements say what it must come to: a pedestrian's cross section, the
polarisations of a road. Spheres between two antennas are held against Mie.
"""
from __future__ import annotations

import dataclasses
import math

import numpy as np

import echopath as ep

from ..actors import shapes
from ..base.storage.files import write_texts
from ..effects.surfaces import bistatic_limit_deg
from .steps import csv_text, told

FREQUENCY = 77e9                     # Hz
AZIMUTH_STEP, QUICK_AZIMUTH_STEP = 5.0, 15.0   # deg
PEDESTRIAN_RAYS = 2 ** 16
NUM_LOOKS = 64                       # realisations of a body's random phases
ROAD_HEIGHT = 0.5e-3                 # m, rms: asphalt concrete of grain 11 mm
ROAD_ANGLES = (63.0, 70.0)           # deg from the normal: Brewster's angle of the mean surface, and beyond
ROAD_RAYS, SPHERE_RAYS = 2 ** 12, 2 ** 16
SPHERE_RADIUS = 0.1                  # m
SPHERE_ANGLES = (30.0, 60.0, 90.0, 100.0, 110.0, 120.0, 130.0, 140.0, 150.0)   # deg between both ways
SPHERE_BAND_DB = 0.1                 # up to the angle where physical optics holds (effects, bistatic_limit_deg)

JRC = "Fortuny-Guasch, Chareau, EUR 25762 EN (JRC78619) 2013: 2 adults, 4 garments, 76-81 GHz, as others quote its tables"
YAMADA = "quoted from memory (Yamada et al. 2005, 76 GHz)"
LOOKS = "90 % of values from -20.7 to -4.8 dBsm at 79 GHz: quoted by others, its first source was not found"
TR38901 = "3GPP TR 38.901 V19, table 7.9.2.1-1: log-normal deviation of a human, below 52.6 GHz, as others quote it"
ROAD = "quoted from memory (Li, Sarabandi 1999, 94 GHz, 70-88 deg); the paper's tables could not be read"
MIE = "Mie series"


@dataclasses.dataclass(frozen=True)
class Comparison:
    """One level of the model beside what is published: values in dB or dBsm, a band from `low` to `high`.

    is_held: whether the model is meant to lie within the band; others are beyond the validity that they show
    """

    name: str
    unit: str
    model: float
    low: float
    high: float
    source: str
    is_held: bool = True

    @property
    def published(self) -> float:
        """The middle of the band, or the end that it has."""
        if math.isinf(self.high):
            return self.low
        return 0.5 * (self.low + self.high)

    @property
    def deviation(self) -> float:
        """In dB from the published value."""
        return self.model - self.published

    @property
    def is_within(self) -> bool:
        """Whether the model lies in the band, to the rounding of a record's floats."""
        return self.low - 1e-3 <= self.model <= self.high + 1e-3


def run_published(folder, *, quick: bool = False, progress=None) -> list[Comparison]:
    """Compares all, writes targets.csv into `folder`, returns the comparisons.

    quick: few azimuths; progress: callable (stage, fraction) or None
    """
    works = [lambda: pedestrian(QUICK_AZIMUTH_STEP if quick else AZIMUTH_STEP), road, spheres]
    found = [comparison for work in told(works, "targets", progress) for comparison in work()]
    rows = [{"target": one.name, "unit": one.unit, "model": f"{one.model:.3f}", "published_low": one.low,
             "published_high": one.high, "deviation": f"{one.deviation:.3f}", "within": one.is_within, "source": one.source}
            for one in found]
    write_texts(folder, {"targets.csv": csv_text(rows)})
    return found


def describe(rows: list[Comparison]) -> list[str]:
    """Lines of a table for people."""
    lines = [f"{'target':46} {'model':>7}      {'published':>16} {'off its middle':>15}"]
    for row in rows:
        band = f">= {row.low:.1f}" if math.isinf(row.high) else f"{row.low:.1f} to {row.high:.1f}"
        verdict = "within" if row.is_within else "OUTSIDE" if row.is_held else "outside, where the model is not valid"
        lines.append(f"{row.name:46} {row.model:7.2f} {row.unit:4} {band:>16} {row.deviation:+12.2f} dB  {verdict}")
    sources = dict.fromkeys(row.source for row in rows)
    return [*lines, "sources", *(f"  {', '.join(_short(rows, source))}: {source}" for source in sources)]


def _short(rows, source) -> list[str]:
    """The targets that share a source, each kind once."""
    return list(dict.fromkeys(row.name.split(",")[0] for row in rows if row.source == source))


def pedestrian_rcs(step_deg: float = AZIMUTH_STEP, num_rays: int = PEDESTRIAN_RAYS, **keywords) -> dict:
    """Coherent and diffuse cross sections [A] in m^2 of a walking person over azimuth, by `ep.rcs`."""
    scene = ep.Scene()
    scene.add(ep.actors.pedestrian(), name="pedestrian")
    azimuth = np.radians(np.arange(0.0, 360.0, step_deg))
    directions = np.stack([np.cos(azimuth), np.sin(azimuth), 0.0 * azimuth], axis=1)
    return ep.rcs(scene, frequency=FREQUENCY, incidence=directions, num_rays=num_rays, components=True, **keywords)


def pedestrian(step_deg: float = AZIMUTH_STEP) -> list[Comparison]:
    found = pedestrian_rcs(step_deg)
    mean = _db(np.mean(found["coherent"] + found["diffuse"]))
    looks = _db(single_looks(found["coherent"], found["diffuse"]))
    spread = np.ptp(np.percentile(looks, [5.0, 95.0]))
    return [Comparison("pedestrian, mean over azimuth", "dBsm", mean, -6.86, -3.51, JRC),
            Comparison("pedestrian, the same", "dBsm", mean, -11.0, -5.0, YAMADA),
            Comparison("pedestrian, median of single looks", "dBsm", float(np.median(looks)), -12.1, -6.1, YAMADA),
            Comparison("pedestrian, 5 to 95 % of single looks", "dB", float(spread), 10.0, 20.0, LOOKS),
            Comparison("pedestrian, deviation of single looks", "dB", float(looks.std()), 3.9, 6.5, TR38901)]


def single_looks(coherent, diffuse):
    """Cross sections [NUM_LOOKS, A] in m^2 that single maps show: the coherent field and one realisation of the diffuse
    one, whose phases are random."""
    random = np.random.default_rng(1)
    size = (NUM_LOOKS, len(diffuse))
    field = (random.standard_normal(size) + 1j * random.standard_normal(size)) * np.sqrt(0.5 * diffuse)
    return np.abs(np.sqrt(np.maximum(coherent, 0.0)) + field) ** 2


def road() -> list[Comparison]:
    scene = ep.Scene()
    material = ep.materials["asphalt"].replace(roughness_height=ROAD_HEIGHT)
    scene.add(shapes.ground((1.0, 1.0)), name="road", material=material)
    rows = []
    for angle in ROAD_ANGLES:
        toward = (math.sin(math.radians(angle)), 0.0, math.cos(math.radians(angle)))
        vv, hh, vh = ep.rcs(scene, frequency=FREQUENCY, incidence=toward, num_rays=ROAD_RAYS, components=True,
                            polarization=["vv", "hh", "vh"])["diffuse"]
        rows += [Comparison(f"road, VV over HH at {angle:g} deg", "dB", _db(vv / hh), 0.0, math.inf, ROAD),
                 Comparison(f"road, VH over VV at {angle:g} deg", "dB", _db(vh / vv), -12.0, -8.0, ROAD)]
    return rows


def spheres() -> list[Comparison]:
    scene = ep.Scene()
    scene.add(shapes.sphere(SPHERE_RADIUS, subdivisions=32), name="sphere", material=ep.Material.metal(), smooth=True)
    size = 2.0 * math.pi * FREQUENCY / ep.speed_of_light * SPHERE_RADIUS
    limit = bistatic_limit_deg(SPHERE_RADIUS, FREQUENCY)
    rows = []
    for angle in SPHERE_ANGLES:
        half = math.radians(angle)
        found = ep.rcs(scene, frequency=FREQUENCY, incidence=(1.0, 0.0, 0.0), num_rays=SPHERE_RAYS, max_bounces=1,
                       observation=(math.cos(half), math.sin(half), 0.0))
        truth = ep.mie_rcs(SPHERE_RADIUS, FREQUENCY, half, plane="H")
        rows.append(Comparison(f"sphere of ka {size:.0f}, {angle:g} deg between both ways", "dB", _db(found / truth),
                               -SPHERE_BAND_DB, SPHERE_BAND_DB, MIE, angle <= limit))
    return rows


def _db(ratio):
    return 10.0 * np.log10(ratio) if np.ndim(ratio) else 10.0 * math.log10(ratio)
