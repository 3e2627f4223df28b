"""IF synthesis: time per path and chirp against the error, beside FINUFFT and the direct sum."""
from __future__ import annotations

import time

import numpy as np

import echopath as ep

PATHS, QUICK_PATHS = 102_400, 4_096
CHIRPS, QUICK_CHIRPS = 128, 16
NODES = 4                                       # of the polynomials in time, of delays and amplitudes
TOLERANCES = tuple(10.0 ** -n for n in range(1, 14))
TARGETS = {1e-4: 4.0, 1e-6: 5.0, 1e-10: 4.0}    # times FINUFFT
RATE_TOLERANCE, RATE_TARGET = 1e-6, 400e6       # path-chirps/s
REPEATS = 5
CHIRPS_OF_FINUFFT = 16                          # per repeat
SLOW_COUNTS, QUICK_SLOW_COUNTS = (1, 100, 10_000, 1_000_000), (1, 100)  # echoes of the slow sum
SLOW_SAMPLES = 64                               # of its one chirp
SLOW_METHODS = (("nufft", 1e-4), ("nufft", 1e-7), ("nufft", 1e-10), ("recurrence", 1e-10), ("direct", 1e-10))
SUM_PATHS = 2_048                               # of the sums without a grid, whose time per path is always the same
ERROR_CHIRPS = 2                                # of which the direct sum is made
BODIES = 40                                     # that move each as a whole, 2 m deep
FASTEST = 30.0                                  # m/s
RANGES = (2.0, 72.0)                            # m


def waveform(num_chirps: int, num_samples: int = 512):
    """77 GHz, 1 GHz in 512 samples."""
    return ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9 * num_samples / 512, num_samples=num_samples,
                            sampling_rate=20e6, num_chirps=num_chirps, chirp_interval=60e-6)


class Echoes:
    """Random moving echoes: delays and amplitudes [nodes, paths] at the nodes of a frame.

    scattered: each has a speed of its own, else those of a body share it
    """

    def __init__(self, num_paths: int, num_chirps: int, *, scattered: bool = False, num_samples: int = 512, seed: int = 1):
        draw = np.random.default_rng(seed)
        self.waveform = waveform(num_chirps, num_samples)
        times = ep._core.bench.trial_node_times(self.waveform, NODES)
        body = draw.integers(0, BODIES, num_paths)
        place = draw.uniform(RANGES[0], RANGES[1] - 2.0, BODIES)[body] + 2.0 * draw.random(num_paths)
        speed = draw.uniform(-FASTEST, FASTEST, num_paths if scattered else BODIES)[slice(None) if scattered else body]
        if scattered:
            place = draw.uniform(*RANGES, num_paths)
        turn = np.exp(2j * np.pi * draw.random(num_paths))
        self._place, self._speed, self._amplitude = place, speed, draw.random(num_paths) * turn
        self.delays, _, self.amplitudes = self.at(times[:, None])

    def at(self, times):
        """Delays in s, their rates in s/s and amplitudes at times in s that broadcast with [paths]."""
        return (2.0 * (self._place + self._speed * times) / ep.speed_of_light, 2.0 * self._speed / ep.speed_of_light,
                self._amplitude * (1.0 + 0.1 * np.sin(50.0 * times)))

    @property
    def num_paths(self) -> int:
        return self.delays.shape[1]

    def trial(self, **settings):
        """(wall seconds, processor seconds, samples [chirp, sample]) of their synthesis."""
        return ep._core.bench.synthesis_trial(self.waveform, self.delays, self.amplitudes, **settings)

    def in_few_chirps(self, num_chirps: int) -> Echoes:
        """The same nodes for a shorter frame, which the echoes cross quicker."""
        other = object.__new__(Echoes)
        other.waveform, other.delays, other.amplitudes = waveform(num_chirps), self.delays, self.amplitudes
        return other


def finufft_version() -> str | None:
    """None where it is not installed."""
    try:
        import finufft
    except ImportError:
        return None
    return finufft.__version__


