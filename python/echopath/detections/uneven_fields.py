"""What each path gives to a cell of the map of a radar whose chirps differ: by a sum over the chirps."""
from __future__ import annotations

from functools import cached_property

import numpy as np

from .. import _core
from ..base.radar.chirps import chirps_duration
from ..paths.cells import chirp_times
from ..spectra.windows import of_velocity, samples_of
from ..transmit.signals import has_steps, repeated
from .channels import Channels
from .echo_fields import EchoFields

ECHOES_AT_ONCE = 1 << 12   # whose phases in all chirps are in memory
SEGMENTS_PER_BIN = 32      # of range that an echo goes on by: steps of the response up to 2 % of the peak
MAX_SEGMENTS = 64
ROUNDING = 1e-9            # of the wait for the next chirp
_OF_PATHS = ("velocity", "range", "sweep", "travel", "length", "index")


def echo_fields(paths, spectrum) -> EchoFields:
    """EchoFields of paths in a map of the radar that traced them, however its chirps follow each other."""
    return (UnevenEchoFields if _is_uneven(paths.radar) else EchoFields)(paths, spectrum)


def _is_uneven(radar) -> bool:
    waveform = radar.waveform
    waits = np.diff([radar.chirp_time(0, chirp) for chirp in range(min(waveform.num_chirps, 1 + _period(waveform, radar)))])
    return has_steps(radar) or (len(waits) > 1 and np.ptp(waits) > ROUNDING * waits[0])


def _period(waveform, radar) -> int:
    """Chirps of a transmitter after which idle times repeat."""
    return int(np.lcm(max(len(waveform.extra_idle), 1), radar.num_slots)) // radar.num_slots


class _Chirps:
    """The chirps of a transmitter: weights [C] of the velocity's window, late: [C] s after the middle of the frame, by how many
    Hz the carrier and by which ratio the slope differs from the waveform's, [C]."""

    def __init__(self, paths, window, tx: int):
        radar, waveform = paths.radar, paths.radar.waveform
        chirps = np.arange(waveform.num_chirps)
        slots = chirps * radar.num_slots + (tx if radar.multiplexing == "tdm" else 0)
        samples = samples_of(of_velocity(window), waveform.num_chirps)
        self.weights = samples / samples.sum()
        times = np.array([radar.chirp_time(tx, chirp) for chirp in chirps.tolist()])
        self.late = paths.frame.start_time + times - chirp_times(paths, tx)[1]
        self.slope_ratio = 1.0 + repeated(waveform.bandwidth_steps, slots) / waveform.bandwidth
        self.carrier_step = (repeated(waveform.frequency_steps, slots)
                             + (self.slope_ratio - 1.0) * waveform.slope * waveform.window_centre)


