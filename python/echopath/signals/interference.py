"""What other FMCW radars send into a receiver."""
from __future__ import annotations

from collections.abc import Iterator
from itertools import product as product_of
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..arguments.checks import an, checked, optional, real
from ..arguments.frame_times import require_motion, require_room
from ..arguments.settings import Polarization, Replay, SignalSettings, TraceSettings
from ..base.radar.chirps import chirps_duration
from ..receiver.chain import transmitted_code
from ..transmit import radar_of_noise
from .interference_crossing import EDGE, FINE, Chirps, add_crossing
from .interference_ways import Ways, require_own_channels


@checked(other=an(_core.Radar), paths=optional(an(_core.Paths)), start_time=real(unit="s"), offset=real(unit="s"),
         interval=optional(real(unit="s")), replay=SignalSettings.RULES["replay"],
         polarization=TraceSettings.RULES["polarization"])
def interference(radar: _core.Radar, other: _core.Radar, paths: _core.Paths | None = None, *, start_time: float = 0.0,
                 offset: float = 0.0, interval: float | None = None, replay: Replay = SignalSettings.replay,
                 polarization: Polarization = TraceSettings.polarization) -> NDArray[np.complex128]:
    """The signal of another FMCW radar in the receivers of a radar [tx, rx, chirp, sample], to be added to its own.

    Model: the other radar sends its chirps over and over, frame after frame; each is mixed with the chirp of the radar that is
    under way, and the filter before the converter leaves what lies within the band: a crossing of slopes m and n lasts
    sampling_rate / |m - n|, of real samples on both sides of its middle. It sends while it samples. Both radars and the scene
    move through the frame: each chirp has the delays and the Doppler of its own time. The direct way has the spreading of one
    way, both antennas' gains toward each other and what their polarisations share, without anything in between.
    radar: that receives, its own position, motion and antennas; other: that sends, likewise, with a waveform of its own and the
        errors of its transmitters, such as their back-off, and of its frequency (`Receiver`)
    paths: one-way paths from the other radar to this one, instead of the direct way: those of a trace by a radar that has the
        transmitters of the other and the receivers of this one, both as they stand in the middle of the frame
        (`interference_radar`), replayed to where both are at each chirp: the strongest that hold 99.9 % of the power, or about
        1024 drawn by the seed of the trace, which have the power of all of them; None: the direct way alone. A trace has no
        direct way: the two signals add up
    start_time: s, first sample of the frame; offset: s, by which frames of the other radar begin later than at time 0
    interval: s, from one of its frames to the next, at least the duration of a frame; None: they follow without a pause
    replay: of those paths, as in `synthesize`; polarization: of the direct way, that of paths is that of their trace: "scalar":
        all antennas count as co-polarised; "auto": by the size of what they share; "jones": with its sign, to be added to paths
        of such a trace
    Returns the cube before `demultiplex`, [tx, rx, chirp, sample] or [1, rx, slots, sample], in sqrt(W). As a part of its own
    beside the others, {"interference": cube}, it is named by labels of detections. Raises TypeError or ValueError naming the
    argument.
    """
    slots = radar_of_noise(radar)
    waveform, num_rx = slots.waveform, len(radar.receivers)
    begins = np.array([waveform.slot_start(slot) for slot in range(waveform.num_chirps * slots.num_slots)])
    for argument, one in (("radar", radar), ("other", other)):
        require_motion(argument, one, (start_time, start_time + radar.frame_duration))
    require_own_channels("other", other)
    period = frame_period(other, interval)
    ways, codes = Ways(radar, other, paths, start_time + begins, replay, polarization), transmitted_code(other)
    # Of whole frames of the other radar nothing is left: beside hours the phase of a chirp would be lost to rounding.
    begins += np.fmod(start_time, period) - np.fmod(offset, period)
    bends = _frequency_error(other)[2:]
    cube = np.zeros((len(begins), num_rx, waveform.num_samples), complex)
    edge = EDGE / waveform.sampling_rate
    for place, begin in enumerate(begins):
        delay, amplitude = ways.of(place)
        fine = np.zeros((num_rx, FINE * (waveform.num_samples + 2 * EDGE)), complex)
        for slot in _slots_under_way(other, codes, period, begin - edge, waveform.chirp_duration + 2.0 * edge,
                                     np.max(delay, initial=0.0)):
            pair = Chirps(waveform, *_chirp(waveform, place), *_sent_chirp(other, slot.index), other.waveform.chirp_duration,
                          begin - slot.begin, bends)
            for rx, (tx, code) in product_of(range(num_rx), slot.transmitters):
                add_crossing(fine[rx], pair, delay[tx, rx], np.conj(code) * amplitude[tx, rx])
        cube[place] = _filtered(fine, waveform)
    # [slot, rx, sample] -> [tx, rx, chirp, sample]
    cube = np.moveaxis(cube.reshape(waveform.num_chirps, slots.num_slots, num_rx, -1), (1, 2), (0, 1))
    cube = np.ascontiguousarray(cube)
    return np.sqrt(2.0) * cube.real + 0j if waveform.real else cube