def tones(delays, amplitudes, of_waveform, rates=0.0):
    """Points [P] in [-pi, pi) and strengths [P] of the type-1 transform that gives the samples of echoes in one chirp.

    Phases in extended precision.

    delays: [P] s, in the middle of the chirp; amplitudes: [P] sqrt(W); rates: [P] s/s
    """
    tau = delays.astype(np.longdouble)
    slope = np.longdouble(of_waveform.bandwidth) * of_waveform.sampling_rate / of_waveform.num_samples
    centre = (np.longdouble(of_waveform.num_samples) - 1) / 2 / of_waveform.sampling_rate
    away = np.longdouble(of_waveform.num_samples // 2) / of_waveform.sampling_rate - centre
    beat = slope * tau + (of_waveform.start_frequency + slope * (centre - tau)) * rates
    cycles = of_waveform.start_frequency * tau + slope * tau * (centre - tau / 2) + beat * away
    beat = beat / of_waveform.sampling_rate
    turn = 2 * np.longdouble(np.pi) * (cycles - np.rint(cycles))
    points = (2.0 * np.pi * (beat - np.rint(beat))).astype(float)
    return points, np.conj(amplitudes) * (np.cos(turn).astype(float) + 1j * np.sin(turn).astype(float))


def slow_sum(points, strengths, num_samples: int):
    """Samples [num_samples] of the type-1 transform, one complex exponential for each point and sample."""
    numbers = range(-(num_samples // 2), (num_samples + 1) // 2)
    return np.array([(strengths * np.exp(1j * points * n)).sum() for n in numbers])


class Finufft:
    """Its quickest settings for one tolerance, on one thread, as its own documents advise for one small transform."""

    def __init__(self, points, strengths, num_samples: int, tolerance: float):
        self.points, self.strengths, self.num_samples, self.tolerance = points, strengths, num_samples, tolerance
        tried = [{"upsampfac": factor, "spread_sort": sort} for factor in (2.0, 1.25) for sort in (0, 1)]
        self.settings = min(filter(self._works, tried), key=lambda one: min(self._seconds(one) for _ in range(5)))

    def seconds(self) -> float:
        """Of the processor, for one chirp: its points set, its samples made."""
        return self._seconds(self.settings)

    def samples(self):
        plan = self._plan(self.settings)
        plan.setpts(self.points)
        return plan.execute(self.strengths)

    def _works(self, settings) -> bool:
        """A narrow grid cannot reach every tolerance."""
        return settings["upsampfac"] == 2.0 or self.tolerance >= 1e-8

    def _plan(self, settings):
        import finufft

        return finufft.Plan(1, (self.num_samples,), eps=max(self.tolerance, 1e-14), isign=1, nthreads=1, **settings)

    def _seconds(self, settings) -> float:
        plan = self._plan(settings)
        began = time.thread_time()
        plan.setpts(self.points)
        plan.execute(self.strengths)
        return time.thread_time() - began


def relative_error(actual, expected) -> float:
    return float(np.linalg.norm(actual - expected) / np.linalg.norm(expected))


def measure_synthesis(*, quick: bool = False, tell=None) -> dict:
    """Processor time of one thread in ns per path and chirp, medians of alternated repeats; errors against direct sums."""
    paths, chirps = (QUICK_PATHS, QUICK_CHIRPS) if quick else (PATHS, CHIRPS)
    threads = ep.num_threads()
    ep.set_num_threads(1)
    try:
        found = {"paths": paths, "chirps": chirps, "nodes": NODES, "samples": 512, "rows": _rows(paths, chirps, quick, tell),
                 "sums": [_sum_row(method) for method in ("recurrence", "direct")]}
    finally:
        ep.set_num_threads(threads)
    found["slow"] = [row for count in (QUICK_SLOW_COUNTS if quick else SLOW_COUNTS) for row in _against_slow_sum(count)]
    found["rates"] = [_rate(paths, chirps, count, scattered)
                      for scattered in (False, True) for count in sorted({1, threads})]
    return found


def _rows(paths: int, chirps: int, quick: bool, tell) -> list[dict]:
    bodies, scattered = Echoes(paths, chirps), Echoes(paths, chirps, scattered=True)
    points, strengths = tones(bodies.delays[0], bodies.amplitudes[0], bodies.waveform)
    frame = bodies.in_few_chirps(ERROR_CHIRPS)
    moving_truth = frame.trial(method="direct")[2]
    truth = ep._core.bench.synthesis_trial(waveform(1), bodies.delays[:1], bodies.amplitudes[:1], method="direct")[2][0]
    rows = []
    for tolerance in TOLERANCES:
        theirs = Finufft(points, strengths, 512, tolerance) if finufft_version() else None
        ours_s, scattered_s, theirs_s = [], [], []
        for _ in range(2 if quick else REPEATS):
            ours_s.append(bodies.trial(method="nufft", tolerance=tolerance)[1])
            scattered_s.append(scattered.trial(method="nufft", tolerance=tolerance)[1])
            theirs_s += [theirs.seconds() for _ in range(CHIRPS_OF_FINUFFT)] if theirs else []
        made = frame.trial(method="nufft", tolerance=tolerance)[2]
        row = {"tolerance": tolerance, "error": relative_error(made, moving_truth),
               "ns": 1e9 * np.median(ours_s) / (paths * chirps),
               "scattered_ns": 1e9 * np.median(scattered_s) / (paths * chirps)}
        if theirs:
            row |= {"finufft_ns": 1e9 * np.median(theirs_s) / paths, "finufft_settings": theirs.settings,
                    "finufft_error": relative_error(theirs.samples(), truth)}
            row["gain"] = row["finufft_ns"] / row["ns"]
            row["scattered_gain"] = row["finufft_ns"] / row["scattered_ns"]
        rows.append(row)
        if tell:
            tell()
    return rows


def _sum_row(method: str) -> dict:
    """A sum without a grid. Its error: against phases in extended precision, for echoes at rest."""
    some = Echoes(SUM_PATHS, 4)
    seconds = min(some.trial(method=method)[1] for _ in range(3))
    count = 64
    truth = slow_sum(*tones(some.delays[0, :count], some.amplitudes[0, :count], some.waveform), 512)
    made = ep._core.bench.synthesis_trial(waveform(1), some.delays[:1, :count], some.amplitudes[:1, :count], method=method)[2][0]
    return {"method": method, "ns": 1e9 * seconds / (SUM_PATHS * 4), "error": relative_error(made, truth)}


def _against_slow_sum(count: int) -> list[dict]:
    """Errors of all methods, for echoes each at a speed of its own: rms over the samples, relative to the sum of |amplitude|
    (what the tolerance bounds), and to the rms of the signal. `tolerance` of the sums without a grid is rounding."""
    echoes = Echoes(count, 1, scattered=True, num_samples=SLOW_SAMPLES)
    delays, rates, amplitudes = echoes.at((SLOW_SAMPLES - 1) / 2.0 / echoes.waveform.sampling_rate)
    truth = slow_sum(*tones(delays, amplitudes, echoes.waveform, rates), SLOW_SAMPLES)
    rows = []
    for method, tolerance in SLOW_METHODS:
        made = echoes.trial(method=method, tolerance=tolerance)[2][0]
        rms = float(np.sqrt(np.mean(np.abs(made - truth) ** 2)))
        rows.append({"echoes": count, "method": method, "tolerance": tolerance,
                     "error": rms / float(np.abs(amplitudes).sum()),
                     "error_of_signal": relative_error(made, truth)})
    return rows


def _rate(paths: int, chirps: int, threads: int, scattered: bool) -> dict:
    """Path-chirps per second, lengths and amplitudes interpolated in time."""
    kept = ep.num_threads()
    ep.set_num_threads(threads)
    try:
        echoes = Echoes(paths, chirps, scattered=scattered)
        trials = [echoes.trial(method="nufft", tolerance=RATE_TOLERANCE)[:2] for _ in range(REPEATS)]
    finally:
        ep.set_num_threads(kept)
    wall, processor = (float(np.median(column)) for column in zip(*trials, strict=True))
    return {"threads": threads, "scattered": scattered, "tolerance": RATE_TOLERANCE, "per_second": paths * chirps / wall,
            "per_second_of_free_cores": paths * chirps * threads / processor}
