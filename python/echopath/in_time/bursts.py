"""What maps over time are made of: the cubes of frames in a row, each with its start time."""
from __future__ import annotations

from collections.abc import Hashable, Iterable, Iterator
from typing import NamedTuple

import numpy as np

from .. import _core
from .._core import Selection
from ..arguments.checks import COMMON, ArrayLike, array, refused, row_of_channel, shown
from ..arguments.iterables import iterable
from ..arguments.part_names import BESIDE
from ..arguments.settings import FRAME_KEYWORDS
from ..base.radar.chirps import chirp_period, chirps_duration
from ..frame.frame import Frame
from ..frame.maps import FrameMaps
from ..signals.beside import cubes_beside
from ..signals.parts import decompose, selection_rule
from ..signals.same_radar import WAVEFORM_KINDS
from ..spectra.range_doppler import require_finite_samples

Frames = Frame | ArrayLike | Iterable[Frame] | Iterable[ArrayLike]
Part = str | Hashable | Selection | None
Channel = tuple[int, int] | None

ANY = "any"

_CUBE = COMMON["cube"]
_RULE = "a Frame, a cube [tx, rx, chirp, sample], or some of either"


class Burst(NamedTuple):
    """The chirps of one frame.

    start_time: s; cube: [tx, rx, chirp, sample] in sqrt(W), of all channels of the radar or of one
    radar: that of the frame; transmitters: indices of those that the cube has
    speckle: what tells apart the scatterers of rough surfaces: equal ones go on from burst to burst; ANY where none are known
        to be others, None where they are this burst's own
    """

    start_time: float
    cube: np.ndarray
    radar: object
    transmitters: tuple = ()
    speckle: Hashable = None

    @property
    def end_time(self) -> float:
        """s, when the next chirp would begin."""
        return self.start_time + chirps_duration(self.radar)

    @property
    def earliest_next(self) -> float:
        """s, from when on another may begin: half a sample before the last one is taken, with which the next frame of a
        sequence may begin, or half a chirp before the next chirp would, if that is sooner."""
        last_sample = self.start_time + self.radar.frame_duration
        return min(last_sample - 0.5 / self.radar.waveform.sampling_rate, self.end_time - 0.5 * chirp_period(self.radar))

    def goes_on_from(self, before: Burst) -> bool:
        """Whether the scatterers of a burst before are known to go on in this one."""
        if self.speckle is None or before.speckle is None:
            return False
        return ANY in (self.speckle, before.speckle) or self.speckle == before.speckle

    def middle(self, begin: int, count: int) -> float:
        """s, of `count` chirps from chirp `begin` on, mean over the transmitters."""
        first = np.mean([self.radar.chirp_time(slot, 0) for slot in self.transmitters])
        return float(self.start_time + first + (begin + 0.5 * (count - 1)) * chirp_period(self.radar))


def frames_rule(argument: str, value):
    """What can be iterated for frames or cubes; a single one becomes a list of it."""
    if isinstance(value, Frame | FrameMaps):
        return [value]
    if getattr(value, "ndim", None) == 4:  # also an array of xarray, which could be iterated, too
        return [_CUBE(argument, value)]
    return iterable(argument, value, _RULE)


def channel_rule(argument: str, value) -> Channel:
    """None, or the indices (tx, rx) of a channel."""
    if value is None:
        return None
    rule = "a pair (tx, rx) of indices of at least 0"
    try:
        tx, rx = array("[2]", kind="whole")(argument, value)
    except (TypeError, ValueError) as error:
        raise refused(type(error), argument, rule, value) from None
    if min(tx, rx) < 0:
        raise refused(ValueError, argument, rule, value)
    return int(tx), int(rx)


def part_rule(argument: str, value):
    """None, a Selection, or what names a part, an object or a selection."""
    if not isinstance(value, Hashable):
        raise refused(TypeError, argument, "a name, a Selection or None", value)
    return value


def text_of_part(part: Part) -> str | None:
    """What a map says of the part that was asked for."""
    return None if part is None else str(part)


def bursts(frames, radar, *, part: Part = None, channel: Channel = None, start_times=None) -> Iterator[Burst]:
    """The frames or cubes one after the other, as `spectrogram` takes them.

    Raises TypeError for maps alone, ValueError where time runs back.
    start_times: [F] s of cubes, None: without gaps from 0 on
    """
    before, number = None, -1
    for number, one in enumerate(frames):
        if isinstance(one, Frame):
            burst = _of_frame(one, radar, part, start_times)
        elif isinstance(one, FrameMaps):
            maps = "" if one.power is None else "; their maps over time are ep.load_sequence(path).to_xarray().power"
            raise TypeError(f"frames: must have signals, got {one!r} of files that hold none; those that are saved with "
                            f'keep="all" do{maps}')
        else:
            start = _start_of(number, before, start_times)
            burst = Burst(start, _finite(_CUBE("frames", one)), _radar_of_cubes(radar, part),
                          speckle=None if start_times is None else ANY)
        yield _followed(before, _of_channel(burst, channel))
        before = burst
    if before is None:
        raise ValueError("frames: must have one frame or cube at least, got none")
    if start_times is not None and len(start_times) > number + 1:
        raise _other_count(start_times)


