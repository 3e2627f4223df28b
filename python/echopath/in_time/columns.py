"""Range and azimuth over time: a column for each frame, or for windows of its chirps."""
from __future__ import annotations

from collections.abc import Mapping
from itertools import chain

import numpy as np

from .. import _core
from ..arguments.checks import ArrayLike, MapWindow, anything, checked, one_of
from ..arguments.gates import gate, in_gate
from ..arguments.settings import SignalSettings
from ..base.radar.chirps import chirp_period
from ..spectra.angles import Combine, range_azimuth
from ..spectra.azimuth_map import checked_settings, sees_azimuth
from ..spectra.windows import of_range, of_velocity
from ..transmit import is_coded, noise_apart
from .bursts import Burst, Channel, Frames, Part, bursts, text_of_part
from .maps import AngleTime, RangeTime
from .spectrogram import IN_TIME_RULES
from .stft import noise_bandwidth, with_chirps

_NOISE_SEED = 1  # of the noise whose mean in a map is measured
_RULES = IN_TIME_RULES | {"combine": one_of(Combine)}


@checked(**_RULES, velocity_gate=gate)
def range_time(frames: Frames, radar: _core.Radar | None = None, *, combine: Combine = "sum",
               velocity_gate: ArrayLike | None = None, window_length: int | None = None, hop: int | None = None,
               window: MapWindow = SignalSettings.window, zero_pad: int = SignalSettings.zero_pad, part: Part = None,
               channel: Channel = None, start_times: ArrayLike | None = None) -> RangeTime:
    """Received power by time and range: of each frame's range-Doppler map, all velocities as one.

    frames, radar, part, channel, start_times: as in `spectrogram`
    combine: of the velocities in the gate, their "sum", or "peak", the largest. A point gives its received power in both
    velocity_gate: (lowest, highest) in m/s of the velocities that count, as the map has them; None: all
    window_length: chirps of one transmitter that make a column, None: those of the frame; no column spans two frames
    hop: chirps from column to column, None: window_length
    window, zero_pad: of the maps, as in `range_doppler`
    Returns a RangeTime with power [times, range] in W. Raises TypeError, ValueError or IndexError naming the argument.
    """
    columns = _Columns(bursts(frames, radar, part=part, channel=channel, start_times=start_times), window_length, hop)
    spread = noise_bandwidth(of_velocity(window), columns.length) * zero_pad
    empty = columns.empty_map(window, zero_pad)
    inside = in_gate("velocity_gate", empty.velocity, velocity_gate, "m/s")

    def column(spectrum):
        power = _core.mean_power(spectrum)[inside]
        return power.max(axis=0) if combine == "peak" else power.sum(axis=0) / spread

    power = columns.mapped(lambda cube, one: column(_core.range_doppler(cube, one, window, zero_pad)))
    is_drawn = combine == "peak" or is_coded(columns.radar)  # what undoes a code leaves more of it near the ends of a frame
    noise = (columns.noise(column, window, zero_pad) if is_drawn else
             columns.noise_of_cell(window) * np.count_nonzero(inside) / spread)
    velocities = empty.velocity[inside]
    return RangeTime(times=columns.times, range=empty.range.copy(), power=power, combine=combine, window=window,
                     noise_power=noise, zero_pad=zero_pad, part=text_of_part(part),
                     velocity_gate=(float(velocities[0]), float(velocities[-1])), channel=channel)


