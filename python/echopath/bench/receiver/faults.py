"""Faults of receivers beside their closed forms, in dB."""
from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import echopath as ep

RATE, COUNT, BANDWIDTH = 20e6, 512, 1e9
SLOPE = BANDWIDTH * RATE / COUNT
CELL = RATE / COUNT                # Hz
LIMIT = 0.2                        # dB
FLAT_MASK = -130.0                 # dBc/Hz: so little that the square of the phase counts for nothing
DISTANCES, OFFSETS = (3.0, 10.0, 30.0, 60.0), (0.5e6, 1.25e6, 3e6)
CHIRPS, QUICK_CHIRPS = 2000, 500


def rows(*, quick: bool) -> list[dict]:
    """[what, closed form and measured in dB, error in dB, whether it holds] of each fault."""
    chirps = QUICK_CHIRPS if quick else CHIRPS
    found = []
    for what, form, measured in _measured(chirps):
        error = float(measured - form)
        limit = LIMIT if not quick else 2.0 * LIMIT  # of noise, which few chirps know less well
        found.append({"what": what, "form": float(form), "measured": float(measured), "error": error,
                      "holds": bool(abs(error) <= limit)})
    return found


def describe(rows: list[dict]) -> list[str]:
    """Lines for people."""
    lines = [f"{'fault':<46}{'closed form':>12}{'measured':>10}{'error':>8}   dB"]
    return lines + [f"{row['what']:<46}{row['form']:12.2f}{row['measured']:10.2f}{row['error']:8.2f}   "
                    f"{'holds' if row['holds'] else 'MISSED'}" for row in rows]


def _measured(chirps: int) -> Iterator[tuple[str, float, float]]:
    yield from _phase_noise(chirps)
    yield from _leakage(chirps)
    yield from _imbalance()
    yield from _compression()
    yield from _filters()
    yield from _converter()


def _received(cube, receiver: ep.Receiver, seed=None):
    waveform = ep.ChirpSequence(bandwidth=BANDWIDTH, num_samples=COUNT, sampling_rate=RATE, num_chirps=cube.shape[2])
    radar = ep.Radar(waveform, transmitters=[ep.Antenna()], receivers=[ep.Antenna()], receiver=receiver, noise_figure_db=0.0,
                     transmit_power=1.0)
    return ep.receive(cube, radar, seed=seed).cube


def tone(cell, power: float = 1.0, chirps: int = 4) -> np.ndarray:
    """An echo [1, 1, chirp, sample] of a beat frequency of so many cells, in sqrt(W)."""
    return np.sqrt(power) * np.exp(2j * np.pi * cell * np.arange(COUNT) / COUNT) * np.ones((1, 1, chirps, 1))


def _levels(cube) -> np.ndarray:
    return np.mean(np.abs(np.fft.fft(cube, axis=-1) / COUNT) ** 2, axis=(0, 1, 2))


def _floor(cube) -> np.ndarray:
    """Density of noise in each cell in W/Hz, by Hann's window."""
    window = np.sin(np.pi * np.arange(COUNT) / COUNT) ** 2
    return np.mean(np.abs(np.fft.fft(cube * window, axis=-1)) ** 2, axis=(0, 1, 2)) / (RATE * np.sum(window ** 2))


def _db(ratio):
    return 10.0 * np.log10(ratio)


def _correlation(lines, delay: float):
    return 4.0 * np.sin(np.pi * lines * CELL * delay) ** 2


def _phase_noise(chirps: int):
    mask = ep.PhaseNoise(offsets=[1e3], levels=[FLAT_MASK])
    for distance in DISTANCES:
        cell = round(SLOPE * 2.0 * distance / ep.speed_of_light / CELL)
        measured = _floor(_received(tone(cell, 1.0, chirps), ep.Receiver(phase_noise=mask), seed=1))
        for offset in OFFSETS:
            lines = round(offset / CELL) + np.arange(-6, 7)
            form = 10 ** (FLAT_MASK / 10) * _correlation(lines, cell * CELL / SLOPE)
            yield f"phase noise, {distance:g} m, {offset * 1e-6:g} MHz", _db(form.mean()), _db(measured[cell + lines].mean())


