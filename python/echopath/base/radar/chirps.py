"""When a radar sends its chirps and its frames."""
from __future__ import annotations


def chirp_period(radar) -> float:
    """s, between the chirps of one transmitter."""
    return radar.num_slots * radar.waveform.mean_interval


def chirps_duration(radar) -> float:
    """s, from the first chirp of a frame to that of a frame which follows without a gap."""
    return radar.num_slots * radar.waveform.num_chirps * radar.waveform.mean_interval


def start_with_middle(radar, time: float) -> float:
    """s, when the frame starts whose middle is at `time` in s: the inverse of `radar.middle_of_frame`."""
    return time - 0.5 * radar.frame_duration
