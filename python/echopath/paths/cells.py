"""Where each path appears in a range-Doppler map."""
from __future__ import annotations

import dataclasses

import numpy as np

from .. import _core
from ..arguments.checks import ArrayLike, anything, array, checked, row_of_channel
from ..base.classes.equality import has_same_fields
from ..base.classes.made_by import made_by
from ..base.process.callers import warn_user
from ..base.radar.velocities import velocity_span_of
from ..base.text.counts import counted
from ..transmit.signals import chirp_of, step_names

TURNING_STEP = 0.125  # chirps, over which the phase of an amplitude is followed: by less than half a turn
OUTSIDE = -1  # index of a path that the anti-alias filter removes, or that lies beyond the axis
_ENDS = array("[2]", kind="whole")
_STATES = 1 << 20  # of paths at times, that are in memory: 40 MiB
_PLACES = "range", "velocity", "range_index", "velocity_index"


@made_by("ep.path_cells")
@dataclasses.dataclass(frozen=True, eq=False)
class PathCells:
    """Range, radial velocity and cell of each path at one channel, in the middle of the frame.

    length: [P] m, from the transmitter by all hits to the receiver
    range: [P] m, where the map shows it: half the length and the shift that the velocity makes (range-Doppler coupling)
    velocity: [P] m/s, half the rate of the length as the phase tells it, receding positive; not folded into the axis of the map
    range_index, velocity_index: [P] i32, nearest cell of the map, velocities folded; both -1 for paths outside of it
    Where the chirps of the transmitter differ, range and indices are those that chirps without steps would have (`path_cells`).
    """

    length: np.ndarray
    range: np.ndarray
    velocity: np.ndarray
    range_index: np.ndarray
    velocity_index: np.ndarray

    def __repr__(self) -> str:
        inside = np.count_nonzero(self.range_index != OUTSIDE)
        return f"PathCells({counted(len(self.length), 'path')}, {inside:,} within the map)"

    @checked(self=anything, range_indices=_ENDS, velocity_indices=_ENDS)
    def within(self, range_indices: ArrayLike, velocity_indices: ArrayLike) -> np.ndarray:
        """Which paths lie in a rectangle of cells: bool [P].

        range_indices, velocity_indices: (first, last) index along each axis of the map, both included
        Raises TypeError or ValueError naming the argument.
        """
        (near, far), (slow, fast) = range_indices, velocity_indices
        inside = (self.range_index >= near) & (self.range_index <= far)
        inside &= (self.velocity_index >= slow) & (self.velocity_index <= fast)
        return inside & (self.range_index != OUTSIDE)

    def __eq__(self, other) -> bool:
        return has_same_fields(self, other) if isinstance(other, PathCells) else NotImplemented

    __hash__ = None


@checked()
def path_cells(paths: _core.Paths, spectrum: _core.RangeDoppler, *, tx: int = 0, rx: int = 0) -> PathCells:
    """The cell of each path in a range-Doppler map of its radar.

    Model: the beat frequency and the slow-time phase of cpp/echopath/signal/kernels/carrier.h at the middle of the frame, with
    the rate of the phase of the path's amplitude: where a point of reflection slides over a turning or curved surface, the
    phase follows that point, and the length the piece of surface that the ray has hit. A path whose velocity changes during
    the frame, and the window's main lobe, spread its power over neighbouring cells. Of steps in frequency and bandwidth that
    repeat with the transmitters, each has its own. Where the chirps of the transmitter itself differ by such steps, as those of
    a radar that hops, the echo of a path is in cells of all velocities: range and indices are those that chirps without steps
    would have, and `detect` tells the paths of cells (`Detections.paths`).
    paths: of `trace`, P of them; spectrum: RangeDoppler, any map of the radar that traced them, for its axes
    tx, rx: indices of the channel's antennas
    Returns PathCells, ranges in m, velocities in m/s. Raises IndexError for antennas that are not there, ValueError for a map of
    other chirps. Warns (RuntimeWarning) where the chirps of the transmitter differ.
    """
    row_of_channel(paths, tx, rx)
    _core.check_axes(spectrum, paths.radar)
    chirp = chirp_of(paths.radar, tx)
    if chirp is None:
        steps = " and ".join(step_names(paths.radar))
        warn_user(f"paths: chirps of transmitter {tx} of their radar differ ({steps}), so that each echo is in cells of all "
                  "velocities: velocity_index is that which chirps without steps would have. Detections tell the paths "
                  "of their cells: ep.detect(spectrum, radar, paths=paths).paths(i)")
    return cells_of(paths, spectrum, tx, rx, chirp)


