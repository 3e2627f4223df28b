"""The ways from another radar to a radar: how long and how strong they are while both move."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..arguments.checks import an, checked, real, refused
from ..arguments.frame_times import require_motion
from ..base.numerics.rotations import matrices, product, quaternions
from ..base.radar.antennas import polarization_across
from ..receiver.channels import require_channels
from .interference_paths import few_paths

_CHIRPS_AT_ONCE = 16  # whose ways are kept, so that memory does not grow with the frame


@checked(other=an(_core.Radar), time=real(unit="s"))
def interference_radar(radar: _core.Radar, other: _core.Radar, *, time: float = 0.0) -> _core.Radar:
    """A radar whose trace has the one-way paths from another radar to this one.

    radar: that receives; other: that sends; time: s, at which both are where their motions have them
    Returns a Radar with the transmitters of the other and the receivers of the first, their places [3] in m in the world, and
    the waveform and the power of the other. Raises TypeError or ValueError naming the argument.
    """
    for argument, one in (("radar", radar), ("other", other)):
        require_motion(argument, one, (time,))
    return other.replace(transmitters=_placed(other.transmitters, other, time),
                         receivers=_placed(radar.receivers, radar, time), position=(0, 0, 0), yaw=0.0, pitch=0.0,
                         motion=None, receiver=None)


def require_own_channels(argument: str, other) -> None:
    """Raises ValueError naming the argument for another radar whose faults are of other antennas than its own."""
    try:
        require_channels(other.receiver, other)
    except ValueError as error:
        raise ValueError(f"{argument}: {error}") from None


def require_apart(radar, other, times, argument: str) -> None:
    """Raises ValueError naming the argument where a transmitter of the other radar stands in a receiver at one of times in s."""
    for time in times:
        sent, heard = (np.array([one.position for one in _placed(antennas, of, time)])
                       for antennas, of in ((other.transmitters, other), (radar.receivers, radar)))
        _require_far(np.linalg.norm(sent[:, None] - heard, axis=2), _wavelength(other), argument)


def antennas_see_each_other(radar, other, time: float, polarization: str) -> bool:
    """Whether any transmitter of the other radar and any receiver of this one have gain toward each other at a time in s, in a
    polarisation that they share; polarization: as in `trace`."""
    times = np.array([time])
    return bool(Ways(radar, other, None, times, "material", polarization).direct(times)[1].any())


def _require_far(distance, wavelength: float, argument: str) -> None:
    """Nearer than a wavelength, the spreading of one way holds no longer, and makes power of nothing."""
    if np.min(distance) < wavelength:
        raise refused(ValueError, argument, f"at least a wavelength, {wavelength:.3g} m, from the receivers that hear it",
                      float(np.min(distance)))


def _wavelength(radar) -> float:
    return _core.speed_of_light / radar.waveform.start_frequency


def _placed(antennas, radar, time: float) -> list:
    place = radar.world_from_radar(time)
    turn = quaternions(place[None, :3, :3])[0]
    return [one.replace(position=place[:3, :3] @ one.position + place[:3, 3],
                        orientation=product(turn, one.orientation)) for one in antennas]


class Ways:
    """Delays and amplitudes of all ways from the transmitters of another radar to the receivers, in each chirp.

    radar: that receives; other: that sends; paths: of a trace between them, None: the direct way; begins: [N] s, of the chirps
    replay: of the paths, as in `synthesize`; polarization: of the direct way, "jones": its field vectors,
        "auto": the size of what they share alone, "scalar": antennas count as co-polarised
    Raises ValueError for paths between other antennas.
    """

    def __init__(self, radar, other, paths, begins, replay: str, polarization: str = "auto"):
        self._radar, self._other, self._begins, self._replay = radar, other, begins, replay
        self._polarization = polarization
        self._paths, self._scale = (None, None) if paths is None else few_paths(paths)
        self._kept = range(0), None, None  # chirps, their delays and amplitudes
        if paths is not None:
            _require_between(paths.radar, radar, other)

    def of(self, chirp: int) -> tuple:
        """(delay [tx, rx, 3, P] in s at the first sample of a chirp, in its middle and at its last sample, amplitude [tx, rx, P]
        in sqrt(W) in its middle)"""
        chirps, delays, amplitudes = self._kept
        if chirp not in chirps:
            chirps = range(chirp, min(chirp + _CHIRPS_AT_ONCE, len(self._begins)))
            delays, amplitudes = self._replayed(self._begins[chirps.start:chirps.stop])
            self._kept = chirps, delays, amplitudes
        return delays[:, :, chirp - chirps.start], amplitudes[:, :, chirp - chirps.start, 1]

    def _replayed(self, begins) -> tuple:
        """Both [tx, rx, C, 3, P] for chirps that begin at [C] s."""
        waveform = self._radar.waveform
        duration = (waveform.num_samples - 1) / waveform.sampling_rate
        times = (begins[:, None] + duration * np.array([0.0, 0.5, 1.0])).ravel()
        found = self.direct(times) if self._paths is None else self._traced(times)
        return tuple(one.reshape(*one.shape[:2], len(begins), 3, one.shape[-1]) for one in found)

    def _traced(self, times) -> tuple:
        between = [interference_radar(self._radar, self._other, time=time) for time in times]
        delays, amplitudes = self._paths._placed_echoes(times, between, self._replay)
        return delays, amplitudes * self._scale

    def direct(self, times) -> tuple:
        """(delay in s, amplitude in sqrt(W)) of the direct way at times [T] in s, both [tx, rx, T, 1]."""
        radar, other, wavelength = self._radar, self._other, _wavelength(self._other)
        heard, sent = (_placed_at(one, antennas, times) for one, antennas in
                       ((radar, radar.receivers), (other, other.transmitters)))
        apart = heard[0] - sent[0][:, None]
        distance = np.linalg.norm(apart, axis=-1)
        _require_far(distance, wavelength, "other")
        ahead = apart / distance[..., None]
        gains = (_fields(other.transmitters, sent[1], ahead)
                 * np.swapaxes(_fields(radar.receivers, heard[1], -np.swapaxes(ahead, 0, 1)), 0, 1))
        if self._polarization != "scalar":
            match = _match(other.transmitters, radar.receivers, sent[1], heard[1], ahead)
            gains = gains * (match if self._polarization == "jones" else np.abs(match))
        amplitude = np.sqrt(other.transmit_power) * gains * wavelength / (4.0 * np.pi * distance)
        return distance[..., None] / _core.speed_of_light, amplitude[..., None]


def _require_between(traced, radar, other) -> None:
    found, needed = ((len(sending.transmitters), len(hearing.receivers)) for sending, hearing in
                     ((traced, traced), (other, radar)))
    if found != needed:
        raise refused(ValueError, "paths", "those of a trace by interference_radar(radar, other), which has "
                      f"{needed[0]} transmitters and {needed[1]} receivers", found)


def _placed_at(radar, antennas, times) -> tuple:
    """Places [A, T, 3] in m and rotations [A, T, 3, 3] of antennas of a radar in the world."""
    placed = np.array([radar.world_from_radar(time) for time in times])
    return (np.array([placed[:, :3, :3] @ one.position + placed[:, :3, 3] for one in antennas]),
            np.array([placed[:, :3, :3] @ matrices(one.orientation) for one in antennas]))


def _fields(antennas, turned, ways) -> np.ndarray:
    """Gain and phase [A, B, T] of antennas, turned by [A, T, 3, 3], toward directions [A, B, T, 3] in the world."""
    return np.array([[antenna.pattern.field(np.einsum("tij,ti->tj", turn, way)) for way in toward]
                     for antenna, turn, toward in zip(antennas, turned, ways)])


def _match(transmitters, receivers, sent, heard, ahead) -> np.ndarray:
    """Share [A, B, T] of the field in the polarisation of receivers, whose antennas are turned by [., T, 3, 3], of that which
    transmitters send along unit vectors [A, B, T, 3] in the world."""
    fields, takers = ([np.einsum("tij,j->ti", turn, antenna.polarization) for antenna, turn in zip(antennas, turned)]
                      for antennas, turned in ((transmitters, sent), (receivers, heard)))
    return np.array([[np.sum(polarization_across(field, way) * polarization_across(taker, way), axis=-1)
                      for taker, way in zip(takers, ways)] for field, ways in zip(fields, ahead)])
