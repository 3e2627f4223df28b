"""Images by back-projection: of a radar that moves past a scene, of a thing that turns before a radar, of the near field.

The image of each channel at the place of a reflector tells what the channels differ by."""
from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..arguments.checks import ArrayLike, MapWindow, Progress, anything, array, checked, real, refused
from ..arguments.settings import SignalSettings
from ..base.process.callers import warn_user
from ..base.process.progress import with_progress
from ..transmit import is_coded, signal_shape
from ..transmit.signals import has_steps
from .range_transform import range_taper, range_transform
from .windows import of_velocity, samples_of

CLEAR_ECHO = 100.0  # times the noise: 20 dB
FINER = 16  # bins of a profile for each range cell: between them it is a line, within 0.01 dB of a Hann window's lobe


class _Legs(NamedTuple):
    """Ways between antennas and points, and how fast they grow within a chirp."""

    length: NDArray[np.float64]  # m
    rate: NDArray[np.float64]    # m/s

    def __add__(self, other: _Legs) -> _Legs:
        return _Legs(self.length + other.length, self.rate + other.rate)


@checked(points=array("[3]", "[N, 3]", "[N, M, 3]", finite=True), position=anything, yaw=anything, motion=anything,
         start_time=real(unit="s"))
def backproject(cube: ArrayLike, radar: _core.Radar, points: ArrayLike, *, position: ArrayLike = (0.0, 0.0, 0.0),
                yaw: float = 0.0, motion: _core.Motion | None = None, start_time: float = 0.0,
                window: MapWindow = SignalSettings.window, progress: Progress = None) -> NDArray[np.complex128]:
    """An image at points of space: the signals of all chirps and channels, each at the delay of the point, added in phase.

    The antennas are where the motion of the radar has them in each chirp, so that a radar that moves makes a synthetic aperture
    (SAR) along whatever way; what moves before it makes one, too (ISAR), with points in its own axes. Nothing is taken for far
    or for a plane wave. Within a chirp both motions count as linear.
    cube: [tx, rx, chirp, sample] in sqrt(W), of that radar
    radar: that of the cube, with transmitters in turns and chirps that are all alike
    points: [3], [N, 3] or [N, M, 3] in m: in the world, or in the axes of a thing that `position`, `yaw` and `motion` tell
    position, yaw, motion: of that thing, as those of `Scene.add`: [3] in m, rad about z, and a Motion or None
    start_time: s, of the frame, which may hold chirps of many seconds
    window: as in `range_doppler`, over the samples and over the chirps
    progress: callable (stage, fraction), True for bars, or None
    Returns values of the shape of the points without their last axis, complex in sqrt(W): |value|^2 of a point target is its
    received power in W, in the mean over chirps and channels. A point farther than the range axis reaches has 0. Across the way
    of an aperture of the length L, straight and seen from its side, the image resolves (3 dB) 0.72 wavelength range / L with a
    Hann window and 0.44 with "rect". Takes some 0.2 us of a processor for each point, chirp and channel. Raises TypeError or
    ValueError naming the argument.
    """
    cube, points = _checked_cube(cube, radar), np.asarray(points, float)
    world_from_points = radar.replace(position=position, yaw=yaw, pitch=0.0, motion=motion).world_from_radar
    image = np.zeros(points.shape[:-1], np.complex128)
    for _, _, of_chirp in _chirp_images(cube, radar, points, world_from_points, start_time, window, progress):
        image += of_chirp
    return image / (cube.shape[0] * cube.shape[1])


@checked(position=array("[3]", finite=True), start_time=real(unit="s"))
def calibrate(cube: ArrayLike, radar: _core.Radar, position: ArrayLike, *, start_time: float = 0.0,
              window: MapWindow = SignalSettings.window) -> NDArray[np.complex128]:
    """Corrections of the channels of an array, from the echo of a reflector whose place is known.

    Nothing is taken for far: each channel has a delay of its own to the place, and a level by the lengths of its two legs. What
    the patterns of the antennas have toward the place stays in, and what else the scene has there in range, so that the
    reflector should stand alone or far above the rest, and where antennas look alike.
    cube: [tx, rx, chirp, sample] in sqrt(W), of that radar, with the reflector at rest
    radar: that of the cube, with transmitters in turns and chirps that are all alike
    position: [3] in m, in the world: where the echo comes from. An error across the array's line of sight turns the corrections
        as a plane wave does
    start_time: s, of the frame
    window: as in `range_doppler`, over the samples and over the chirps
    Returns [tx, rx], complex: cube * corrections[:, :, None, None] is that of channels which are alike. They leave the mean power
    of the echo over all channels and the phase of channel [0, 0]. Raises TypeError or ValueError naming the argument, also
    where a channel has no signal there. Warns (RuntimeWarning) where an echo is less than 20 dB above the noise of the radar,
    from which on noise turns corrections by more than 0.07 rad rms.
    """
    cube, points = _checked_cube(cube, radar), np.asarray(position, float)
    found = np.zeros(cube.shape[:2], np.complex128)
    for tx, rx, of_chirp in _chirp_images(cube, radar, points, _in_world, start_time, window):
        found[tx, rx] += of_chirp
    if silent := np.argwhere(found == 0).tolist():
        raise ValueError(f"cube: must have an echo of the position {points.tolist()} m in each channel, from where the radar is "
                         f"at the start_time {start_time:g} s, got none in [tx, rx] = {silent[0]}")
    _warn_of_noise(np.min(np.abs(found) ** 2) / _core.cell_noise_power(radar, window))
    legs = _legs_at(points, radar, _in_world, radar.middle_of_frame(start_time))
    sent, heard = ([legs(antenna).length for antenna in antennas] for antennas in (radar.transmitters, radar.receivers))
    found *= np.multiply.outer(sent, heard)
    level = np.sqrt(np.mean(np.abs(found) ** 2)) * np.exp(1j * np.angle(found[0, 0]))
    return level / found


