"""What other FMCW radars send into a receiver."""
from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _core
from .checks import an, checked, optional, real
from .selections import power
from .transmit import code_of, radar_of_noise

_FINE = 4       # times the sampling rate, at which crossings are made before the filter
_MARGIN = 1.9   # of the sampling rate: differences of frequency beyond which nothing of a crossing is left in the band
MOST_PATHS = 64  # of a trace, the strongest: each is a crossing of its own in every chirp


class _Route(NamedTuple):
    """One way from the antennas of the other radar to a receiver: delay [T] s and amplitude [T] sqrt(W) at times [T] s."""

    delay: np.ndarray
    amplitude: np.ndarray


@checked(other=an(_core.Radar), paths=optional(an(_core.Paths)), start_time=real(unit="s"), offset=real(unit="s"))
def interference(radar: _core.Radar, other: _core.Radar, paths: _core.Paths | None = None, *, start_time: float = 0.0,
                 offset: float = 0.0) -> NDArray[np.complex128]:
    """The signal of another FMCW radar in the receivers of a radar [tx, rx, chirp, sample], to be added to its own.

    Model: the other radar sends its chirps over and over, frame after frame; each is mixed with the chirp of the radar that is
    under way, and the filter before the converter leaves what lies within the band: a crossing of slopes m and n lasts
    sampling_rate / |m - n|. It sends while it samples. The direct way has the spreading of one way and both antennas' gains
    toward each other as they move, without anything in between; polarisation counts for nothing.
    radar: that receives, its own position, motion and antennas; other: that sends, likewise, with a waveform of its own
    paths: one-way paths from the other radar to this one, instead of the direct way: those of a trace by a radar that has the
        transmitters of the other and the receivers of this one, both as they stand in the middle of the frame
        (`interference_radar`), its 64 strongest; None: the direct way alone. A trace has no direct way: the two signals add up
    start_time: s, first sample of the frame; offset: s, by which frames of the other radar begin later than at time 0
    Returns the cube before `demultiplex`, [tx, rx, chirp, sample] or [1, rx, slots, sample], in sqrt(W). As a part of its own
    beside the others, {"interference": cube}, it is named by labels of detections. Raises TypeError or ValueError naming the
    argument.
    """
    paths = None if paths is None else _strongest(paths)
    slots = radar_of_noise(radar)
    waveform = slots.waveform
    cube = np.zeros((len(slots.transmitters), len(radar.receivers), waveform.num_chirps, waveform.num_samples), complex)
    begins = np.array([[waveform.slot_start(chirp * slots.num_slots + tx) for chirp in range(waveform.num_chirps)]
                       for tx in range(len(slots.transmitters))])
    for tx, chirp in np.ndindex(begins.shape):
        begin = start_time + begins[tx, chirp]
        for slot in _slots_under_way(other, begin - offset, waveform.chirp_duration):
            for rx, route in _routes(radar, other, paths, slot.transmitters, begin + 0.5 * waveform.chirp_duration):
                cube[tx, rx, chirp] += _crossing(waveform, other.waveform, begin, slot.begin + offset, route)
    return np.sqrt(2.0) * cube.real + 0j if waveform.real else cube


@checked(other=an(_core.Radar), time=real(unit="s"))
def interference_radar(radar: _core.Radar, other: _core.Radar, *, time: float = 0.0) -> _core.Radar:
    """A radar whose trace has the one-way paths from another radar to this one.

    radar: that receives; other: that sends; time: s, at which both are where their motions have them
    Returns a Radar with the transmitters of the other and the receivers of the first, their places [3] in m in the world, and
    the waveform and the power of the other. Raises TypeError or ValueError naming the argument.
    """
    return other.replace(transmitters=_placed(other.transmitters, other, time),
                         receivers=_placed(radar.receivers, radar, time), position=(0, 0, 0), yaw=0.0, pitch=0.0,
                         motion=None, receiver=None)


def _placed(antennas, radar, time: float) -> list:
    place = radar.world_from_radar(time)
    turn = _core.Antenna(orientation=_quaternion(place[:3, :3]))
    return [one.replace(position=place[:3, :3] @ one.position + place[:3, 3],
                        orientation=_product(turn.orientation, one.orientation)) for one in antennas]


def _quaternion(rotation) -> np.ndarray:
    """(w, x, y, z) of a rotation [3, 3], by the eigenvector of its largest eigenvalue (Bar-Itzhack 2000)."""
    r = rotation
    k = np.array([[r[0, 0] - r[1, 1] - r[2, 2], r[1, 0] + r[0, 1], r[2, 0] + r[0, 2], r[2, 1] - r[1, 2]],
                  [r[1, 0] + r[0, 1], r[1, 1] - r[0, 0] - r[2, 2], r[2, 1] + r[1, 2], r[0, 2] - r[2, 0]],
                  [r[2, 0] + r[0, 2], r[2, 1] + r[1, 2], r[2, 2] - r[0, 0] - r[1, 1], r[1, 0] - r[0, 1]],
                  [r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], np.trace(r)]])
    x, y, z, w = np.linalg.eigh(k)[1][:, -1]
    return np.array([w, x, y, z])


