"""Radars in HDF5 groups (layout: data/README.md)."""
from __future__ import annotations

import numpy as np

import echopath as ep

from .h5 import read_array, read_attribute, read_group, read_texts, write_array, write_texts
from .scene import read_motion, write_motion

WAVEFORM_KINDS = {"start_frequency": float, "bandwidth": float, "num_samples": int, "sampling_rate": float,
                  "num_chirps": int, "chirp_interval": float, "real": bool}


def write_radar(group, radar) -> None:
    """Writes waveform, antennas, power, noise figure and motion."""
    group.attrs["transmit_power"] = radar.transmit_power
    group.attrs["noise_figure_db"] = radar.noise_figure_db
    group.attrs["multiplexing"] = radar.multiplexing
    waveform = group.create_group("waveform")
    for field in WAVEFORM_KINDS:
        waveform.attrs[field] = getattr(radar.waveform, field)
    _write_antennas(group.create_group("transmitters"), radar.transmitters)
    _write_antennas(group.create_group("receivers"), radar.receivers)
    if radar.motion is not None:
        write_motion(group.create_group("motion"), radar.motion)


def read_radar(group):
    """The radar of a group."""
    source = read_group(group, "waveform")
    fields = {field: read_attribute(source, field, kind) for field, kind in WAVEFORM_KINDS.items()}
    return ep.Radar(ep.ChirpSequence(**fields), transmitters=_read_antennas(read_group(group, "transmitters")),
                    receivers=_read_antennas(read_group(group, "receivers")),
                    transmit_power=read_attribute(group, "transmit_power", float),
                    noise_figure_db=read_attribute(group, "noise_figure_db", float),
                    multiplexing=read_attribute(group, "multiplexing", str),
                    motion=read_motion(group["motion"]) if "motion" in group else None)


def _write_antennas(group, antennas) -> None:
    patterns = [antenna.pattern for antenna in antennas]
    write_array(group, "position", np.array([antenna.position for antenna in antennas], np.float64), unit="m")
    write_array(group, "orientation", np.array([antenna.orientation for antenna in antennas], np.float64))
    write_array(group, "polarization", np.array([antenna.polarization for antenna in antennas], np.float64))
    write_texts(group, "pattern", [pattern.kind for pattern in patterns])
    write_array(group, "peak_gain", np.array([pattern.peak_gain for pattern in patterns], np.float64))
    write_array(group, "exponent", np.array([pattern.exponent for pattern in patterns], np.float64))


def _read_antennas(group) -> list:
    kinds = read_texts(group, "pattern")
    count = len(kinds)
    peak_gain = read_array(group, "peak_gain", np.float64, (count,))
    exponent = read_array(group, "exponent", np.float64, (count,))
    position = read_array(group, "position", np.float64, (count, 3))
    orientation = read_array(group, "orientation", np.float64, (count, 4))
    polarization = read_array(group, "polarization", np.float64, (count, 3))
    return [ep.Antenna(position[i], orientation=orientation[i], pattern=_pattern(kinds[i], peak_gain[i], exponent[i]),
                       polarization=polarization[i]) for i in range(count)]


def _pattern(kind: str, peak_gain: float, exponent: float):
    if kind == "isotropic":
        return ep.Isotropic(gain=peak_gain)
    if kind == "cosine_power":
        return ep.CosinePower(exponent, peak_gain=peak_gain)
    raise ep.FileError(f"unknown antenna pattern '{kind}'")
