"""The oscillator that transmitters and mixers share: what it does in the meantime of an echo's delay.

An oscillator of phase phi turns an echo of delay d by phi(t) - phi(t - d): noise of offset f is left with the factor
4 sin^2(pi f d) of its power (range correlation; Budge, Burt 1993). A beat frequency f tells its delay, d = f / slope, and a
filter that turns frequency f by pi f^2 / slope brings each beat frequency forward by its delay. Between that filter and its
opposite all echoes are multiplied by one function m, which has gone through the filter too: a tone f then comes out as
m(t - f / slope) times the tone, exactly. All delays cost a few transforms of a chirp.

A chirp of N samples is worked on at P times its sampling rate, over two of its durations: the signal repeats, and the
oscillator has its past in the first half, which is bent so that it goes on from the end of the second. P is 2, and more where
frequency errors are large: what they make of the band must not fold, or its delays were others.

The signal of chirps that fall is worked on as its conjugate: that of chirps that rise and of an oscillator of phase -phi.
"""
from __future__ import annotations

import numpy as np

from ..base.numerics.analytic import analytic, as_samples
from .filters import NEGATIVE_SHARE
from .leakage import leaked_tone
from .settings import Receiver

SLOTS_AT_ONCE = 16
# Offsets up to so many lines of a chirp, two of which make a cell of range, go on from chirp to chirp, less and less of their
# power: near an echo velocities tell what comes from which offset, and noise of each chirp's own would be spread over them.
_LINES_THAT_GO_ON = 10
_MANY_SLOW_LINES = 1 << 15  # of a frame, beyond which fewer of a chirp go on: idle times between chirps fold them all alike
_MOST_SLOW_LINES = 1 << 21  # of which a frame has its noise in a gigabyte
_LARGEST_ERROR = 31.0  # sampling rates, of the frequency within a chirp: P is 64 then
_OVERSAMPLING = 32  # of the slow part of the phase noise, which is interpolated by straight lines


