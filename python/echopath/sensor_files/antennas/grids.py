"""Tables of gain, and phase, over two angles."""
from __future__ import annotations

import cmath
import contextlib
import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ... import _core
from .columns import OWN, Head, head_of, is_head

ANGLE_DIGITS = 6        # of angles in degrees: samples that agree in them belong to one row or column
ROUNDED = 1e-3          # degrees off a quarter of a turn: 3.1416 rad is half a turn
SAME_FIELD = 2e-3       # two samples of one direction differ by less of their field, written in dB with two digits,
OF_PEAK = 1e-4          # and of that of the peak

Samples = dict[tuple[float, float], tuple[int, float, float]]  # by both angles: the number of the line, dB and degrees


class Grid(NamedTuple):
    """Samples over every pair of two angles."""

    azimuth_deg: NDArray[np.float64]     # [A], of a file over theta and phi its phi
    elevation_deg: NDArray[np.float64]   # [E], of a file over theta and phi 90 - theta
    gain_db: NDArray[np.float64]         # [E, A]
    phase_deg: NDArray[np.float64] | None
    is_spherical: bool                   # over theta and phi, in axes of the file's own
    is_directivity: bool                 # whose mean is 1 by its meaning, up to what solvers miss of the radiated power

    def table(self, normalize: bool = False) -> _core.AntennaPattern:
        """The pattern in the frame that the angles count from. A directivity of a mean above 1 is scaled to it."""
        with np.errstate(over="ignore"):  # which the table refuses
            gain = 10.0 ** (self.gain_db / 10.0)

        def made(normalize: bool) -> _core.AntennaPattern:
            return _core.GainTable(azimuth=np.radians(self.azimuth_deg), elevation=np.radians(self.elevation_deg), gain=gain,
                                   phase=None if self.phase_deg is None else np.radians(self.phase_deg), normalize=normalize)

        return made(normalize or (self.is_directivity and made(True).peak_gain < gain.max()))


def read_grid(lines: list[str]) -> Grid:
    """Of the lines of a file. Raises ValueError naming the line."""
    numbered = [(number, line) for number, line in enumerate(lines, 1) if line.strip(" \t-")]  # CST rules off its head
    plain = [(number, line) for number, line in numbered if not line.startswith("#")]
    # Solvers head their tables by a comment; other comments may name the angles, too.
    others = [plain[0]] if plain and is_head(plain[0][1]) else numbered
    start = next(((number, line) for number, line in others if is_head(line)), plain[0] if plain else None)
    if start is None:
        raise ValueError(f"holds no line of column names, {', '.join(OWN[:3])}")
    with _line(start[0]):
        head = head_of(start[1])
    samples = _samples(head, [(number, line) for number, line in plain if number > start[0]])
    return _grid(head, samples)


@contextlib.contextmanager
def _line(number: int) -> Iterator[None]:
    """Blames the line of a number for the ValueErrors of its body."""
    try:
        yield
    except ValueError as error:
        raise ValueError(f"line {number}: {error}") from None


def _samples(head: Head, numbered: list[tuple[int, str]]) -> Samples:
    found: Samples = {}
    again = []
    for number, line in numbered:
        with _line(number):
            texts = head.texts(line)
            first, second = (_angle(column.read(texts)) for column in head.angles)
            key = _phi_and_elevation(first, second) if head.is_spherical else _azimuth_and_elevation(first, second)
            value = head.gain.read(texts), 0.0 if head.phase is None else head.phase.read(texts)
            if key in found and not head.is_spherical:
                raise ValueError(f"direction ({first:g}, {second:g}) deg stands already in line {found[key][0]}")
            if key in found:
                again.append((number, first, second, key, value))
            found.setdefault(key, (number, *value))
    peak = max((abs(_field(gain, 0.0)) for _, gain, _ in found.values()), default=0.0)
    for number, first, second, key, value in again:
        one, other = _field(*found[key][1:]), _field(*value)
        if not abs(one - other) <= SAME_FIELD * max(abs(one), abs(other)) + OF_PEAK * peak:
            raise ValueError(f"line {number}: direction ({first:g}, {second:g}) deg stands already in line {found[key][0]} with "
                             "another gain; a file holds one pattern, at one frequency")
    return found


def _angle(degrees: float) -> float:
    quarter = 90.0 * round(degrees / 90.0)
    return quarter if abs(degrees - quarter) < ROUNDED else round(degrees, ANGLE_DIGITS)


def _field(gain_db: float, phase_deg: float) -> complex:
    """Kept within what numbers hold: a gain that is too large is told of later."""
    return 10.0 ** (min(gain_db, 3000.0) / 20.0) * cmath.exp(1j * math.radians(phase_deg))


def _azimuth_and_elevation(azimuth: float, elevation: float) -> tuple[float, float]:
    if abs(elevation) > 90.0:
        raise ValueError(f"elevation_deg must lie in [-90, 90], got {elevation:g}; it counts from the xy-plane")
    return azimuth, elevation


def _phi_and_elevation(phi: float, theta: float) -> tuple[float, float]:
    """phi from 0 to 360 and 90 - theta in degrees: a negative theta is a positive one on the other side."""
    if abs(theta) > 180.0:
        raise ValueError(f"theta must lie in [-180, 180] deg, got {theta:g}; it counts from the z axis")
    return round((phi + (180.0 if theta < 0.0 else 0.0)) % 360.0, ANGLE_DIGITS) % 360.0, 90.0 - abs(theta)


def _grid(head: Head, samples: Samples) -> Grid:
    if not samples:
        raise ValueError("holds no directions")
    azimuths, elevations = (sorted({key[axis] for key in samples}) for axis in (0, 1))
    if head.is_spherical:
        _fill_poles(samples, azimuths, elevations)
    names = ("phi_deg", "theta_deg") if head.is_spherical else OWN[:2]
    for name, angles in zip(names, (azimuths, elevations)):
        if len(angles) < 2:
            raise ValueError(f"{name} must have at least 2 values, got {angles[0]:g} alone; one cut makes no pattern")
    if azimuths[-1] - azimuths[0] > 360.0:
        raise ValueError(f"azimuth_deg must cover at most 360, got {azimuths[0]:g} to {azimuths[-1]:g}")
    for elevation in elevations:
        for azimuth in azimuths:
            if (azimuth, elevation) not in samples:
                second = 90.0 - elevation if head.is_spherical else elevation
                raise ValueError(f"direction ({azimuth:g}, {second:g}) deg is missing; every {names[0][:-4]} needs every "
                                 f"{names[1][:-4]}")

    def column(index: int) -> NDArray[np.float64]:
        return np.array([[samples[azimuth, elevation][index] for azimuth in azimuths] for elevation in elevations])

    return Grid(np.array(azimuths), np.array(elevations), column(1), None if head.phase is None else column(2), head.is_spherical,
                head.is_directivity)


def _fill_poles(samples: Samples, phis: list[float], elevations: list[float]) -> None:
    """Gives a pole, which is one direction, a sample at every phi: files have it at one phi alone, or at half of them."""
    for pole in (elevation for elevation in elevations if abs(elevation) == 90.0):
        at_pole = next(samples[phi, pole] for phi in phis if (phi, pole) in samples)
        for phi in phis:
            samples.setdefault((phi, pole), at_pole)
