"""The signal of ideal point targets, by closed forms: references for scenes, and targets to be added to what a scene gives."""
from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..arguments.checks import ArrayLike, array, checked, optional, takes
from ..arguments.number_rules import start_time_rule
from ..arguments.shown import refused
from ..base.numerics.rotations import matrices
from ..base.radar.antennas import antennas_of, are_crossed
from ..receiver.chain import transmitted_code
from ..transmit import code_signal, is_coded, slots_radar
from ..transmit.signals import by_kind_of_chirp, has_steps
from .rows import row_times, signal_of_rows

Places = Callable[[float], NDArray[np.float64]]  # of the time in s, [N, 3] in m

_PLACES = array("[N, 3]", finite=True)


def _places_rule(argument: str, value):
    if not callable(value):
        return _PLACES(argument, value)
    if not takes(value, 0.0):
        raise refused(TypeError, argument, "an array [N, 3], or a function of the time in s that returns one", value)
    return value


@checked(positions=_places_rule, rcs=array("[]", "[N]", finite=True), velocities=optional(array("[3]", "[N, 3]", finite=True)),
         phases=optional(array("[]", "[N]", finite=True)), start_time=start_time_rule)
def point_targets(radar: _core.Radar, positions: ArrayLike | Callable[[float], ArrayLike], rcs: ArrayLike, *,
                  velocities: ArrayLike | None = None, phases: ArrayLike | None = None, start_time: float = 0.0
                  ) -> NDArray[np.complex128]:
    """The noise-free IF signal of ideal point targets in free space: no rays, no scene.

    Each channel has the delay, the level and the patterns of its own two ways, in every chirp anew, so that near targets and
    radars that move are right; within a chirp ways change evenly. Nothing hides a target, no ground
    reflects it, air takes nothing, and what is beyond the axis of range is not heard. Signals add: `cube + ep.point_targets(...)`
    puts targets into that of a scene.
    radar: whose antennas have one polarisation
    positions: [N, 3] in m, in the world at time 0, or a function of the time in s that returns them, for any motion
    rcs: [N] or one for all, in m^2, 0 or more: echoes that fade are drawn by the caller
    velocities: [N, 3] or [3] for all, in m/s, beside positions that are no function; None: at rest
    phases: [N] or one for all, in rad, by which the fields are ahead as they leave the targets; None: 0. The signal, whose phase
        grows with the way, has them with the other sign: a target that comes nearer by d is as one of the phase 4 pi d/wavelength
    start_time: s, within 1e9 s of zero: the first sample of the frame
    Returns the cube of `synthesize` for that radar, complex128 in sqrt(W): before `demultiplex` where transmitters send at once.
    Takes some 0.2 us of a processor for each target, chirp and channel, besides the samples. Raises TypeError or ValueError
    naming the argument, also for antennas of several polarisations and for targets at an antenna.
    """
    if are_crossed(antennas_of(radar)):
        raise refused(ValueError, "radar", "one whose antennas have one polarisation: point targets have no other", radar)
    places = _places(positions, velocities)
    count = len(places(start_time))
    targets = _Targets(_as_many(places, count), *_levels(count, rcs, phases), start_time)
    if not is_coded(radar):
        return targets.separate(radar)
    return code_signal(targets.separate(slots_radar(radar)), transmitted_code(radar), radar.waveform)


def _places(positions, velocities) -> Places:
    if not callable(positions):
        begin, rate = np.asarray(positions, float), np.asarray(0.0 if velocities is None else velocities, float)
        if rate.ndim == 2 and rate.shape != begin.shape:
            raise refused(ValueError, "velocities", f"[3], or a row for each of {len(begin)} positions", velocities)
        return lambda time: begin + rate * time
    if velocities is not None:
        raise refused(ValueError, "velocities", "left out where positions are a function of the time", velocities)
    return lambda time: _PLACES(f"positions({time:g})", positions(time)).astype(float)


def _as_many(places: Places, count: int) -> Places:
    """The same, of so many targets at all times. It raises ValueError for others."""
    def checked_places(time: float) -> NDArray[np.float64]:
        found = places(time)
        if len(found) != count:
            raise refused(ValueError, f"positions({time:g})", f"{count} positions, as at the start", found)
        return found

    return checked_places


def _levels(count: int, rcs, phases) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """rcs in m^2 and phases in rad, [N] each."""
    found = []
    for name, values in (("rcs", rcs), ("phases", 0.0 if phases is None else phases)):
        if np.ndim(values) == 1 and len(values) != count:
            raise refused(ValueError, name, f"one number, or one for each of {count} positions", values)
        found.append(np.broadcast_to(np.asarray(values, float), count))
    if np.any(found[0] < 0.0):
        raise refused(ValueError, "rcs", "in m^2, 0 or more", rcs)
    return found[0], found[1]


class _Targets:
    """N point targets in one frame."""

    def __init__(self, places: Places, rcs, phases, start_time: float):
        self._places, self._start_time = places, start_time
        self._echoes = np.sqrt(rcs) * np.exp(1j * phases)

    def separate(self, radar: _core.Radar) -> NDArray[np.complex128]:
        """The signal of each transmitter alone, [tx, rx, chirp, sample]."""
        if has_steps(radar):
            return by_kind_of_chirp(radar, lambda one: [{0: self._alike(one)}])[0][0]
        return self._alike(radar)

    def _alike(self, radar: _core.Radar) -> NDArray[np.complex128]:
        """Of chirps that are all alike."""
        wavelength = _core.speed_of_light / radar.waveform.centre_frequency
        level = np.sqrt(radar.transmit_power / (4.0 * np.pi) ** 3) * wavelength
        num_chirps = radar.waveform.num_chirps
        cube = np.empty((len(radar.transmitters), len(radar.receivers), num_chirps, radar.waveform.num_samples), complex)
        for i, transmitter in enumerate(radar.transmitters):
            times = self._start_time + row_times(radar, i)
            points = self._in_radar(radar, times)
            out, sent = _legs(transmitter, points, num_chirps)
            for j, receiver in enumerate(radar.receivers):
                back, heard = _legs(receiver, points, num_chirps)
                fields = level * self._echoes * sent * heard / (out * back)[:num_chirps]
                cube[i, j] = signal_of_rows(radar, (out + back) / _core.speed_of_light, fields)
        return cube

    def _in_radar(self, radar, times) -> NDArray[np.float64]:
        """The targets at times in s, [rows, N, 3] in m, in the radar's frame."""
        world_from_radar = np.array([radar.world_from_radar(time) for time in times])
        away = np.array([self._places(time) for time in times]) - world_from_radar[:, None, :3, 3]
        return away @ world_from_radar[:, :3, :3]


def _legs(antenna, points, num_chirps: int) -> tuple[NDArray[np.float64], NDArray[np.complex128]]:
    """Lengths in m of the ways from an antenna to points [rows, N, 3] in the radar's frame, [rows, N], and its pattern toward
    their ends in the middles of the chirps, which are the first rows, [chirps, N]."""
    ways = points - antenna.position
    lengths = np.linalg.norm(ways, axis=2)
    if not np.all(lengths > 0.0):
        raise refused(ValueError, "positions", "away from the antennas", antenna)
    toward = ways[:num_chirps] / lengths[:num_chirps, :, None] @ matrices(antenna.orientation)
    return lengths, antenna.pattern.field(toward.reshape(-1, 3)).reshape(lengths[:num_chirps].shape)