class UnevenEchoFields(EchoFields):
    """EchoFields where idle times, start frequencies or bandwidths differ from chirp to chirp.

    Model: as that of EchoFields, but for the chirps: each has the delay of its own time and turns the echo by its own carrier. An
    echo is then in all cells of velocity at its range. Time: of the paths about a range in all chirps, for each cell.
    """

    @cached_property
    def _chirps(self) -> dict:
        """{tx: _Chirps} of all transmitters."""
        return {tx: _Chirps(self._paths, self._spectrum.window, tx) for tx in range(len(self._paths.radar.transmitters))}

    @cached_property
    def _most_wider(self) -> float:
        """The largest part by which the bandwidth of a chirp differs."""
        return max(float(np.max(np.abs(chirps.slope_ratio - 1.0))) for chirps in self._chirps.values())

    def _candidates(self, number, velocity: int, distance: int):
        """As of EchoFields, those of all velocities."""
        pad, ranges = self._spectrum.zero_pad, self._echoes["range"]
        far = (self._range_envelope.reach() + 0.5 * self._largest("travel") + self._all.largest_shift + 1.0) * pad
        return np.flatnonzero(self._away(ranges, distance) <= far + self._most_wider * ranges)

    def _bounds(self, some, cell) -> np.ndarray:
        pad = self._spectrum.zero_pad
        echoes = {name: self._echoes[name][some] for name in ("range", "travel")}
        spread = np.abs(echoes["travel"]) + 2.0 * (self._all.largest_shift + self._most_wider * echoes["range"] / pad)
        return self._power[some] * self._range_envelope.bound((cell[1] - echoes["range"]) / pad, spread) ** 2

    def _gain(self, echoes: dict, some, cell):
        return self._gain_of(self._chirps[0], echoes, some, cell)

    def _gains(self, echoes: dict, some, cell, channels: Channels) -> np.ndarray:
        shift = echoes["shift"][:, some]
        gains = np.empty(shift.shape, np.complex64)
        for tx, rows in channels.of_transmitters.items():
            gain = self._gain_of(self._chirps[tx], echoes, some, cell)
            for row in rows:
                gains[row] = gain(shift[row])
        return gains

    def _weighted(self, echoes: dict, some, cell, channels: Channels, weights) -> np.ndarray:
        return weights @ self._fields(echoes, some, cell, channels)

    def _gain_of(self, chirps: _Chirps, echoes: dict, some, cell):
        """Function as that of `_gain`, for a transmitter with these chirps."""
        group = self._group_of(chirps)
        along = np.empty((group.max() + 1, len(some)), np.complex64)
        across = np.empty(along.shape)
        for first in range(0, len(some), ECHOES_AT_ONCE):
            piece = slice(first, first + ECHOES_AT_ONCE)
            few = {name: values[some[piece]] for name, values in echoes.items() if name in _OF_PATHS}
            tones = self._tones(chirps, few) * (np.exp(-2j * np.pi * self._cell_turns(cell[0])) * chirps.weights)[:, None]
            along[:, piece] = _sums(tones, group)
            across[:, piece] = _sums(self._bins_beside(chirps, few, cell[1]), group) / np.bincount(group)[:, None]
        return lambda shift: np.sum(along * self._range_response(across - shift), axis=0)

    def _bins_beside(self, chirps: _Chirps, echoes: dict, distance: int) -> np.ndarray:
        """Bins [C, N] from the echoes to a cell of range."""
        ranges = np.outer(chirps.slope_ratio, echoes["range"])
        onward = np.outer(chirps.late / self._duration, echoes["travel"])
        followed, rows = self._followed(echoes)
        onward[:, followed] = 0.5 * self._histories.farther(rows).T / self._paths.radar.waveform.range_resolution
        return (distance - ranges) / self._spectrum.zero_pad - onward

    @cached_property
    def _duration(self) -> float:
        return chirps_duration(self._paths.radar)

    def _followed(self, echoes: dict) -> tuple:
        """Places of the echoes that are followed from chirp to chirp, and their rows in the histories, [F] each."""
        rows = self._histories.rows(echoes["index"])
        return np.flatnonzero(rows >= 0), rows[rows >= 0]

    def _tones(self, chirps: _Chirps, echoes: dict) -> np.ndarray:
        """What the chirps have of echoes beside their fields, [C, N]: those in the middle of the frame, or the largest ones of
        echoes that are followed."""
        place = chirps.late[:, None] / self._duration
        doppler = (echoes["velocity"] - len(self._spectrum.velocity) // 2) / self._spectrum.zero_pad  # turns in the frame
        delay = echoes["length"] / _core.speed_of_light
        now = delay + doppler * place / self._paths.radar.waveform.centre_frequency
        tones = np.exp(2j * np.pi * (doppler * place + 0.5 * echoes["sweep"] * place ** 2))
        followed, rows = self._followed(echoes)
        now[:, followed] = delay[followed] + self._histories.farther(rows).T / _core.speed_of_light
        tones[:, followed] = self._histories.fields(rows).T
        steps = 0.5 * self._paths.radar.waveform.slope * (chirps.slope_ratio[:, None] - 1.0) * delay ** 2
        return tones * np.exp(2j * np.pi * (chirps.carrier_step[:, None] * now - steps))

    def _group_of(self, chirps: _Chirps) -> np.ndarray:
        """Number [C] of the group in which an echo stays at one place of range: the same segment of the frame and bandwidth."""
        count = len(chirps.late)
        segments = int(np.clip(np.ceil(SEGMENTS_PER_BIN * self._largest("travel")), 1, min(MAX_SEGMENTS, count)))
        kind = np.unique(chirps.slope_ratio, return_inverse=True)[1]
        return np.unique(np.arange(count) * segments // count + segments * kind, return_inverse=True)[1]


def _sums(values, group) -> np.ndarray:
    """Sums [G, N] of values [C, N] over those of each group [C], whose numbers are 0 to G - 1."""
    order = np.argsort(group, kind="stable")
    return np.add.reduceat(values[order], np.searchsorted(group[order], np.arange(group.max() + 1)), axis=0)