def _of_frame(frame, radar, part, start_times) -> Burst:
    if radar is not None:
        raise refused(ValueError, "radar", "None for frames, which bring theirs", radar)
    if start_times is not None:
        raise refused(ValueError, "start_times", "None for frames, which bring theirs", start_times)
    if frame.cube is None:
        raise ValueError("frames: must have signals, got a record of paths alone")
    cube = frame.noisy_cube if part is None else part_cube(frame, part)
    return Burst(frame.paths.frame.start_time, cube, frame.radar, speckle=_speckle_of(frame.paths))


def _speckle_of(paths) -> Hashable:
    if not np.any(paths.diffuse):
        return ANY
    return ("surface", paths.frame.seed) if paths.frame.scatterers == "surface" else None


def _finite(cube) -> np.ndarray:
    """The cube. Raises ValueError for what is no finite number, which would leave nothing of its column."""
    require_finite_samples("frames", cube)
    return cube


def _start_of(number: int, before: Burst | None, start_times) -> float:
    if start_times is None:
        return 0.0 if before is None else before.end_time
    if number >= len(start_times):
        raise _other_count(start_times)
    return float(start_times[number])


def _other_count(start_times) -> ValueError:
    return ValueError(f"start_times: must have one for each cube, got {len(start_times)}")


def _radar_of_cubes(radar, part):
    if radar is None:
        raise ValueError("radar: must be that of the cubes, got None")
    if part is not None:
        raise refused(ValueError, "part", "None for cubes: give the cubes of the part", part)
    return radar


def _of_channel(burst: Burst, channel: Channel) -> Burst:
    """The burst with all channels or one, and the shape that its radar says."""
    waveform, radar = burst.radar.waveform, burst.radar
    expected = (len(radar.transmitters), len(radar.receivers), waveform.num_chirps, waveform.num_samples)
    if burst.cube.shape != expected:
        raise ValueError(f"frames: cubes must have the shape {expected} of the radar, got {burst.cube.shape}")
    if channel is None:
        return burst._replace(transmitters=tuple(range(len(radar.transmitters))))
    try:
        row_of_channel(radar, *channel)
    except IndexError as error:
        raise IndexError(f"channel: {error}") from None
    tx, rx = channel
    return burst._replace(cube=burst.cube[tx:tx + 1, rx:rx + 1], transmitters=(tx,))


def _followed(before: Burst | None, burst: Burst) -> Burst:
    """The burst, if it is of the same radar as the one before, and later."""
    if before is None:
        return burst
    for name in WAVEFORM_KINDS:
        old, new = getattr(before.radar.waveform, name), getattr(burst.radar.waveform, name)
        if old != new:
            raise ValueError(f"frames: must all have the waveform of the first, got {name} {new} behind {old}")
    if len(before.radar.transmitters) != len(burst.radar.transmitters) or \
            len(before.radar.receivers) != len(burst.radar.receivers):
        raise ValueError("frames: must all have the antennas of the first, got another number of them")
    if burst.start_time < before.earliest_next:
        raise ValueError(f"frames: must come one after the other, got one that starts at {burst.start_time:.9g} s behind one "
                         f"that lets none begin before {before.earliest_next:.9g} s")
    return burst


def part_cube(frame, part):
    """The noise-free cube [tx, rx, chirp, sample] of a part: of `frame.parts`, an object of the scene, what no path makes, such
    as "interference", or a selection."""
    for partition, cubes in frame.parts.items():
        for name, cube in cubes.items():
            if part == name or part == f"{partition}/{name}":
                return cube
    if isinstance(part, str) and part in BESIDE and part not in frame.paths.scene:
        beside = cubes_beside(frame)
        if part in beside:
            return beside[part]
    return _selected_cube(frame, _selection(frame, part))


def _selection(frame, part) -> Selection:
    if isinstance(part, Selection):
        return part
    if not isinstance(part, str):
        raise refused(TypeError, "part", "a name, a Selection or None", part)
    if part in frame.paths.scene:
        return Selection(f"T '{part}'+ R")  # echoes that touch nothing else
    try:
        return Selection(selection_rule("part", part))
    except ValueError as error:
        known = [str(name) for cubes in frame.parts.values() for name in cubes] + list(frame.paths.scene)
        nearest = ", ".join(_core.nearest_names(part, known, 3)) if part.isprintable() else ""
        raise ValueError(f"part: must be a part of the frame, an object of its scene or a selection, got {shown(part)} "
                         f"(nearest: {nearest}; as a selection: {error})") from None


def _selected_cube(frame, selection: Selection):
    settings = {name: getattr(frame, name) for name in FRAME_KEYWORDS}
    # Where records are renewed, the other paths say which surface is new.
    paths = frame.paths.select(selection) if frame.retrace == "never" else frame.paths
    return decompose(paths, frame.radar, {"part": selection}, **settings)["part"]
