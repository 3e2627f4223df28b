"""Antenna patterns in CSV files."""
from __future__ import annotations

import csv
import math
import os
from pathlib import Path

import numpy as np

from .. import _core
from ..arguments.checks import checked, flag
from ..base.storage.files import bytes_of

COLUMNS = ("azimuth_deg", "elevation_deg", "gain_db", "phase_deg")
REQUIRED = COLUMNS[:3]
ANGLE_DIGITS = 6  # of angles in degrees: samples that agree in them belong to one row or column


@checked(normalize=flag)
def load_antenna(path: str | os.PathLike[str], *, normalize: bool = False) -> _core.AntennaPattern:
    """Reads an antenna pattern from a CSV file.

    path: of a text file with a line of column names and then a line for each direction, in any order: azimuth_deg and
        elevation_deg in the antenna's frame (boresight +x, azimuth about z to the left, elevation from the
        xy-plane), gain_db over isotropic ("-inf": none) and optionally phase_deg. Every azimuth needs every
        elevation. Empty lines and lines that begin with # are passed over.
    normalize: True scales the gain to a mean of 1 over the sphere, as of an antenna without losses
    Returns an AntennaPattern as `GainTable` makes it. Raises FileError naming the file, and the line if there is one.
    """
    path = Path(path)
    try:
        lines = bytes_of(path).decode("utf-8-sig").splitlines()  # with a byte-order mark, too
    except UnicodeDecodeError as error:
        raise _core.FileError(f"{path}: is not UTF-8 text (byte {error.start})") from None
    numbered = [(number, line) for number, line in enumerate(lines, 1) if line.strip() and not line.startswith("#")]
    try:
        return _pattern(*_grid(*_samples(numbered)), normalize)
    except ValueError as error:
        raise _core.FileError(f"{path}: {error}") from None


def _samples(numbered):
    """(column names, {(azimuth, elevation) in degrees: (line number, other values)})."""
    if not numbered:
        raise ValueError(f"holds no line of column names, {', '.join(REQUIRED)}")
    number, header = numbered[0]
    names = [name.strip() for name in next(csv.reader([header]))]
    _check_names(names, number)
    samples = {}
    for number, line in numbered[1:]:
        values = dict(zip(names, _numbers(next(csv.reader([line])), names, number)))
        key = (round(values["azimuth_deg"], ANGLE_DIGITS), round(values["elevation_deg"], ANGLE_DIGITS))
        if abs(key[1]) > 90.0:
            raise ValueError(f"line {number}: elevation_deg must lie in [-90, 90], got {key[1]:g}; it counts from the xy-plane")
        if key in samples:
            raise ValueError(f"line {number}: direction ({key[0]:g}, {key[1]:g}) deg stands already in line "
                             f"{samples[key][0]}")
        samples[key] = (number, values)
    return names, samples


def _check_names(names: list, number: int) -> None:
    for name in names:
        if name not in COLUMNS or names.count(name) > 1:
            rule = "stands twice" if name in COLUMNS else f"is none of {', '.join(COLUMNS)}"
            raise ValueError(f"line {number}: column '{name}' {rule}")
    for name in REQUIRED:
        if name not in names:
            raise ValueError(f"line {number}: column '{name}' is missing")


def _numbers(texts: list, names: list, number: int) -> list:
    if len(texts) != len(names):
        raise ValueError(f"line {number}: must have {len(names)} values, has {len(texts)}")
    values = []
    for name, text in zip(names, texts):
        try:
            values.append(float(text))
        except ValueError:
            raise ValueError(f"line {number}: {name} must be a number, got '{text.strip()}'") from None
        if not (math.isfinite(values[-1]) or (name == "gain_db" and values[-1] == -math.inf)):
            raise ValueError(f"line {number}: {name} must be finite, got '{text.strip()}'")
    return values


def _grid(names: list, samples: dict):
    """Azimuths [A], elevations [E] in degrees, gain in dB and phase in degrees or None [E, A]."""
    if not samples:
        raise ValueError("holds no directions")
    azimuths, elevations = (sorted({key[axis] for key in samples}) for axis in (0, 1))
    for name, angles in (("azimuth_deg", azimuths), ("elevation_deg", elevations)):
        if len(angles) < 2:
            raise ValueError(f"{name} must have at least 2 values, got {angles[0]:g} alone; one cut makes no pattern")
    if azimuths[-1] - azimuths[0] > 360.0:
        raise ValueError(f"azimuth_deg must cover at most 360, got {azimuths[0]:g} to {azimuths[-1]:g}")
    for elevation in elevations:
        for azimuth in azimuths:
            if (azimuth, elevation) not in samples:
                raise ValueError(f"direction ({azimuth:g}, {elevation:g}) deg is missing; every azimuth needs every "
                                 "elevation")

    def column(name: str):
        return np.array([[samples[azimuth, elevation][1][name] for azimuth in azimuths] for elevation in elevations])

    return azimuths, elevations, column("gain_db"), column("phase_deg") if "phase_deg" in names else None


def _pattern(azimuth_deg, elevation_deg, gain_db, phase_deg, normalize: bool):
    with np.errstate(over="ignore"):  # which the table refuses
        gain = 10.0 ** (gain_db / 10.0)
    return _core.GainTable(azimuth=np.radians(azimuth_deg), elevation=np.radians(elevation_deg), gain=gain,
                           phase=None if phase_deg is None else np.radians(phase_deg), normalize=normalize)
