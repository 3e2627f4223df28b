"""Whether two radars have the same echoes before what their receivers make of them."""
from __future__ import annotations

import numpy as np

WAVEFORM_KINDS = {"start_frequency": float, "bandwidth": float, "num_samples": int, "sampling_rate": float,
                  "num_chirps": int, "chirp_interval": float, "real": bool}
WAVEFORM_LISTS = ("extra_idle", "frequency_steps", "bandwidth_steps")
_NUM_TIMES = 5  # at which motions are compared, over the frame


def difference(radar, other, start_time: float = 0.0) -> str:
    """The name of the first field in which two radars differ, "" where the same echoes come to their antennas.

    Noise figure and faults of the receiver may differ: paths and their ideal signals know nothing of them.
    start_time: s, of the frame: motions are compared by where they carry the radar during it.
    """
    if radar is other:
        return ""
    for name in (*WAVEFORM_KINDS, *WAVEFORM_LISTS):
        if getattr(radar.waveform, name) != getattr(other.waveform, name):
            return name
    for name in ("transmit_power", "multiplexing", "empty_slots", "transmitters", "receivers"):
        if getattr(radar, name) != getattr(other, name):
            return name
    if not np.array_equal(radar.code_phases, other.code_phases):
        return "code_phases"
    times = start_time + np.linspace(0.0, radar.frame_duration, _NUM_TIMES)
    if all(np.array_equal(radar.world_from_radar(time), other.world_from_radar(time)) for time in times):
        return ""
    return next((name for name in ("position", "yaw", "pitch")
                 if not np.array_equal(getattr(radar, name), getattr(other, name))), "motion")


def table_key(pattern) -> tuple:
    arrays = (pattern.azimuth, pattern.elevation, pattern.table_gain, pattern.table_phase)
    return tuple(None if array is None else array.tobytes() for array in arrays)
