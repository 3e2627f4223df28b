"""Radars in HDF5 groups (layout: data/README.md)."""
from __future__ import annotations

import json

import numpy as np

from .. import _core
from ..receiver import Receiver
from ..signals.same_radar import WAVEFORM_KINDS, WAVEFORM_LISTS, table_key
from .h5 import blames_group, read_array, read_attribute, read_group, read_texts, write_array, write_attribute, write_texts
from .scene.motion import read_motion, write_motion


def write_radar(group, radar) -> None:
    """Writes waveform, antennas, power, noise figure, place and motion."""
    write_attribute(group, "transmit_power", radar.transmit_power)
    write_attribute(group, "noise_figure_db", radar.noise_figure_db)
    write_attribute(group, "multiplexing", radar.multiplexing)
    _write_sensor(group, radar)
    write_attribute(group, "yaw", radar.yaw)
    write_attribute(group, "pitch", radar.pitch)
    write_array(group, "position", radar.position, unit="m")
    waveform = group.create_group("waveform")
    for field in WAVEFORM_KINDS:
        write_attribute(waveform, field, getattr(radar.waveform, field))
    _write_antennas(group.create_group("transmitters"), radar.transmitters)
    _write_antennas(group.create_group("receivers"), radar.receivers)
    if radar.motion is not None:
        write_motion(group.create_group("motion"), radar.motion)


def _write_sensor(group, radar) -> None:
    """What radars whose transmitters take turns, of equal chirps and with an ideal receiver, need not say."""
    for name in WAVEFORM_LISTS:
        if getattr(radar.waveform, name):
            write_array(group, name, np.array(getattr(radar.waveform, name), np.float64))
    if radar.multiplexing != "tdm":
        write_attribute(group, "empty_slots", radar.empty_slots)
    if radar.code_phases is not None:
        write_array(group, "code_phases", radar.code_phases, unit="rad")
    if radar.receiver is not None:
        write_attribute(group, "receiver", json.dumps(radar.receiver.plain()))


def _read_sensor(group) -> dict:
    keywords = {}
    if "empty_slots" in group.attrs:
        keywords["empty_slots"] = read_attribute(group, "empty_slots", int)
    if "code_phases" in group:
        keywords["code_phases"] = read_array(group, "code_phases", np.float64, (None, None))
    if "receiver" in group.attrs:
        keywords["receiver"] = Receiver(**json.loads(read_attribute(group, "receiver", str)))
    return keywords


@blames_group
def read_radar(group):
    """The radar of a group."""
    source = read_group(group, "waveform")
    fields = {field: read_attribute(source, field, kind) for field, kind in WAVEFORM_KINDS.items()}
    fields |= {name: read_array(group, name, np.float64, (None,)) for name in WAVEFORM_LISTS if name in group}
    return _core.Radar(_core.ChirpSequence(**fields), transmitters=_read_antennas(read_group(group, "transmitters")),
                       receivers=_read_antennas(read_group(group, "receivers")),
                       transmit_power=read_attribute(group, "transmit_power", float),
                       noise_figure_db=read_attribute(group, "noise_figure_db", float),
                       multiplexing=read_attribute(group, "multiplexing", str),
                       **_read_sensor(group), position=read_array(group, "position", np.float64, (3,)),
                       yaw=read_attribute(group, "yaw", float), pitch=read_attribute(group, "pitch", float),
                       motion=read_motion(read_group(group, "motion")) if "motion" in group else None)


def _write_antennas(group, antennas) -> None:
    patterns = [antenna.pattern for antenna in antennas]
    write_array(group, "position", np.array([antenna.position for antenna in antennas], np.float64), unit="m")
    write_array(group, "orientation", np.array([antenna.orientation for antenna in antennas], np.float64))
    write_array(group, "polarization", np.array([antenna.polarization for antenna in antennas], np.float64))
    write_texts(group, "pattern", [pattern.kind for pattern in patterns])
    write_array(group, "peak_gain", np.array([pattern.peak_gain for pattern in patterns], np.float64))
    write_array(group, "exponent", np.array([pattern.exponent for pattern in patterns], np.float64))
    _write_tables(group, patterns)


def _write_tables(group, patterns) -> None:
    """The gain tables of antennas, each once, and which antenna has which."""
    if not any(pattern.kind == "table" for pattern in patterns):
        return
    numbers = {}
    table_of_antenna = [-1 if pattern.kind != "table" else numbers.setdefault(table_key(pattern), len(numbers))
                        for pattern in patterns]
    write_array(group, "table", np.array(table_of_antenna, np.int32))
    tables = group.create_group("tables")
    for number in range(len(numbers)):
        pattern, table = patterns[table_of_antenna.index(number)], tables.create_group(str(number))
        write_array(table, "azimuth", pattern.azimuth, unit="rad")
        write_array(table, "elevation", pattern.elevation, unit="rad")
        write_array(table, "gain", pattern.table_gain)
        if pattern.table_phase is not None:
            write_array(table, "phase", pattern.table_phase, unit="rad")


@blames_group
def _read_antennas(group) -> list:
    kinds = read_texts(group, "pattern")
    count = len(kinds)
    peak_gain = read_array(group, "peak_gain", np.float64, (count,))
    exponent = read_array(group, "exponent", np.float64, (count,))
    position = read_array(group, "position", np.float64, (count, 3))
    orientation = read_array(group, "orientation", np.float64, (count, 4))
    polarization = read_array(group, "polarization", np.float64, (count, 3))
    tables = _read_tables(group, count) if "table" in kinds else [None] * count
    patterns = [_pattern(kinds[i], peak_gain[i], exponent[i], tables[i]) for i in range(count)]
    return [_core.Antenna(position[i], orientation=orientation[i], pattern=patterns[i], polarization=polarization[i])
            for i in range(count)]


def _read_tables(group, count: int) -> list:
    """The table of each antenna, None for those without."""
    patterns = [_read_table(read_group(read_group(group, "tables"), str(number)))
                for number in range(len(read_group(group, "tables")))]
    numbers = read_array(group, "table", np.int32, (count,))
    if count and not -1 <= numbers.min() <= numbers.max() < len(patterns):
        raise _core.FileError(f"{group.name}/table: must be -1 to {len(patterns) - 1}")
    return [patterns[number] if number >= 0 else None for number in numbers]


@blames_group
def _read_table(group):
    azimuth = read_array(group, "azimuth", np.float64, (None,))
    elevation = read_array(group, "elevation", np.float64, (None,))
    shape = (len(elevation), len(azimuth))
    phase = read_array(group, "phase", np.float64, shape) if "phase" in group else None
    return _core.GainTable(azimuth=azimuth, elevation=elevation, gain=read_array(group, "gain", np.float64, shape),
                           phase=phase)


def _pattern(kind: str, peak_gain: float, exponent: float, table):
    if kind == "table" and table is not None:
        return table
    if kind == "isotropic":
        return _core.Isotropic(gain=peak_gain)
    if kind == "cosine_power":
        return _core.CosinePower(exponent, peak_gain=peak_gain)
    raise _core.FileError(f"unknown antenna pattern '{kind}'")