class _Slot(NamedTuple):
    """A chirp of the other radar. index: within its frame; begin: s; transmitters: [(index, complex code)] of those that send"""

    index: int
    begin: float
    transmitters: list


def frame_period(other, interval: float | None) -> float:
    """s, from frame to frame of a radar that sends over and over. Raises ValueError naming the interval, as `interference`."""
    if interval is None:
        return chirps_duration(other)
    require_room("interval", other, interval)
    return interval


def _slots_under_way(other, codes, period: float, begin: float, duration: float, delay: float) -> Iterator[_Slot]:
    """The chirps that may be heard from `begin` on (s, of its own time) for a duration, over ways of a delay (s) or less.

    codes: `transmitted_code` of the other radar; period: s, from frame to frame of it
    """
    longest = delay + other.waveform.chirp_duration
    starts = np.array([other.waveform.slot_start(slot) for slot in range(codes.shape[1])])
    for frame in range(int(np.floor((begin - longest) / period)), int(np.floor((begin + duration) / period)) + 1):
        for slot in np.flatnonzero((frame * period + starts > begin - longest) & (frame * period + starts < begin + duration)):
            senders = np.flatnonzero(codes[:, slot])
            yield _Slot(int(slot), frame * period + starts[slot], [(int(tx), codes[tx, slot]) for tx in senders])


def _chirp(waveform, slot: int) -> tuple:
    """(Hz, Hz/s) of the chirp of a slot, with its steps."""
    step, wider = (steps[slot % len(steps)] if steps else 0.0
                   for steps in (waveform.frequency_steps, waveform.bandwidth_steps))
    slope = waveform.slope + wider * waveform.sampling_rate / waveform.num_samples
    return waveform.start_frequency + step, slope


def _sent_chirp(other, slot: int) -> tuple:
    """Likewise of another radar, with the error of its oscillator."""
    off, off_slope, *_ = *_frequency_error(other), 0.0, 0.0
    start, slope = _chirp(other.waveform, slot)
    return start + off, slope + off_slope


def _frequency_error(other) -> tuple:
    return () if other.receiver is None else other.receiver.frequency_error


def _filtered(fine, waveform):
    """[rx, sample] of signals [rx, FINE x (sample + 2 EDGE)]: what the filter before the converter leaves of them.

    The one branch of real samples does not tell differences of frequency below 0 from those above: both are left. The outer half
    of both edges fades, so that the end of a chirp is not heard in its beginning.
    """
    samples = slice(FINE * EDGE, -FINE * EDGE, FINE)
    if not fine.any():
        return fine[:, samples]
    if waveform.falls:  # with the conjugate of the band of chirps that rise
        fine = np.conj(fine)
    half = FINE * EDGE // 2
    fade = np.sin(0.5 * np.pi * (np.arange(half) + 0.5) / half) ** 2
    fine[:, :half] *= fade
    fine[:, -half:] *= fade[::-1]
    spectrum, count = np.fft.fft(fine), waveform.num_samples + 2 * EDGE
    removed = slice((count + 1) // 2, fine.shape[1] - (count - 1) // 2) if waveform.real else slice(count, None)
    spectrum[:, removed] = 0.0
    passed = np.fft.ifft(spectrum)[:, samples]
    return np.conj(passed) if waveform.falls else passed
