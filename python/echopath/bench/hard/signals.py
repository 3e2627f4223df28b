"""Coherent sums at the end of their digits: phases, tones, tiny and huge levels, edges of what can be measured."""
from __future__ import annotations

from fractions import Fraction

import numpy as np

import echopath as ep
from echopath import _core

from .case import Cases

cases = Cases("Signals")
C = ep.speed_of_light
STATIC = ("direct", "recurrence", "nufft")


def waveform(**changes) -> ep.ChirpSequence:
    fields = dict(start_frequency=77e9, bandwidth=1e9, num_samples=512, sampling_rate=20e6, num_chirps=16,
                  chirp_interval=30e-6)
    return ep.ChirpSequence(**{**fields, **changes})


def radar_of(chirps) -> ep.Radar:
    return ep.Radar(chirps, transmitters=[ep.Antenna()], receivers=[ep.Antenna()])


def tones(chirps, ranges, amplitudes=None, **settings):
    """[chirp, sample] of echoes at `ranges` [P] at rest or [chirps, P] in m."""
    delays = 2.0 * np.atleast_2d(np.asarray(ranges, float)) / C
    amplitudes = np.ones(delays.shape[1]) if amplitudes is None else np.asarray(amplitudes)
    return _core.synthesize_echoes(chirps, delays, np.broadcast_to(amplitudes, delays.shape), **settings)


def exact_samples(chirps, delay: float, samples) -> np.ndarray:
    """Chosen samples of one static echo of amplitude 1 in rational arithmetic: no digit is lost before the sine."""
    f0, slope, tau = Fraction(chirps.start_frequency), Fraction(chirps.slope), Fraction(delay)
    turns = [f0 * tau + slope * Fraction(int(n)) / Fraction(chirps.sampling_rate) * tau - slope * tau * tau / 2
             for n in samples]
    return np.exp(2j * np.pi * np.array([float(turn - turn.__floor__()) for turn in turns]))