@checked(**_RULES, range_gate=gate, velocity_gate=gate, angles=anything)
def angle_time(frames: Frames, radar: _core.Radar | None = None, *, combine: Combine = "sum",
               range_gate: ArrayLike | None = None, velocity_gate: ArrayLike | None = None,
               angles: Mapping[str, object] | None = None, window_length: int | None = None, hop: int | None = None,
               window: MapWindow = SignalSettings.window, zero_pad: int = SignalSettings.zero_pad,
               part: Part = None, start_times: ArrayLike | None = None) -> AngleTime:
    """Received power by time and azimuth: of each frame's range-azimuth map, all ranges as one.

    frames, radar, part, start_times: as in `spectrogram`; combine, window_length, hop, window, zero_pad: as in `range_time`,
        of the ranges in the gate
    range_gate: (nearest, farthest) in m of the ranges that count, None: all
    velocity_gate: (lowest, highest) in m/s of the velocities that count, as the range-Doppler map has them; None: all. What
        stands still, for example, is left out by one that does not hold 0
    angles: keywords of `range_azimuth` for the maps, None: {"combine": "peak"}, as the maps of frames
    Returns an AngleTime with power [times, azimuth] in W. Raises TypeError or ValueError naming the argument, also for radars
    that see no azimuth.
    """
    columns = _Columns(bursts(frames, radar, part=part, start_times=start_times), window_length, hop)
    settings = checked_settings(columns.radar, angles, velocity_gate)
    if not sees_azimuth(columns.radar, settings):
        raise ValueError("frames: angle_time needs antennas side by side, and angles with an azimuth where they stand tens of "
                         "metres apart, got a radar that sees no azimuth")
    spread = noise_bandwidth(of_range(window), columns.radar.waveform.num_samples) * zero_pad

    def map_of(spectrum, one):
        return range_azimuth(spectrum, one, **settings)

    empty = map_of(columns.empty_map(window, zero_pad), columns.radar_of_column)
    inside = in_gate("range_gate", empty.range, range_gate, "m")

    def column(spectrum, one=columns.radar_of_column):
        power = map_of(spectrum, one).power[:, inside]
        return power.max(axis=1) if combine == "peak" else power.sum(axis=1) / spread

    power = columns.mapped(lambda cube, one: column(_core.range_doppler(cube, one, window, zero_pad), one))
    ranges = empty.range[inside]
    return AngleTime(times=columns.times, azimuth=empty.azimuth.copy(), power=power, combine=combine, window=window,
                     noise_power=columns.noise(column, window, zero_pad), zero_pad=zero_pad, part=text_of_part(part),
                     range_gate=(float(ranges[0]), float(ranges[-1])), velocity_gate=velocity_gate)


class _Columns:
    """The pieces of bursts that become columns, one after the other.

    radar: of the first burst; length, hop: chirps of one transmitter; times: [T] s, once `mapped` has gone through all
    """

    def __init__(self, given, window_length, hop):
        self._first, self._rest, self.times = next(given), given, None
        self.radar, chirps = self._first.radar, self._first.cube.shape[2]
        self.length = chirps if window_length is None else window_length
        if self.length > chirps:
            raise ValueError(f"window_length: must be at most {chirps}, the chirps of a frame, got {window_length}")
        self._hop = self.length if hop is None else hop
        self.radar_of_column = with_chirps(self.radar, self.length)

    def mapped(self, column):
        """[T, X] of column(cube, radar) -> [X] of each piece."""
        times, found = [], []
        for burst in chain([self._first], self._rest):
            one = _of_channels(with_chirps(burst.radar, self.length), burst)
            for begin in range(0, burst.cube.shape[2] - self.length + 1, self._hop):
                times.append(burst.middle(begin, self.length))
                found.append(column(np.ascontiguousarray(burst.cube[:, :, begin:begin + self.length]), one))
        self.times = np.array(times)
        return np.array(found)

    def empty_map(self, window, zero_pad):
        """The map of a piece without a signal."""
        shape = (*self._first.cube.shape[:2], self.length, self.radar.waveform.num_samples)
        return self._map_of(np.zeros(shape), window, zero_pad)

    def _map_of(self, piece, window, zero_pad):
        return _core.range_doppler(piece, _of_channels(self.radar_of_column, self._first), window, zero_pad)

    def noise_of_cell(self, window) -> float:
        """Mean of the noise in a cell of a piece's map, W."""
        return _core.cell_noise_power(self.radar_of_column, window)

    def noise(self, column, window, zero_pad) -> float:
        """Mean in W of a column of noise: of one piece, or of all in a frame where a code has been undone."""
        apart = noise_apart(self.radar if is_coded(self.radar) else self.radar_of_column, _NOISE_SEED)
        noise = apart[list(self._first.transmitters), :self._first.cube.shape[1]]
        pieces = (np.ascontiguousarray(noise[:, :, begin:begin + self.length])
                  for begin in range(0, noise.shape[2] - self.length + 1, self.length))
        return float(np.mean([column(self._map_of(piece, window, zero_pad)) for piece in pieces]))


def _of_channels(radar, burst: Burst):
    """The radar with as many antennas as the cube of the burst has, and the chirps as far apart as they were."""
    num_tx, num_rx = burst.cube.shape[:2]
    if (num_tx, num_rx) == (len(radar.transmitters), len(radar.receivers)):
        return radar
    waveform = radar.waveform.replace(chirp_interval=chirp_period(radar) / num_tx, extra_idle=())
    return radar.replace(waveform=waveform, transmitters=radar.transmitters[:num_tx], receivers=radar.receivers[:num_rx],
                         multiplexing="tdm", code_phases=None)