class Oscillator:
    """Phase noise and frequency error of a frame.

    receiver: Receiver; slots: SlotTimes; generator: of the phase noise, None: without noise
    """

    def __init__(self, radar, receiver: Receiver, slots, generator):
        self._waveform, self._slots = radar.waveform, slots
        sense = -1.0 if radar.waveform.falls else 1.0
        self._slope = sense * slots.slope
        self._noise = None if generator is None else receiver.phase_noise
        self._error = receiver.frequency_error
        self.is_ideal = self._noise is None and not self._error
        self._count = radar.waveform.num_samples
        if not self.is_ideal:
            self._rate = self._times_sampling_rate()
            self._size = 2 * self._rate * self._count
            self._phase = sense * self._phases(generator)  # [T, C or 1, 2 P N], rad

    def mixed(self, cube: np.ndarray) -> np.ndarray:
        """The cube [T, rx, C, sample] with what the oscillator does to the echoes in it, by their beat frequencies."""
        return self._of_pieces(cube, self._mixed_chirps)

    def alone(self, cube: np.ndarray) -> np.ndarray:
        """A cube [T, rx, C, sample] of what another oscillator sent: it turns by the phase of now, whatever its delay."""
        return self._of_pieces(cube, lambda spectrum, phase, slope: np.fft.ifft(spectrum) * np.exp(1j * phase))

    def leaked(self, delay: float) -> np.ndarray:
        """An echo of a delay (s) and amplitude 1 with what it does to it: complex, as a cube takes it, [T, 1, C or 1, sample].
        What the filter before the converter cuts off is missing."""
        frequency = self._line_distance * _lines(self._size)
        past = np.fft.ifft(np.fft.fft(np.exp(-1j * self._phase)) * np.exp(-2j * np.pi * frequency * delay))
        # The tone does not repeat as the oscillator does: a filter would make a line at the edge of the band of its step.
        beat = self._slope[..., None] * delay
        turn = self._rising(self._passed(np.exp(1j * self._phase) * past, beat))
        time = np.arange(self._count) / self._waveform.sampling_rate
        return (leaked_tone(self._waveform, self._slots, delay, time) * turn)[:, None]

    def _of_pieces(self, cube, work) -> np.ndarray:
        """A cube whose chirps are worked on some at a time: work(spectrum [rx, C, 2 P N], phase [C or 1, 2 P N] in rad, slope
        [C or 1, 1] in Hz/s) -> signal [rx, C, 2 P N]"""
        made = np.empty(cube.shape, np.complex128)
        for tx in range(cube.shape[0]):
            for begin in range(0, cube.shape[2], SLOTS_AT_ONCE):
                piece = slice(begin, begin + SLOTS_AT_ONCE)
                phase, slope = (_of_chirps(one, tx, piece) for one in (self._phase, self._slope))
                signal = self._passed(work(self._spectrum(cube[tx, :, piece]), phase, slope[..., None]))
                made[tx, :, piece] = as_samples(self._rising(signal), self._waveform.real)
        return made

    def _rising(self, signal):
        """A signal as that of chirps that rise, or back."""
        return np.conj(signal) if self._waveform.falls else signal

    def _spectrum(self, chirps):
        """Of chirps [rx, C, N], sent twice, at P times the sampling rate, [rx, C, 2 P N]."""
        cells, signed = _cells(self._count, self._waveform.real)
        spectrum = np.zeros((*chirps.shape[:-1], self._size), np.complex128)
        signal = self._rising(analytic(chirps, self._waveform))
        spectrum[..., 2 * signed] = 2.0 * self._rate * np.fft.fft(signal)[..., cells]
        return spectrum

    def _mixed_chirps(self, spectrum, phase, slope):
        highest = self._size // 2 + self._middle
        forward = np.exp(1j * np.pi / slope * (self._line_distance * np.arange(highest + 1)) ** 2)
        of_phase, of_band = (forward[..., np.abs(_lines(self._size, middle))] for middle in (0, self._middle))
        common = np.fft.ifft(np.fft.fft(np.exp(-1j * phase)) * of_phase)
        return np.fft.ifft(np.fft.fft(np.fft.ifft(spectrum * of_band) * common) / of_band) * np.exp(1j * phase)

    def _passed(self, signal, beat=0.0):
        """The second half of [..., 2 P N] at the sampling rate, complex, without what lies outside the band once it is turned by
        a beat frequency in Hz, a number or [..., 1]."""
        count = self._count
        line = _lines(self._size) + beat / self._line_distance
        # A mixer of real samples folds what lies below 0, and its filter is as wide there.
        lowest = 1 - count if self._waveform.real else -2 * int(count * NEGATIVE_SHARE)
        in_band = (line >= lowest) & (line < lowest + 2 * count)
        return np.fft.ifft(np.fft.fft(signal) * in_band)[..., self._rate * count::self._rate]

    def _phases(self, generator) -> np.ndarray:
        time = self._time
        phase = np.zeros((self._slots.begin.shape[0], 1, self._size))
        for power, coefficient in enumerate(self._error):
            phase = phase + 2.0 * np.pi * coefficient * time ** (power + 1) / (power + 1)
        if self._noise is not None:
            phase = phase + self._slow_noise(generator, time)
        phase = _bent(phase, self._past(time))
        return phase if self._noise is None else phase + self._fast_noise(generator)

    def _times_sampling_rate(self) -> int:
        """P: even, so that the band and the largest frequency error on both sides of it find room. Raises ValueError for one
        that takes too many samples."""
        sampling_rate = self._waveform.sampling_rate
        duration = self._count / sampling_rate
        time = np.linspace(-min(self._longest_past, duration), duration, 2 * self._count + 2)
        largest = float(np.abs(np.polynomial.polynomial.polyval(time, self._error or (0.0,))).max())
        most = _LARGEST_ERROR * sampling_rate
        if largest > most:
            raise ValueError(f"receiver.frequency_error: must be at most {most:.4g} Hz within a chirp of this sampling rate, got "
                             f"{largest:.4g} Hz")
        highest = 1.0 - NEGATIVE_SHARE - 0.5 * self._middle / self._count
        return 2 * int(np.ceil(highest + largest / sampling_rate))

    @property
    def _middle(self) -> int:
        """The line about which those of the turned band lie: errors find as much room below the band as above it, and noise
        below the nearest echoes, of which it leaves least, as above them."""
        return 0 if self._noise is not None else int(self._count * (1.0 - 2.0 * NEGATIVE_SHARE))

    @property
    def _time(self) -> np.ndarray:
        """[2 P N] s after the first sample, which is in the middle."""
        return (np.arange(self._size) - self._rate * self._count) / (self._rate * self._waveform.sampling_rate)

    def _past(self, time) -> int:
        """Index of the first sample of the past that an echo can have come from."""
        return int(np.clip(np.searchsorted(time, -self._longest_past) - 2, 2, self._rate * self._count))

    @property
    def _longest_past(self) -> float:
        """s, a quarter more than the longest delay of an echo in the band."""
        return 1.25 * self._waveform.sampling_rate / np.min(self._slope)

    @property
    def _line_distance(self) -> float:
        """Hz between the lines of noise within a chirp; what is slower than a few of them goes on from chirp to chirp."""
        return 0.5 * self._waveform.sampling_rate / self._count

    @property
    def _duration(self) -> float:
        """s, after which the slow noise repeats: twice what the frame needs of it."""
        return 2.0 * (self._slots.begin.max() + 2.0 * self._count / self._waveform.sampling_rate)

    @property
    def _lines_that_go_on(self) -> int:
        """How many lines of a chirp the slow noise has."""
        slow_lines = self._line_distance * self._duration
        return int(min(_LINES_THAT_GO_ON, 2 * self._count, max(0.0, _MANY_SLOW_LINES / slow_lines - 0.5)))

    def _fast_noise(self, generator):
        """[T, C, 2 P N] rad: each chirp's own, at the offsets of its lines less what the slow noise has of them."""
        numbers = np.arange(1, 2 * self._count + 1)
        share = 1.0 - self._share_that_goes_on(self._line_distance * numbers)
        return _noise_of_lines(self._noise, numbers, self._line_distance, self._size, self._slots.begin.shape, generator, share)

    def _share_that_goes_on(self, offset):
        """Of the power of the noise at offsets in Hz: all to half a line, which falls by a half cosine to nothing."""
        lines = self._lines_that_go_on
        if lines == 0:
            return (offset < 0.5 * self._line_distance).astype(float)
        return np.cos(0.5 * np.pi * np.clip((offset / self._line_distance - 0.5) / lines, 0.0, 1.0)) ** 2

    def _slow_noise(self, generator, time):
        """[T, C, 2 P N] rad, of one oscillator that goes on through the frame."""
        duration = self._duration
        highest = (self._lines_that_go_on + 0.5) * self._line_distance
        if highest * duration > _MOST_SLOW_LINES:
            raise ValueError(f"receiver.phase_noise: must have frames of at most {0.5 * _MOST_SLOW_LINES / highest:.3g} s, where "
                             f"chirps are as short as {self._count} samples, got {0.5 * duration:.3g} s")
        numbers = np.arange(1, max(2, int(highest * duration) + 1))
        size = 2 * _OVERSAMPLING * (len(numbers) + 1)
        share = self._share_that_goes_on(numbers / duration) if self._lines_that_go_on else 1.0
        slow = _noise_of_lines(self._noise, numbers, 1.0 / duration, size, (), generator, share)
        at = self._slots.begin[..., None] + (time - time[0])
        return np.interp(at, np.arange(size) * duration / size, slow)