def _in_world(time: float) -> NDArray[np.float64]:
    """As `world_from_points` of points that the world's axes tell."""
    return np.eye(4)


def _warn_of_noise(ratio: float) -> None:
    """ratio: power of the weakest channel's echo over that of the noise"""
    if ratio < CLEAR_ECHO:
        warn_user(f"calibrate: the echo stands {10.0 * np.log10(ratio):.1f} dB above the noise of the radar in its weakest "
                  f"channel, which turns its correction by some {np.sqrt(0.5 / ratio):.2f} rad, unless the reflector is "
                  "elsewhere or the cube has no noise; more chirps and a stronger or nearer reflector help")


def _chirp_images(cube, radar, points, world_from_points, start_time: float, window: MapWindow, progress: Progress = None):
    """(tx, rx, values of the points) of each chirp of each channel, times its share of the window: their sum over the chirps is
    the image of the channel. Arguments as in `backproject`; world_from_points: function of the time in s"""
    profiles, taper = _Profiles(radar.waveform, window), samples_of(of_velocity(window), radar.waveform.num_chirps)
    share = taper / taper.sum()
    slots = [(tx, chirp) for chirp in range(cube.shape[2]) for tx in range(cube.shape[0])]
    for tx, chirp in with_progress(slots, len(slots), progress, "image"):
        legs = _legs_at(points, radar, world_from_points, start_time + radar.chirp_time(tx, chirp))
        there = legs(radar.transmitters[tx])
        for rx, receiver in enumerate(radar.receivers):
            yield tx, rx, share[chirp] * profiles.at(cube[tx, rx, chirp], there + legs(receiver))


def _checked_cube(cube: ArrayLike, radar: _core.Radar) -> NDArray[np.complex128]:
    if is_coded(radar) or has_steps(radar):
        raise refused(ValueError, "radar", "one with transmitters in turns and chirps that are all alike", radar)
    found, shape = np.asarray(cube), signal_shape(radar)
    if found.shape != shape or found.dtype.kind not in "fc" or not np.all(np.isfinite(found)):
        raise refused(ValueError, "cube", f"an array {list(shape)} of finite numbers, as the radar makes it", cube)
    return found


def _legs_at(points, radar, world_from_points, time: float):
    """Function of an antenna that gives its _Legs to the points at a time in s, the middle of a chirp."""
    step = 0.5 * radar.waveform.window_centre  # motions may begin at the first sample of a frame and end at its last one
    before, middle, after = (np.linalg.inv(world_from_points(moment)) @ radar.world_from_radar(moment)
                             for moment in (time - step, time, time + step))
    rate = (after - before) / max(2.0 * step, np.finfo(float).tiny)  # of a single sample it is 0, which knows of none

    def legs(antenna) -> _Legs:
        place = np.append(antenna.position, 1.0)
        way = (middle @ place)[:3] - points
        length = np.linalg.norm(way, axis=-1)
        return _Legs(length, way @ (rate @ place)[:3] / np.maximum(length, np.finfo(float).tiny))

    return legs


class _Profiles:
    """Range profiles of chirps, read at any way there and back."""

    def __init__(self, waveform: _core.ChirpSequence, window: MapWindow):
        self._waveform = waveform
        self._taper = range_taper(waveform, window)
        bins = FINER * waveform.num_samples
        self._end = bins // 2 if waveform.real else bins
        self._sense = -1.0 if waveform.falls else 1.0
        self._from_middle = np.exp(self._sense * 1j * np.pi * (waveform.num_samples - 1) / bins * np.arange(bins))

    def at(self, samples, legs: _Legs) -> NDArray[np.complex128]:
        """What the profile of a chirp [sample] has at some _Legs, turned back by the phase that an echo has over them."""
        waveform, delay = self._waveform, legs.length / _core.speed_of_light
        middle_frequency = waveform.start_frequency + waveform.slope * waveform.window_centre
        beat = waveform.slope * delay + middle_frequency * legs.rate / _core.speed_of_light
        place = np.clip(self._sense * beat / waveform.sampling_rate, 0.0, 1.0) * FINER * waveform.num_samples
        below = np.minimum(place.astype(np.int64), self._end - 2)
        profile = range_transform(samples * self._taper, waveform, len(self._from_middle)) * self._from_middle
        value = profile[below] + (place - below) * (profile[below + 1] - profile[below])
        return np.where(place < self._end - 1, value * np.conj(_core.middle_phases(legs.length, waveform)), 0.0)