def cells_of(paths: _core.Paths, spectrum: _core.RangeDoppler, tx: int = 0, rx: int = 0,
             chirp: _core.ChirpSequence | None = None) -> PathCells:
    """The PathCells of `path_cells` where all chirps are alike; chirp: that waveform without steps, None: the radar's without
    its steps."""
    waveform, middle = paths.radar.waveform, chirp_times(paths, tx)[1]
    step, of_chirp = _step_of_lengths(waveform), waveform if chirp is None else chirp
    cells = PathCells(*(np.empty(paths.num_paths, kind) for kind in (float, float, float, np.int32, np.int32)))
    for some, lengths, amplitudes in echoes_at(paths, [middle - step, middle, middle + step, *around(middle, waveform)], tx, rx):
        cells.length[some] = lengths[1]
        turning = turning_of(*amplitudes[3:], waveform)
        places = _places(lengths[1], (lengths[2] - lengths[0]) / (2.0 * step), turning, of_chirp, paths.radar, spectrum)
        for name, values in zip(_PLACES, places, strict=True):
            getattr(cells, name)[some] = values
    return cells


def _step_of_lengths(waveform: _core.ChirpSequence) -> float:
    """s, from the middle of a chirp to the times between which lengths grow: within its samples, since motions may begin at the
    first sample of a frame, which may be a chirp alone, and end at its last one."""
    return 0.5 * (waveform.window_centre or waveform.chirp_duration)


def _places(length, growth, turning, chirp, radar, spectrum) -> tuple:
    """_PLACES, [P] each, of paths of some length in m that grows by so many m/s, and whose amplitudes turn back by so many Hz;
    chirp: waveform of the chirps. The axes of maps are those of the radar's without steps."""
    waveform = radar.waveform
    delay = length / _core.speed_of_light
    carrier = chirp.start_frequency + chirp.slope * (chirp.window_centre - delay)
    rate = growth + _core.speed_of_light / carrier * turning
    doppler = carrier * rate / _core.speed_of_light  # Hz, slow time
    beat = chirp.slope * delay + doppler             # Hz, fast time
    range_index = _range_index(beat, waveform, spectrum.range)
    velocity_index = _velocity_index(0.5 * waveform.wavelength * doppler, spectrum.velocity, radar)
    velocity_index[range_index == OUTSIDE] = OUTSIDE
    return beat * _core.speed_of_light / (2.0 * waveform.slope), 0.5 * rate, range_index, velocity_index


def echoes_at(paths, times, tx: int = 0, rx: int = 0):
    """Yields (slice of paths, lengths [T, N] in m, amplitudes [T, N] in sqrt(W)) at some times [T] in s, a block of paths after
    the other. tx, rx: indices of the antennas"""
    block = max(1, _STATES // len(times))
    for first in range(0, paths.num_paths, block):
        some = slice(first, min(first + block, paths.num_paths))
        yield some, *paths._echoes_together(times, tx, rx, some.start, some.stop)


def around(time: float, waveform) -> list:
    """The times in s between which `turning_of` follows the phase of an amplitude at a time in s."""
    half = 0.5 * TURNING_STEP * waveform.chirp_duration
    return [time - half, time + half]


def turning_of(before, after, waveform) -> np.ndarray:
    """Rate [P] in Hz by which the phase of each amplitude falls, 0 of one that is 0; before, after: [P] at the times of
    `around`."""
    turned = before * np.conj(after)
    turned[turned == 0.0] = 1.0  # zeros have signs, by which their angle may be half a turn
    return np.angle(turned) / (2.0 * np.pi * TURNING_STEP * waveform.chirp_duration)


def chirp_times(paths, tx: int = 0) -> np.ndarray:
    """First chirp, middle and last chirp of the frame for a transmitter, [3] in s."""
    first, last = (paths.radar.chirp_time(tx, chirp) for chirp in (0, paths.radar.waveform.num_chirps - 1))
    return paths.frame.start_time + np.array([first, 0.5 * (first + last), last])


def _range_index(beat, waveform, axis):
    """Nearest cell of each beat frequency in Hz: i32 [P], -1 where the anti-alias filter removes it."""
    step = axis[1] - axis[0] if len(axis) > 1 else np.inf
    index = np.rint(beat * _core.speed_of_light / (2.0 * waveform.slope * step)).astype(np.int32)
    if not waveform.real:
        index[index == len(axis)] = 0  # the last half cell below the sampling rate
    highest = waveform.sampling_rate * (0.5 if waveform.real else 1.0)
    passes = (beat <= 0.0) & (beat > -highest) if waveform.falls else (beat >= 0.0) & (beat < highest)
    index[~passes | (index >= len(axis))] = OUTSIDE
    return index


def _velocity_index(velocity, axis, radar):
    """Nearest cell of each velocity in m/s, folded into the axis: i32 [P]."""
    count = len(axis)
    step = velocity_span_of(radar) / count
    return ((np.rint(velocity / step).astype(np.int64) + count // 2) % count).astype(np.int32)