def highest_side_lobe(samples, window_db: float) -> float:
    """Largest level beside the main lobe of a tone under a Dolph-Chebyshev window, in dB of its peak."""
    count, pad = len(samples), 16
    power = np.abs(np.fft.fft(samples * _core.window("chebyshev", count, window_db), pad * count)) ** 2
    offset = (np.arange(pad * count) - power.argmax() + pad * count // 2) % (pad * count) - pad * count // 2
    half_width = np.arccosh(10 ** (window_db / 20)) / np.pi + 0.5  # of the main lobe, cells
    return float(10 * np.log10(power[np.abs(offset) > pad * half_width].max() / power.max()))


@cases("carrier phase at 300 m",
       "delays stay in double precision and whole cycles go before the sine (single precision: 0.13 rad)",
       bound=1e-8, unit="rad",
       broken="delays in single precision: 0.054 rad")
def carrier_phase() -> float:
    chirps, worst = waveform(bandwidth=2.4e8, num_chirps=1), 0.0
    samples = [0, 1, 255, 511]
    for distance in (299.0, 299.999999, 300.0, 300.123456789, 310.0):
        made = tones(chirps, [distance], method="direct")[0, samples]
        worst = max(worst, np.abs(np.angle(made / exact_samples(chirps, 2.0 * distance / C, samples))).max())
    return float(worst)


@cases("phase of the default method at 300 m", "the non-uniform FFT keeps to its tolerance of 1e-7",
       bound=6e-7, unit="of the amplitude",
       broken="a kernel of 4 cells instead of 8: 1.8e-5")
def default_phase() -> float:
    chirps = waveform(bandwidth=2.4e8, num_chirps=1)
    ranges = np.linspace(299.0, 300.0, 200)
    made = tones(chirps, ranges, method="nufft")[0]
    exact = sum(exact_samples(chirps, 2.0 * r / C, range(0, 512, 32)) for r in ranges)
    return float(np.abs(made[::32] - exact).max() / len(ranges))


@cases("Doppler spurs of a slow target", "lengths rounded to single precision would make spurs at -48 dBc (100 m, 0.5 m/s)",
       bound=-140.0, unit="dBc",
       broken="delays in single precision: -47 dBc")
def doppler_spurs() -> float:
    chirps = waveform(bandwidth=6e8, num_chirps=512)
    starts = np.arange(512) * chirps.chirp_interval
    samples = tones(chirps, 100.0 + 0.5 * (starts + chirps.window_centre)[:, None], method="direct")
    return highest_side_lobe(samples[:, 256], 160.0)


@cases("120 dB of clutter", "a target 120 dB below each of 300 others, 30 cells behind the last, keeps its level under a "
       "200 dB window", bound=0.1, unit="dB",
       broken="a grid in single precision: 0.17 dB; a window: 0.18 dB")
def weak_beside_strong() -> float:
    chirps, random = waveform(num_chirps=1), np.random.default_rng(8)
    cell = chirps.range_resolution
    clutter, target = random.uniform(10.0, 350.0, 300), 380.5
    phases = np.exp(2j * np.pi * random.random(300))
    both = tones(chirps, cell * np.append(clutter, target), np.append(phases, 1e-6), method="nufft")[0]
    alone = tones(chirps, [target * cell], [1e-6], method="direct")[0]
    taper = _core.window("chebyshev", 512, 200.0)
    spectra = [np.abs(np.fft.fft(samples * taper, 4096)) for samples in (both, alone)]
    peak = int(spectra[1].argmax())
    return float(abs(20 * np.log10(spectra[0][peak] / spectra[1][peak])))


@cases("windows at -160 dB", "every side lobe of a tone stays where the window puts it", bound=-159.5, unit="dB",
       broken="phasors in single precision: -155.6 dB; a window: -157.2 dB")
def deep_window() -> float:
    chirps = waveform(num_chirps=1)
    worst = -np.inf
    for method, tolerance in (("direct", 1e-7), ("recurrence", 1e-7), ("nufft", 1e-11)):
        samples = tones(chirps, [100.37 * chirps.range_resolution], method=method, tolerance=tolerance)[0]
        worst = max(worst, highest_side_lobe(samples, 160.0))
    return worst


@cases("drift of the recurrence", "powers of one phasor over 512 to 65 536 samples, for delays across the band", bound=4e-12,
       unit="of the amplitude",
       broken="steps of the phasor in single precision: 5.6e-5")
def recurrence_drift() -> float:
    worst = 0.0
    for count in (512, 4096, 65536):
        chirps = waveform(num_samples=count, num_chirps=1, chirp_interval=4e-3)
        for place in np.linspace(0.01, 0.99, 99):
            ranges = [place * chirps.max_range]
            made, direct = (tones(chirps, ranges, method=method)[0] for method in ("recurrence", "direct"))
            worst = max(worst, np.abs(made - direct).max())
    return float(worst)


@cases("non-uniform FFT at every tolerance", "rms error over the tolerance asked for, 1e-2 to 1e-12", bound=1.0,
       unit="of the tolerance",
       broken="a kernel 2 cells narrower: 5.1")
def nufft_tolerances() -> float:
    chirps, random = waveform(num_chirps=1), np.random.default_rng(4)
    ranges = random.uniform(0.0, chirps.max_range, 300)
    amplitudes = random.normal(size=300) + 1j * random.normal(size=300)
    exact = tones(chirps, ranges, amplitudes, method="direct")[0]
    ratios = []
    for tolerance in 10.0 ** -np.arange(2, 13):
        error = tones(chirps, ranges, amplitudes, method="nufft", tolerance=tolerance)[0] - exact
        ratios.append(np.sqrt(np.mean(np.abs(error) ** 2)) / np.abs(amplitudes).sum() / tolerance)
    return float(max(ratios))


@cases("non-uniform FFT at the rim of its grid",
       "tones at both ends of the band, on grid points and half-way wrap round right, within the tolerance of 1e-7",
       bound=1e-7, unit="of the amplitude",
       broken="ends of the grid not wrapped round: 0.90")
def nufft_rim() -> float:
    chirps, worst = waveform(num_chirps=1), 0.0
    cell = chirps.range_resolution
    bins = [0.0, 1e-12, 0.25, 0.5, 1.0, 255.5, 256.0, 511.0, 511.5, 511.75, 511.999999]
    for place in bins:
        made, exact = (tones(chirps, [place * cell], method=method)[0] for method in ("nufft", "direct"))
        worst = max(worst, np.sqrt(np.mean(np.abs(made - exact) ** 2)))
    return float(worst)


@cases("one path", "each method gives the exact phase of the equations", bound=6e-7, unit="of the amplitude",
       broken="delays in single precision: 2.2e-5")
def one_path() -> float:
    chirps = waveform(num_chirps=1)
    exact = exact_samples(chirps, 2 * 33.3 / C, range(512))
    return max(float(np.abs(tones(chirps, [33.3], method=method)[0] - exact).max()) for method in STATIC)


@cases("no paths", "zeros, exactly", bound=0.0, unit="sqrt(W)",
       broken="a sum that begins at 1e-20 instead of 0: 1e-20")
def no_paths() -> float:
    return max(float(np.abs(_core.synthesize_echoes(waveform(), np.zeros((1, 0)), np.zeros((1, 0)), method=method)).max())
               for method in STATIC)


@cases("all amplitudes zero", "zeros, exactly, and a map of zeros", bound=0.0, unit="sqrt(W)",
       broken="rows that begin at 1e-20: 6.5e-18")
def zero_amplitudes() -> float:
    chirps = waveform()
    ranges = np.linspace(1.0, 70.0, 300)
    cubes = [tones(chirps, ranges, np.zeros(300), method=method) for method in STATIC]
    maps = [ep.range_doppler(cube[None, None], radar_of(chirps)).values for cube in cubes]
    return float(max(np.abs(values).max() for values in [*cubes, *maps]))


@cases("denormal amplitudes", "amplitudes of 1e-310 give no NaN and nothing larger than their sum (largest sample over it)",
       bound=1.0, unit="of the sum", broken="amplitudes of 1e-309 in their place: 10")
def denormals() -> float:
    ranges, worst = np.linspace(1.0, 70.0, 3000), 0.0
    for method in STATIC:
        made = tones(waveform(), ranges, np.full(3000, 1e-310), method=method)
        assert np.isfinite(made).all()
        worst = max(worst, float(np.abs(made).max() / (3000 * 1e-310)))
    return worst


@cases("levels from 1e-280 to 1e280", "the signal is linear in the amplitudes", bound=1e-12, unit="relative",
       broken="amplitudes in single precision: 1")
def levels() -> float:
    ranges, worst = np.linspace(1.0, 70.0, 300), 0.0
    for method in STATIC:
        unit = tones(waveform(), ranges, np.ones(300), method=method)
        for factor in (1e-280, 1e280):
            scaled = tones(waveform(), ranges, np.full(300, factor), method=method) / factor
            worst = max(worst, float(np.abs(scaled - unit).max() / np.abs(unit).max()))
    return worst


@cases("a chirp of one sample, one chirp", "one number: the carrier's phase; its map is that number", bound=1e-7,
       unit="of the amplitude",
       broken="delays in single precision: 5.1e-3")
def one_sample() -> float:
    chirps, worst = waveform(num_samples=1, bandwidth=1e6, num_chirps=1), 0.0
    distance = 0.3 * chirps.max_range
    exact = exact_samples(chirps, 2 * distance / C, [0])[0]
    for method in STATIC:
        made = tones(chirps, [distance], method=method)
        cell = ep.range_doppler(made[None, None], radar_of(chirps), window="hann").values[0, 0]
        assert made.shape == cell.shape == (1, 1)
        worst = max(worst, abs(made[0, 0] - exact), abs(cell[0, 0] - exact))
    return float(worst)


@cases("beyond the Nyquist range", "what lies outside the band is removed, not folded to a near range", bound=0.0,
       unit="sqrt(W)",
       broken="no anti-alias filter: 2.0")
def beyond_nyquist_range() -> float:
    chirps = waveform()
    return max(float(np.abs(tones(chirps, [1.0001 * chirps.max_range, 1.7 * chirps.max_range], method=method)).max())
               for method in STATIC)


@cases("a target that crosses the Nyquist range", "full level before, nothing behind, nothing in between",
       bound=1e-6, unit="of the amplitude",
       broken="no anti-alias filter: 1")
def across_nyquist_range() -> float:
    chirps, speed = waveform(num_chirps=128), 30.0
    middle = np.arange(128) * chirps.chirp_interval + chirps.window_centre
    edge = chirps.max_range - speed * chirps.centre_frequency / chirps.slope  # range-Doppler coupling
    ranges = edge + speed * (middle - middle.mean())
    worst = 0.0
    for method in STATIC:
        level = np.sqrt(np.mean(np.abs(tones(chirps, ranges[:, None], method=method)) ** 2, axis=1))
        between = np.min([level, np.abs(level - 1.0)], axis=0).max()
        worst = max(worst, float(between), float(np.abs(level[:60] - 1.0).max()), float(level[68:].max()))
    return worst


@cases("a target that crosses zero range",
       "the phases of the equations before and behind the antenna, within the error of the model, 2 pi slope taudot "
       "(Tc/2)^2 = 1.34e-3",
       bound=1.4e-3, unit="of the amplitude",
       broken="no motion within a chirp: 0.21")
def across_zero_range() -> float:
    chirps, start, speed = waveform(num_chirps=64, chirp_interval=1e-3), 0.16, -5.0
    begins, t = np.arange(64) * chirps.chirp_interval, np.arange(512) / chirps.sampling_rate
    ranges = np.abs(start + speed * (begins + chirps.window_centre))
    worst = 0.0
    for method in STATIC:
        made = tones(chirps, ranges[:, None], method=method)
        for j in (2, 20, 40, 61):
            tau = 2 * np.abs(start + speed * (begins[j] + t)) / C
            turns = chirps.start_frequency * tau + chirps.slope * t * tau - 0.5 * chirps.slope * tau ** 2
            worst = max(worst, float(np.abs(made[j] - np.exp(2j * np.pi * turns)).max()))
        worst = max(worst, float(np.abs(made).max()) - 1.0 - 1e-6 if np.isfinite(made).all() else np.inf)
    return worst


@cases("a target that crosses the Nyquist speed", "from 31 to 40 m/s: it stands at its speed before, and behind where its "
       "Doppler folds to, v - 2 v_max", bound=0.1, unit="cells",
       broken="a velocity axis of the start frequency: 0.45; its sign: 127")
def across_nyquist_speed() -> float:
    return max(_speed_error(speed) for speed in (31.0, 31.9, 32.1, 32.4, 34.0, 40.0))


def _speed_error(speed: float) -> float:
    """Of the peak of a map, in velocity cells; at v_max and -v_max it is the same."""
    chirps = waveform(num_chirps=128, chirp_interval=30e-6)
    middle = np.arange(128) * chirps.chirp_interval + chirps.window_centre
    cube = tones(chirps, (20.0 + speed * (middle - middle.mean()))[:, None], method="direct")
    shown = ep.range_doppler(cube[None, None], radar_of(chirps), window="hann", zero_pad=8)
    power = np.abs(shown.values[0, 0]) ** 2
    row = np.unravel_index(power.argmax(), power.shape)[0]
    folded = speed - 2 * chirps.max_velocity() * (speed > chirps.max_velocity())
    return float(abs(shown.velocity[row] - folded) / chirps.velocity_resolution())


@cases("exactly between two cells", "both cells show the same level, the loss of the Hann window (1.42 dB)", bound=0.005,
       unit="dB",
       broken="a symmetric instead of a periodic window: 0.0056")
def between_cells() -> float:
    chirps = waveform(num_chirps=1)
    samples = tones(chirps, [100.5 * chirps.range_resolution], method="direct")
    level = 20 * np.log10(np.abs(ep.range_doppler(samples[None, None], radar_of(chirps), window="hann").values[0, 0, 0]))
    return float(max(abs(level[100] - level[101]), abs(level[100] + 1.4236)))
