"""Micro-Doppler: short Fourier transforms over the chirps of frames in a row."""
from __future__ import annotations

from typing import Literal

import numpy as np

from .. import _core
from ..arguments.checks import ArrayLike, MapWindow, an, array, checked, count, flag, optional, refused
from ..arguments.gates import gate, in_gate
from ..arguments.settings import SignalSettings
from ..spectra.windows import of_range
from .bursts import Channel, Frames, Part, bursts, channel_rule, chirp_period, frames_rule, part_rule, text_of_part
from .maps import Spectrogram
from .stft import axes_of, noise_bandwidth, range_profiles, velocity_powers, with_chirps

DEFAULT_LENGTH = 128     # chirps of a window, as far as a frame has them
MOST_CHIRPS = 1 << 20
SpanFrames = bool | Literal["auto"]
EVEN = 1e-3              # of a chirp period, by which the chirps of a frame may come early or late
IN_TIME_RULES = {
    "frames": frames_rule, "radar": optional(an(_core.Radar)), "part": part_rule,
    "channel": channel_rule, "start_times": optional(array("[N]", finite=True)),
    "window_length": optional(count(1, MOST_CHIRPS)), "hop": optional(count(1, MOST_CHIRPS))}


def _span_rule(argument: str, value) -> SpanFrames:
    """True, False or "auto"."""
    if isinstance(value, str) and value == "auto":
        return "auto"
    try:
        return flag(argument, value)
    except (TypeError, ValueError):
        raise refused(TypeError, argument, "True, False or 'auto'", value) from None


@checked(**IN_TIME_RULES, range_gate=gate, span_frames=_span_rule)
def spectrogram(frames: Frames, radar: _core.Radar | None = None, *, window_length: int | None = None, hop: int | None = None,
                window: MapWindow = SignalSettings.window, range_gate: ArrayLike | None = None, part: Part = None,
                channel: Channel = None, zero_pad: int = SignalSettings.zero_pad, span_frames: SpanFrames = "auto",
                start_times: ArrayLike | None = None) -> Spectrogram:
    """Micro-Doppler: received power by time and radial velocity, by short Fourier transforms over the chirps.

    Each chirp is transformed over its samples first, as in `range_doppler`, then each window over its chirps. Windows slide
    over trains of chirps that go on evenly, and none spans a gap between trains. A train is one frame, or all frames that
    follow each other without a gap, each starting one chirp period after the last chirp of the one before, as far as
    `span_frames` joins them. Frames of `Sequence` keep the scatterers of rough surfaces (`scatterers="surface"`), so that their
    echoes go on; those of single calls of `simulate` have other random phases in each frame, which would spread them over
    velocity in windows that span two.
    frames: a Frame or frames in the order of time, used one after the other (with their noise, unless a part is asked for);
        or a cube [tx, rx, chirp, sample] in sqrt(W) or several, of `radar`
    radar: that of the cubes, None: frames bring theirs
    window_length: chirps of one transmitter in a window, None: 128, at most those of a frame; hop: chirps from window to
        window, None: a quarter of that
    window: as in `range_doppler`, over samples and chirps; zero_pad: 1 to 64, of the velocities
    range_gate: (nearest, farthest) in m of the ranges whose powers are summed, None: all, with the noise of all: that of 256
        cells is 24 dB above that of one, so that weak bodies are seen with a gate, or as a `part`
    part: of frames, noise-free: a name in `frame.parts` ("arm" or "partition/arm"), an object of the scene, by its echoes
        that touch nothing else, or a Selection or its text; None: the whole signal
    channel: indices (tx, rx), None: the mean over all
    span_frames: whether windows may span frames that go on evenly; "auto": those whose scatterers persist, Frames with
        scatterers="surface" of one seed or without diffuse echoes, and cubes with `start_times`; True, False: all, none of them
    start_times: [F] s, when the cubes begin, None: one behind the other from 0 on
    Returns a Spectrogram with power [times, velocity] in W. Raises TypeError, ValueError or IndexError naming the argument,
    also for frames of different radars, out of order or shorter than a window.
    """
    stft = _Stft(window_length, hop, window, zero_pad, range_gate, span_frames, channel)
    for burst in bursts(frames, radar, part=part, channel=channel, start_times=start_times):
        stft.add(burst)
    return stft.result(part)


class _Stft:
    """Takes bursts one after the other and transforms each train when it ends, so that few profiles are kept at a time."""

    def __init__(self, window_length, hop, window, zero_pad, range_gate, span_frames, channel):
        self._length, self._hop, self._window, self._zero_pad = window_length, hop, window, zero_pad
        self._gate, self._span_frames, self._channel = range_gate, span_frames, channel
        self._profiles, self._times, self._powers, self._trains, self._train = [], [], [], [], []
        self._radar = self._begin = self._end = self._before = None

    def add(self, burst) -> None:
        if self._radar is None:
            self._prepare(burst)
        late = 0.0 if self._end is None else abs(burst.start_time - self._end)
        if self._profiles and not (late <= EVEN * self._period and self._joins(burst)):
            self._end_train()
        if not self._profiles:
            self._begin, self._middle = burst.start_time, burst.middle(0, self._length)
        self._profiles.append(range_profiles(burst.cube, burst.radar, self._window, self._inside))
        self._end, self._before = burst.end_time, burst._replace(cube=None)

    def _joins(self, burst) -> bool:
        """Whether windows may span the burst before and this one, which goes on evenly."""
        return burst.goes_on_from(self._before) if self._span_frames == "auto" else self._span_frames

    def result(self, part) -> Spectrogram:
        self._end_train()
        if not self._times:
            longest = max(round((end - begin) / self._period) for begin, end in self._trains)
            may_join = len(self._trains) > 1 and self._span_frames is not True
            hint = "; span_frames=True joins frames without gaps" if may_join else ""
            raise ValueError(f"window_length: must be at most {longest}, the chirps of the longest train{hint}, got "
                             f"{self._length}")
        ranges = self._axes.range[self._inside]
        return Spectrogram(times=np.concatenate(self._times), velocity=self._axes.velocity, power=np.concatenate(self._powers),
                           noise_power=self._noise_power(), train=np.concatenate(self._train), trains=np.array(self._trains),
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

    def _end_train(self) -> None:
        profiles = np.concatenate(self._profiles, axis=2)
        self._profiles = []
        starts = np.arange(0, profiles.shape[2] - self._length + 1, self._hop)
        if len(starts):
            power = velocity_powers(profiles, starts, self._length, self._window, self._zero_pad)
            self._times.append(self._middle + starts * self._period)
            self._powers.append(power / self._spread)
            self._train.append(np.full(len(starts), len(self._trains), np.int32))
        self._trains.append((self._begin, self._end))

    def _noise_power(self) -> float:
        of_cell = _core.cell_noise_power(with_chirps(self._radar, self._length), self._window)
        return of_cell * np.count_nonzero(self._inside) / self._spread