def _product(a, b) -> np.ndarray:
    """Of quaternions (w, x, y, z)."""
    vector = a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:])
    return np.array([a[0] * b[0] - a[1:] @ b[1:], *vector])


def _strongest(paths):
    """The MOST_PATHS strongest paths, by their power at the trace time."""
    if paths.num_paths <= MOST_PATHS:
        return paths
    return paths.select(power >= float(np.sort(paths.power)[-MOST_PATHS]))


class _Slot(NamedTuple):
    """A chirp of the other radar. begin: s; transmitters: [(index, complex code)] of those that send"""

    begin: float
    transmitters: list


def _slots_under_way(other, begin: float, duration: float) -> Iterator[_Slot]:
    """The chirps that may be heard from `begin` on (s, of its own time) for a duration, those of a microsecond of delay too."""
    code, longest = code_of(other), 1e-6 + other.waveform.chirp_duration
    starts = np.array([other.waveform.slot_start(slot) for slot in range(code.shape[1])])
    period = code.shape[1] * other.waveform.mean_interval
    for frame in range(int(np.floor((begin - longest) / period)), int(np.floor((begin + duration) / period)) + 1):
        for slot in np.flatnonzero((frame * period + starts > begin - longest) & (frame * period + starts < begin + duration)):
            senders = np.flatnonzero(code[:, slot])
            yield _Slot(frame * period + starts[slot], [(int(tx), code[tx, slot]) for tx in senders])


def _routes(radar, other, paths, senders, time: float) -> Iterator[tuple[int, _Route]]:
    """(receiver, way) of each way into each receiver, at three times about `time` (s)."""
    times = time + np.array([-1.0, 0.0, 1.0]) * 0.5 * radar.waveform.chirp_duration
    for rx in range(len(radar.receivers)):
        for tx, code in senders:
            if paths is None:
                delay, amplitude = _direct(radar, other, rx, tx, times)
                yield rx, _Route(delay, np.conj(code) * amplitude)
            else:
                delay, amplitude = paths.lengths(times, tx, rx) / _core.speed_of_light, paths.amplitudes(times, tx, rx)
                for path in np.flatnonzero(amplitude.any(axis=0)):
                    yield rx, _Route(delay[:, path], np.conj(code) * amplitude[:, path])


def _direct(radar, other, rx: int, tx: int, times):
    delay, amplitude = np.empty(3), np.empty(3, complex)
    wavelength = _core.speed_of_light / other.waveform.start_frequency
    for i, time in enumerate(times):
        one, two = _placed([other.transmitters[tx]], other, time)[0], _placed([radar.receivers[rx]], radar, time)[0]
        apart = two.position - one.position
        distance = np.linalg.norm(apart)
        fields = [antenna.pattern.field([_seen_from(antenna, way / distance)])[0]
                  for antenna, way in ((one, apart), (two, -apart))]
        delay[i] = distance / _core.speed_of_light
        amplitude[i] = np.sqrt(other.transmit_power) * fields[0] * fields[1] * wavelength / (4.0 * np.pi * distance)
    return delay, amplitude


def _seen_from(antenna, direction) -> np.ndarray:
    """A direction [3] in the antenna's frame, unit."""
    w, *vector = antenna.orientation
    turned = direction - 2.0 * w * np.cross(vector, direction) + 2.0 * np.cross(vector, np.cross(vector, direction))
    return turned / np.linalg.norm(turned)


def _crossing(waveform, sent, begin: float, sent_begin: float, route: _Route) -> np.ndarray:
    """One chirp of the other radar in one chirp of this one: [sample] in sqrt(W), behind the filter."""
    count, rate = waveform.num_samples, waveform.sampling_rate
    time = np.arange(_FINE * count) / (_FINE * rate)
    weights = np.polyfit(np.linspace(0.0, waveform.chirp_duration, 3), route.delay, 2)
    delay = np.polyval(weights, time)
    late = (begin - sent_begin) + time - delay
    difference = waveform.start_frequency + waveform.slope * time - sent.start_frequency - sent.slope * late
    heard = (late >= 0.0) & (late < sent.chirp_duration) & (np.abs(difference) < _MARGIN * rate)
    if not heard.any():
        return np.zeros(count)
    t, u = time[heard], late[heard]
    cycles = (waveform.start_frequency - sent.start_frequency) * t + sent.start_frequency * (t - u) \
        + 0.5 * waveform.slope * t ** 2 - 0.5 * sent.slope * u ** 2
    signal = np.zeros(_FINE * count, complex)
    signal[heard] = np.conj(route.amplitude[1]) * np.exp(2j * np.pi * np.mod(cycles, 1.0))
    spectrum = np.fft.fft(signal)
    spectrum[count // 2 if waveform.real else count:] = 0.0
    return np.fft.ifft(spectrum)[::_FINE]
