"""What each fault and code costs for the cube of a street, in processor time."""
from __future__ import annotations

import numpy as np

import echopath as ep

from ..timing import processor_time
from . import street

REPEATS, QUICK_REPEATS = 5, 1
FAULTS = {
    "none": None, "a Receiver without faults": {},
    "phase noise": {"phase_noise": {"offsets": [1e4, 1e5, 1e6, 1e7], "levels": [-70, -85, -95, -115]}},
    "frequency error": {"frequency_error": (0.0, 0.0, 1e15)},
    "leakage": {"leakage_db": np.full((street.NUM_TX, street.NUM_RX), -35.0), "leakage_delay": 0.5e-9},
    "coupling": {"coupling_db": np.full((street.NUM_RX, street.NUM_RX), -25.0), "coupling_delay": 1e-11},
    "errors of receivers": {"receiver_gain_db": [0.0, 0.5, -0.5, 0.2], "phase_drift": [0.0, 0.1, 0.2, 0.3]},
    "compression": {"compression_dbm": -20.0}, "filters": {"high_pass": [175e3, 350e3], "low_pass": 9e6},
    "imbalance": {"iq_gain_db": 0.3, "iq_phase": 0.03}, "converter": {"adc": {"bits": 12, "automatic_gain": True}},
    "converter with jitter": {"adc": {"bits": 12, "automatic_gain": True, "clock_jitter": 1e-12}}}


def rows(*, quick: bool) -> list[dict]:
    """[what, seconds, seconds beyond the thermal noise] of `receive` with each fault, of `demultiplex` and `interference`."""
    num_rays, repeats = (street.QUICK_NUM_RAYS, QUICK_REPEATS) if quick else (street.NUM_RAYS, REPEATS)
    paths, cube, found = street.paths(num_rays), street.cube(num_rays), {}
    for name, faults in FAULTS.items():
        radar = street.radar(receiver=None if faults is None else ep.Receiver(**faults))
        found[name] = _seconds(lambda: ep.receive(cube, radar, seed=1), repeats)
    for kind in ("ddm", "bpm"):
        radar = street.radar(multiplexing=kind)
        coded = ep.synthesize(paths, radar)
        found[f"demultiplex {kind}"] = found["none"] + _seconds(lambda: ep.demultiplex(coded, radar), repeats)
    radar, other = street.radar(), street.other()
    between = ep.trace(street.scene(), ep.interference_radar(radar, other), num_rays=num_rays)
    for name, ways in (("direct way", None), ("paths", between)):
        found[f"another radar, {name}"] = found["none"] + _seconds(lambda: ep.interference(radar, other, ways), repeats)
    return [{"what": name, "seconds": value, "beyond": value - found["none"]} for name, value in found.items()]


def describe(rows: list[dict]) -> list[str]:
    """Lines for people."""
    shape = f"{street.NUM_TX} x {street.NUM_RX} channels, {street.NUM_CHIRPS} chirps of 512 samples"
    lines = [f"processor time in s, {shape}", f"{'fault':<46}{'with the noise':>16}{'alone':>10}"]
    return lines + [f"{row['what']:<46}{row['seconds']:16.3f}{row['beyond']:10.3f}" for row in rows]


def _seconds(work, repeats: int) -> float:
    """Median of the processor time of some runs, s."""
    return float(np.median([processor_time(work)[0] for _ in range(repeats)]))