def _leakage(chirps: int):
    delay, mask = 1e-9, ep.PhaseNoise(offsets=[1e3], levels=[-110.0])
    receiver = ep.Receiver(leakage_db=[[-20.0]], leakage_delay=delay)
    silent = np.zeros((1, 1, chirps, COUNT))
    yield "leakage", -20.0, _db(np.mean(np.abs(_received(silent, receiver)) ** 2))
    noisy = _received(silent, receiver.replace(phase_noise=mask), seed=1)
    steady = noisy * np.exp(-2j * np.pi * SLOPE * delay * np.arange(COUNT) / RATE)
    lines = np.arange(64, 100)
    form = 1e-2 * 10 ** -11.0 * _correlation(lines, delay)
    yield "phase noise of leakage, 1 ns, 3 MHz", _db(form.mean()), _db(_floor(steady)[lines].mean())


def _imbalance():
    for gain_db, phase in ((0.5, 0.0), (0.0, 0.05), (0.3, -0.03)):
        levels = _levels(_received(tone(70), ep.Receiver(iq_gain_db=gain_db, iq_phase=phase)))
        g = 10 ** (gain_db / 20)
        form = (1 - 2 * g * np.cos(phase) + g * g) / (1 + 2 * g * np.cos(phase) + g * g)
        yield f"image of {gain_db:g} dB, {phase:g} rad", _db(form), _db(levels[COUNT - 70] / levels[70])


def _compression():
    point = -10.0
    for level in (-20.0, -10.0, -4.0):
        blocker, weak = 1e-3 * 10 ** (level / 10), 1e-13
        levels = _levels(_received(tone(40, blocker) + tone(90, weak), ep.Receiver(compression_dbm=point)))
        x = blocker / (1e-3 * 10 ** (point / 10) / (10 ** 0.1 - 1))
        gain, half = (1 + x) ** -0.5, -0.5 * x * (1 + x) ** -1.5
        yield f"weak echo beside one of {level:g} dBm", _db((gain + half) ** 2), _db(levels[90] / weak)


def _filters():
    receiver = ep.Receiver(high_pass=[350e3, 700e3], low_pass=8e6, low_pass_poles=5)
    for cell in (5, 20, 205, 300):
        f = cell * CELL
        high = np.prod([(f / corner) ** 2 / (1 + (f / corner) ** 2) for corner in receiver.high_pass])
        form = high / (1 + (f / 8e6) ** 10)
        yield f"filters at {f * 1e-6:.3g} MHz", _db(form), _db(_levels(_received(tone(cell), receiver))[cell])


def _converter():
    for bits in (8, 10, 12, 14):
        largest = 1.0 - 1.5 / 2 ** (bits - 1)
        cells = 33.317 + 0.713 * np.arange(64)[:, None]
        full = largest * np.sqrt(1e-3) * np.exp(2j * np.pi * cells * np.arange(COUNT) / COUNT)[None, None]
        out = _received(full, ep.Receiver(adc=ep.Adc(bits=bits, full_scale_dbm=0.0, gain_db=0.0)))
        yield f"quantisation, {bits} bits", -6.0206 * bits - 1.7609, _db(np.mean(np.abs(out - full) ** 2) / 1e-3)
    jitter, cell = 20e-12, 200
    adc = ep.Adc(bits=16, full_scale_dbm=33.0, gain_db=0.0, clock_jitter=jitter)
    out = _received(tone(cell, 1.0, 64), ep.Receiver(adc=adc), seed=2)
    form = (2 * np.pi * cell * CELL * jitter) ** 2
    yield "clock jitter of 20 ps at 7.8 MHz", _db(form), _db(np.mean(np.abs(out - tone(cell, 1.0, 64)) ** 2))