def _of_chirps(values, tx: int, piece: slice):
    """Those of a transmitter and some chirps among values [T or 1, C or 1, ...]."""
    of_tx = values[tx if len(values) > 1 else 0]
    return of_tx[piece] if len(of_tx) > 1 else of_tx


def _lines(size: int, middle: int = 0) -> np.ndarray:
    """Signed numbers of the lines of a transform [size], of which the band about a middle one is told apart."""
    return (np.arange(size) - middle + size // 2) % size + middle - size // 2


def _cells(count: int, real: bool):
    """Cells of the transform of a chirp that hold its signal, and their signed numbers."""
    lowest = -int(count * NEGATIVE_SHARE)
    signed = np.arange(lowest, lowest + count)
    if real:
        signed = signed[(signed >= 0) & (signed <= count // 2)]
    return signed % count, signed


def _noise_of_lines(mask, numbers, distance: float, size: int, shape: tuple, generator, share) -> np.ndarray:
    """Noise of a share of the density of a mask, [*shape, size] over one period; numbers: of its lines, `distance` Hz apart."""
    deviation = np.sqrt(0.5 * share * mask.density(distance * numbers) * distance)
    spectrum = np.zeros((*shape, size // 2 + 1), np.complex128)
    spectrum[..., numbers] = deviation * (generator.standard_normal((*shape, len(numbers)))
                                          + 1j * generator.standard_normal((*shape, len(numbers))))
    return np.fft.irfft(spectrum, size) * size


def _bent(phase: np.ndarray, past: int) -> np.ndarray:
    """Phase [..., 2 P N] whose first `past` values lead from its end to the rest by a cubic, so that it can repeat."""
    x = np.arange(1, past + 1) / (past + 1)
    end, end_slope = phase[..., -1:], phase[..., -1:] - phase[..., -2:-1]
    begin, slope = phase[..., past:past + 1], phase[..., past + 1:past + 2] - phase[..., past:past + 1]
    cubic = ((1 + 2 * x) * (1 - x) ** 2 * end + x * (1 - x) ** 2 * (past + 1) * end_slope
             + x ** 2 * (3 - 2 * x) * begin + x ** 2 * (x - 1) * (past + 1) * slope)
    return np.concatenate([cubic, phase[..., past:]], axis=-1)
