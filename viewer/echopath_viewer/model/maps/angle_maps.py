"""Maps beside range-Doppler: range-azimuth, range-elevation, power over the time of the frame, and the beat signal."""
from __future__ import annotations

import dataclasses

import numpy as np

import echopath as ep
from echopath.arguments.gates import in_gate
from echopath.base.numerics.decibels import SMALLEST_POWER, in_dbm
from echopath.signals.measures import for_pictures

SPECTROGRAM_COLUMNS = 48
SHORTEST_WINDOW = 16  # chirps
MOST_BEAMS = 64       # over elevation
NO_AZIMUTHS = "the antennas of this radar tell no azimuths apart"


@dataclasses.dataclass(frozen=True)
class SideMap:
    """A map: level f32 [Y, X] in dBm over x (m or ms) and y (degrees or m/s).

    elevations, rows: of a range-azimuth map, whose levels are the largest over these elevations in rad and these velocities of
    the range-Doppler map, bool [V]; rows None: all
    """

    title: str
    level: np.ndarray
    x: np.ndarray
    y: np.ndarray
    elevations: tuple = (0.0,)
    rows: np.ndarray | None = None


def range_azimuth_map(spectrum, radar, name: str, progress=None, *, angles: dict | None = None) -> SideMap:
    """The strongest velocity at each range and azimuth, or what the frame was asked for. Raises ValueError where the antennas
    tell no azimuths apart.

    angles: keywords of `range_azimuth`, None: of the strongest velocity
    """
    if not ep.virtual_array(radar).tells_azimuths:
        raise ValueError(NO_AZIMUTHS)
    asked = {"combine": "peak"} if angles is None else angles
    found = ep.range_azimuth(spectrum, radar, **asked, progress=progress)
    method, velocity = asked.get("method", "bartlett"), asked.get("velocity")
    name += f", {method}" if method != "bartlett" else ""
    name += for_pictures(f", {velocity:+z.2f} m/s") if velocity is not None else ""
    return SideMap(f"range-azimuth, {name}", _level(found.power), np.asarray(found.range), np.degrees(found.azimuth),
                   tuple(np.asarray(found.elevation).tolist()), _rows_of(found, spectrum, asked))


def _rows_of(found, spectrum, asked: dict):
    """Which velocities of a range-Doppler map are in the range-azimuth map `found` that was asked for: bool [V]."""
    velocities = np.asarray(spectrum.velocity)
    if asked.get("velocity") is not None:
        return np.arange(len(velocities)) == np.abs(velocities - found.velocity).argmin()
    return in_gate("velocity_gate", velocities, asked.get("velocity_gate"), "m/s")


def kept_azimuth_map(maps, note: str) -> SideMap:
    """The range-azimuth map of ep.FrameMaps, whose range-Doppler map is a mean over channels and tells no directions. Raises
    ValueError where there is none; note: what such a file keeps."""
    if maps.azimuth is None:
        raise ValueError(note if maps.power is None else NO_AZIMUTHS)
    return SideMap("range-azimuth, everything received", _level(maps.azimuth_power), np.asarray(maps.range),
                   np.degrees(maps.azimuth))


def require_signals(session) -> None:
    """Raises ValueError where a file keeps maps without the signals that others are made of."""
    if session.kept_maps is not None:
        raise ValueError(session.note)


def range_elevation_map(spectrum, radar, name: str, progress=None) -> SideMap:
    """The strongest velocity at each range and elevation, at the azimuth to which the antennas look. Raises ValueError where they
    tell no elevations apart."""
    array = ep.virtual_array(radar)
    if not array.tells_elevations:
        raise ValueError("the antennas of this radar tell no elevations apart")
    elevation = np.asarray(array.default_angles()[1])
    elevation = elevation[::-(-len(elevation) // MOST_BEAMS)]
    beams = ep.beamform(spectrum, radar, array.boresight, elevation, progress=progress)
    power = np.asarray(beams.power)[:, 0].max(axis=1)
    return SideMap(f"range-elevation, {name}", _level(power), np.asarray(spectrum.range), np.degrees(elevation))


def spectrogram_map(cube, radar, channel: tuple, progress=None) -> SideMap:
    """Power by time within the frame and radial velocity, at a channel; x in ms from the start of the frame."""
    num_chirps = radar.waveform.num_chirps
    length = max(min(SHORTEST_WINDOW, num_chirps), num_chirps // 4)
    hop = max(1, (num_chirps - length) // SPECTROGRAM_COLUMNS)
    found = ep.spectrogram(cube, radar, window_length=length, hop=hop, channel=channel)
    if len(found.times) < 2:
        raise ValueError("this frame has too few chirps for a spectrogram")
    title = "power over the frame, all ranges, TX {}, RX {}".format(*channel)
    return SideMap(title, _level(found.power.T), 1e3 * np.asarray(found.times), np.asarray(found.velocity))


def beat_signal(cube, radar, channel: tuple, chirp: int) -> tuple:
    """(s [N] from the first sample, complex [N] in sqrt(W)): what the mixer gives during a chirp, without noise."""
    samples = np.asarray(cube)[channel[0], channel[1], chirp]
    return np.arange(len(samples)) / radar.waveform.sampling_rate, samples


def _level(power):
    return in_dbm(np.asarray(power, float), SMALLEST_POWER).astype(np.float32)
