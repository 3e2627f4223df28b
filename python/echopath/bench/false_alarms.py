"""False alarms of CFAR on pure noise, against the rate asked for."""
from __future__ import annotations

import numpy as np

import echopath as ep

NUM_CHIRPS, NUM_SAMPLES = 128, 512
RATES = (1e-3, 1e-4)
WINDOWS = (("rect", 1, 1), ("hann", 1, 1), ("hann", 2, 1), ("hann", 1, 4))  # window, zero_pad, receivers


def measure_false_alarms(num_cells: int = 10_000_000, *, windows=WINDOWS, rates=RATES) -> list[dict]:
    """Thermal noise through the range-Doppler transform and CFAR, map after map until there are enough cells.

    num_cells: at least, for each row; windows: (window, zero_pad, receivers) of each row; rates: of false alarms
    Returns rows {window, zero_pad, channels, method, rate, cells, false_alarms, ratio, standard_error}: ratio is that of the
    false alarms per cell to the rate, with its standard error from the scatter between maps.
    """
    return [row for window, zero_pad, receivers in windows
            for row in _measure(num_cells, window, zero_pad, receivers, rates)]


def describe_false_alarms(rows: list[dict]) -> list[str]:
    """Lines for people: a row for each window, number of channels, method and rate."""
    lines = [f"{'false alarms of CFAR on noise':<32}{'rate':>8}{'cells':>12}{'found':>8}{'found / expected':>22}"]
    for row in rows:
        what = f"{row['method']} {row['window']}, padded {row['zero_pad']}, {row['channels']} channels"
        lines.append(f"  {what:<30}{row['rate']:8.0e}{row['cells']:12d}{row['false_alarms']:8d}"
                     f"{row['ratio']:14.3f} +- {row['standard_error']:.3f}")
    return lines


def _measure(num_cells: int, window, zero_pad: int, receivers: int, rates) -> list[dict]:
    radar = _radar(receivers)
    cells_per_map = NUM_CHIRPS * NUM_SAMPLES * zero_pad ** 2
    found = {(method, rate): [] for method in ("ca", "os") for rate in rates}
    for seed in range(-(-num_cells // cells_per_map)):
        cube = ep.add_noise(np.zeros((1, receivers, NUM_CHIRPS, NUM_SAMPLES), complex), radar, seed=seed)
        spectrum = ep.range_doppler(cube, radar, window=window, zero_pad=zero_pad)
        for (method, rate), counts in found.items():
            counts.append(len(ep.cfar(spectrum, radar, method=method, false_alarm_rate=rate)))
    common = {"window": window, "zero_pad": zero_pad, "channels": receivers}
    return [common | _row(method, rate, np.array(counts), cells_per_map) for (method, rate), counts in found.items()]


def _row(method: str, rate: float, counts, cells_per_map: int) -> dict:
    expected = rate * cells_per_map * len(counts)
    return {"method": method, "rate": rate, "cells": cells_per_map * len(counts), "false_alarms": int(counts.sum()),
            "ratio": float(counts.sum() / expected),
            "standard_error": float(np.sqrt(len(counts)) * counts.std(ddof=1) / expected)}


def _radar(receivers: int) -> ep.Radar:
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=NUM_SAMPLES, sampling_rate=20e6,
                                num_chirps=NUM_CHIRPS, chirp_interval=60e-6)
    return ep.Radar(waveform, transmitters=[ep.Antenna()],
                    receivers=[ep.Antenna((0.0, 0.002 * index, 0.0)) for index in range(receivers)])
