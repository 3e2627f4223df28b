"""Short Fourier transforms over trains of chirps that come frame by frame."""
from __future__ import annotations

import copy
from itertools import pairwise

import numpy as np

from .. import _core
from ..arguments.gates import in_gate
from ..base.radar.chirps import chirp_period, chirps_duration
from ..spectra.range_transform import range_profiles
from ..spectra.windows import of_range
from .bursts import text_of_part
from .maps import Spectrogram
from .stft import axes_of, noise_bandwidth, velocity_powers, with_chirps

DEFAULT_LENGTH = 128     # chirps of a window, as far as a frame has them
EVEN = 1e-3              # of a chirp period, by which the chirps of a frame may come early or late


def require_window(times, radar, window_length: int | None, span_frames) -> None:
    """Raises ValueError for a window that is longer than all trains of frames, before any of them is made or read.

    times: [F] s, starts of the frames; radar: of all of them
    """
    if window_length is None:
        return
    ends, period = times + chirps_duration(radar), chirp_period(radar)
    goes_on = (np.abs(times[1:] - ends[:-1]) <= EVEN * period) & (span_frames is not False)
    first = np.flatnonzero(np.append(True, ~goes_on))
    trains = list(zip(times[first], ends[np.append(first[1:], len(times)) - 1]))
    if window_length > _longest(trains, period):
        raise _too_long(window_length, trains, period, span_frames)


def _longest(trains: list, period: float) -> int:
    """Chirps of the longest of some trains (begin, end) in s."""
    return max(round((end - begin) / period) for begin, end in trains)


def _too_long(window_length: int, trains: list, period: float, span_frames) -> ValueError:
    """The error that says what would make longer trains, or what there is between them."""
    gaps = [begin - end for (_, end), (begin, _) in pairwise(trains)]
    longer = ""
    if gaps and min(gaps) > EVEN * period:
        longer = f", between which are gaps of {min(gaps):.3g} s and more"
    elif gaps and span_frames is not True:
        longer = "; span_frames=True joins frames without gaps"
    return ValueError(f"window_length: must be at most {_longest(trains, period)}, the chirps of the longest train{longer}, "
                      f"got {window_length}")


class Stft:
    """Takes bursts one after the other and transforms each window as soon as it is whole, so that few profiles are kept."""

    def __init__(self, window_length, hop, window, zero_pad, range_gate, span_frames, channel):
        self._length, self._hop, self._window, self._zero_pad = window_length, hop, window, zero_pad
        self._gate, self._span_frames, self._channel = range_gate, span_frames, channel
        self._times, self._powers, self._trains, self._train = [], [], [], []
        self._radar = self._profiles = self._begin = self._end = self._before = None

    def add(self, burst) -> None:
        """Takes the next burst, whose profiles follow those that are kept; `_next` is the chirp of the train that the first of
        these is, `_ahead` how many of them the next window leaves out."""
        if self._radar is None:
            self._prepare(burst)
        late = 0.0 if self._end is None else abs(burst.start_time - self._end)
        if self._profiles is not None and not (late <= EVEN * self._period and self._joins(burst)):
            self._end_train()
        profiles = range_profiles(burst.cube, burst.radar.waveform, window=self._window)
        profiles = profiles[..., :len(self._inside)][..., self._inside]
        if self._profiles is None:
            self._begin, self._middle = burst.start_time, burst.middle(0, self._length)
            self._profiles, self._next, self._ahead = profiles, 0, 0
        else:
            self._profiles = np.concatenate([self._profiles, profiles], axis=2)
        self._transform()
        self._end, self._before = burst.end_time, burst._replace(cube=None)

    def copy(self) -> Stft:
        """Another one that has taken the same bursts so far and goes on by itself."""
        other = copy.copy(self)
        other._times, other._powers, other._trains, other._train = (
            list(held) for held in (self._times, self._powers, self._trains, self._train))
        return other

    def _joins(self, burst) -> bool:
        """Whether windows may span the burst before and this one, which goes on evenly."""
        return burst.goes_on_from(self._before) if self._span_frames == "auto" else self._span_frames

    def result(self, part) -> Spectrogram:
        self._end_train()
        if not self._times:
            raise _too_long(self._length, self._trains, self._period, self._span_frames)
        ranges = self._axes.range[self._inside]
        return Spectrogram(times=np.concatenate(self._times), velocity=self._axes.velocity, power=np.concatenate(self._powers),
                           noise_power=self.noise_power, train=np.concatenate(self._train), trains=np.array(self._trains),
                           window_length=self._length, hop=self._hop, window=self._window, zero_pad=self._zero_pad,
                           range_gate=(float(ranges[0]), float(ranges[-1])), part=text_of_part(part), channel=self._channel)

    def _prepare(self, burst) -> None:
        self._radar, self._period = burst.radar, chirp_period(burst.radar)
        self._length = min(DEFAULT_LENGTH, burst.cube.shape[2]) if self._length is None else self._length
        self._hop = max(1, self._length // 4) if self._hop is None else self._hop
        self._axes = axes_of(self._radar, self._length, self._zero_pad)
        self._inside = in_gate("range_gate", self._axes.range, self._gate, "m")
        waveform = self._radar.waveform
        self._spread = noise_bandwidth(of_range(self._window), waveform.num_samples)

    def _transform(self) -> None:
        """The windows that are whole; what no later window needs is let go."""
        starts = np.arange(self._ahead, self._profiles.shape[2] - self._length + 1, self._hop)
        if not len(starts):
            return
        power = velocity_powers(self._profiles, starts, self._length, self._window, self._zero_pad)
        self._times.append(self._middle + (self._next + starts) * self._period)
        self._powers.append(power / self._spread)
        self._train.append(np.full(len(starts), len(self._trains), np.int32))
        begin = int(starts[-1]) + self._hop  # of the next window, perhaps chirps beyond what is there
        done = min(begin, self._profiles.shape[2])
        self._profiles, self._next, self._ahead = self._profiles[:, :, done:].copy(), self._next + done, begin - done

    def _end_train(self) -> None:
        self._profiles = None
        self._trains.append((self._begin, self._end))

    @property
    def noise_power(self) -> float:
        """Mean of the receiver's noise in a cell, W; there is none before the first burst."""
        of_cell = _core.cell_noise_power(with_chirps(self._radar, self._length), self._window)
        return of_cell * np.count_nonzero(self._inside) / self._spread
