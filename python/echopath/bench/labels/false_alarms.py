"""False alarms of CFAR on pure noise, against the rate asked for."""
from __future__ import annotations

import dataclasses
import itertools
from typing import get_args

import numpy as np

import echopath as ep
from echopath.spectra.range_doppler import CfarMethod

NUM_CHIRPS, NUM_SAMPLES = 128, 512
RATES = (1e-3, 1e-4)
TARGET = 0.1      # of the rate, and what the count scatters by
OF_BEAMS = 0.2    # of the rate, by which tests in beams may have less: they overlap
SIGMAS = 3.0
MAIN_LOBE = 5     # cells of an unpadded map that the windows here do not exceed, rectangle to Chebyshev of 80 dB


@dataclasses.dataclass(frozen=True)
class NoiseMap:
    """What a map of noise is made with."""

    window: object = "hann"
    zero_pad: int = 1
    receivers: int = 1
    transmitters: int = 1
    real: bool = False
    low_pass: float | None = None  # Hz, of the filter of the receiver
    beams: bool = False            # tested in beams

    def __str__(self) -> str:
        kind = (", real" if self.real else "") + (", TDM" if self.transmitters > 1 else "")
        kind += "" if self.low_pass is None else f", {1e-6 * self.low_pass:g} MHz"
        kind += ", beams" if self.beams else ""
        return f"{self.window}, padded {self.zero_pad}, {self.receivers * self.transmitters} channels{kind}"


MAPS = (NoiseMap("rect"), NoiseMap("hann"), NoiseMap("hann", zero_pad=2), NoiseMap("hann", receivers=4),
        NoiseMap("hann", receivers=2, transmitters=2), NoiseMap("hann", real=True),
        NoiseMap("hann", receivers=4, low_pass=8e6), NoiseMap("hann", receivers=8, beams=True))


def measure_false_alarms(num_cells: int = 10_000_000, *, maps=MAPS, rates=RATES) -> list[dict]:
    """Thermal noise through the range-Doppler transform and CFAR, map after map until there are enough cells.

    num_cells: at least, for each row; maps: NoiseMap of each row; rates: of false alarms
    Of real samples the cells within the main lobe of range 0 are left out, where the image leaks.
    Returns rows {map, method, rate, cells, false_alarms, ratio, standard_error, holds}: ratio is that of the false alarms
    per cell to the rate, with its standard error from the scatter between maps; holds: within 10 % and three of these, of
    beams also up to 20 % below.
    """
    return [row for of_map in maps for row in _measure(num_cells, of_map, rates)]


def describe_false_alarms(rows: list[dict]) -> list[str]:
    """Lines for people: a row for each window, number of channels, method and rate."""
    lines = [f"{'false alarms of CFAR on noise':<40}{'rate':>8}{'cells':>12}{'found':>8}{'found / expected':>22}"]
    for row in rows:
        verdict = "holds" if row["holds"] else f"MISSED {TARGET:.0%}"
        lines.append(f"  {row['method'] + ' ' + row['map']:<38}{row['rate']:8.0e}{row['cells']:12d}{row['false_alarms']:8d}"
                     f"{row['ratio']:14.3f} +- {row['standard_error']:.3f}  {verdict}")
    return lines


def _measure(num_cells: int, of_map: NoiseMap, rates) -> list[dict]:
    radar = _radar(of_map)
    found = {(method, rate): [] for method in get_args(CfarMethod) for rate in rates}
    cells = 0
    for seed in itertools.count():
        spectrum = _noise(radar, of_map, seed)
        first = MAIN_LOBE * of_map.zero_pad if of_map.real else 0
        for (method, rate), counts in found.items():
            cfar = ep.cfar(spectrum, radar, method=method, false_alarm_rate=rate, beams=of_map.beams)
            counts.append(np.count_nonzero(cfar.cells[:, 1] >= first))
        cells += len(spectrum.velocity) * (len(spectrum.range) - first)
        if cells >= num_cells and seed > 0:
            break
    least = 1.0 - (OF_BEAMS if of_map.beams else TARGET)
    return [{"map": str(of_map)} | _row(method, rate, np.array(counts), cells, least)
            for (method, rate), counts in found.items()]


def _noise(radar, of_map: NoiseMap, seed: int):
    shape = (of_map.transmitters, of_map.receivers, NUM_CHIRPS, NUM_SAMPLES)
    cube = ep.receive(np.zeros(shape, complex), radar, seed=seed).cube
    return ep.range_doppler(cube, radar, window=of_map.window, zero_pad=of_map.zero_pad)


def _row(method: str, rate: float, counts, cells: int, least: float) -> dict:
    ratio = float(counts.sum() / (rate * cells))
    error = float(np.sqrt(len(counts)) * counts.std(ddof=1) / (rate * cells))
    return {"method": method, "rate": rate, "cells": cells, "false_alarms": int(counts.sum()), "ratio": ratio,
            "standard_error": error,
            "holds": bool(least - SIGMAS * error <= ratio <= 1.0 + TARGET + SIGMAS * error)}


def _radar(of_map: NoiseMap) -> ep.Radar:
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=NUM_SAMPLES, sampling_rate=20e6,
                                num_chirps=NUM_CHIRPS, chirp_interval=60e-6, real=of_map.real)
    return ep.Radar(waveform, transmitters=[ep.Antenna((0.0, 0.002 * index, 0.0)) for index in range(of_map.transmitters)],
                    receivers=[ep.Antenna((0.0, 0.002 * index, 0.0)) for index in range(of_map.receivers)],
                    receiver=None if of_map.low_pass is None else ep.Receiver(low_pass=of_map.low_pass))
