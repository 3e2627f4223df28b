"""Micro-Doppler: short Fourier transforms over the chirps of frames in a row."""
from __future__ import annotations

import dataclasses
import functools
from collections.abc import Mapping
from typing import Literal

from .. import _core
from ..arguments.checks import ArrayLike, MapWindow, an, anything, array, checked, count, flag_or_auto, optional
from ..arguments.gates import gate
from ..arguments.settings import LabelSettings, SignalSettings
from ..labels.request import as_label_settings
from ..sequence.row import Row
from .bursts import Channel, Frames, Part, bursts, channel_rule, frames_rule, part_rule
from .maps import Spectrogram
from .sliding import Stft, require_window
from .views import Views

MOST_CHIRPS = 1 << 20
SpanFrames = bool | Literal["auto"]
IN_TIME_RULES = {
    "frames": frames_rule, "radar": optional(an(_core.Radar)), "part": part_rule,
    "channel": channel_rule, "start_times": optional(array("[N]", finite=True)),
    "window_length": optional(count(1, MOST_CHIRPS)), "hop": optional(count(1, MOST_CHIRPS))}


@checked(**IN_TIME_RULES, range_gate=gate, span_frames=flag_or_auto, labels=anything)
def spectrogram(frames: Frames, radar: _core.Radar | None = None, *, window_length: int | None = None, hop: int | None = None,
                window: MapWindow = SignalSettings.window, range_gate: ArrayLike | None = None, part: Part = None,
                channel: Channel = None, zero_pad: int = SignalSettings.zero_pad, span_frames: SpanFrames = "auto",
                start_times: ArrayLike | None = None,
                labels: bool | LabelSettings | Mapping[str, object] | None = None) -> Spectrogram:
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
    labels: of frames, as in `simulate`: True, LabelSettings or a dict of their keywords (objects, noise, noise_margin_db in dB,
        dynamic_range_db in dB): `.labels` then says, without noise, which part of each partition of the frames, which object and
        which ghost made each cell. Ghosts that are 20 dB below the noise with its margin even where all of their paths are in
        phase have no part of their own: in "families" they are "other". It takes the memory of the signals of all parts of a
        frame, at one channel where `channel` names one
    Returns a Spectrogram with power [times, velocity] in W. Raises TypeError, ValueError or IndexError naming the argument,
    also for frames of different radars, out of order or shorter than a window.
    """
    if isinstance(frames, Row) and len(frames):
        require_window(frames.times, frames.radar, window_length, span_frames)
    make_stft = functools.partial(Stft, window_length, hop, window, zero_pad, range_gate, span_frames, channel)
    whole, settings = make_stft(), as_label_settings(labels)
    views = None if settings is None else Views(settings, make_stft, part, channel)
    for burst in bursts(frames if views is None else views.seen(frames), radar, part=part, channel=channel,
                        start_times=start_times):
        whole.add(burst)
        if views is not None:
            views.add(burst)
    found = whole.result(part)
    return found if views is None else dataclasses.replace(found, labels=views.labels())
