"""Smooth curves in time: periodic ones through control points, and quintic pieces between two states."""
import numpy as np

SAMPLES = 1024          # per period, of the curve that is smoothed
SMOOTHING = 0.012       # standard deviation of the smoothing kernel, in periods
HARMONIC_ROWS = 9       # harmonics are counted in as many rows of as many
NUM_HARMONICS = HARMONIC_ROWS**2 - 1  # the kernel leaves 1e-8 of the amplitude beyond them


class PeriodicCurve:
    """A smooth function of period 1.

    The values `samples` [N] at n / N are smoothed by a Gaussian of SMOOTHING periods, which makes curves whose
    acceleration jumps (piecewise cubics, pieces of cosines) infinitely smooth: a jump would make spurious Doppler
    lines.
    """

    def __init__(self, samples):
        samples = np.asarray(samples, dtype=float)
        harmonic = np.arange(NUM_HARMONICS + 1)
        kernel = np.exp(-2.0 * (np.pi * SMOOTHING * harmonic) ** 2)
        self._coefficients = np.fft.rfft(samples)[: NUM_HARMONICS + 1] / len(samples) * kernel
        self._coefficients[1:] *= 2.0

    @classmethod
    def from_function(cls, function):
        """The smoothed version of a function of the phase in [0, 1)."""
        return cls(function(np.arange(SAMPLES) / SAMPLES))

    @classmethod
    def through(cls, phases, values):
        """Through control points (phases ascending, less than one period from first to last), then smoothed."""
        phases, values = np.asarray(phases, dtype=float), np.asarray(values, dtype=float)
        shifts = np.arange(-2.0, 4.0)
        knots = (phases[None, :] + shifts[:, None]).ravel()
        return cls(monotone_cubic(knots, np.tile(values, len(shifts)), np.arange(SAMPLES) / SAMPLES))

    def __call__(self, phase):
        """Values at phases of any shape. The turns of a harmonic are those to its row times those within the row,
        which takes few exponentials."""
        phase = np.asarray(phase, dtype=float)[..., None]
        within = np.exp(2j * np.pi * phase * np.arange(HARMONIC_ROWS))
        rows = np.exp(2j * np.pi * phase * HARMONIC_ROWS * np.arange(HARMONIC_ROWS))
        return np.sum(rows * (within @ self._coefficients.reshape(HARMONIC_ROWS, HARMONIC_ROWS).T), axis=-1).real


def monotone_cubic(knots, values, at):
    """Cubic Hermite through the knots whose extremes are its knots (Fritsch and Butland 1984, harmonic mean slopes), level at
    both ends.

    The core follows keys by the same slopes (`KeyframeMotion(interpolation="monotone")`, cpp/echopath/motion/spline.h), but for
    the ends, where its curves are parabolas, and in three dimensions alone: shapes and steps of actors are tables of any number
    of columns. Distances over time have those of parabolas throughout (trajectories/profile.py), which are exact where the
    acceleration is constant.
    knots [N]; values [N] or [N, K], of K curves; at [T]. Returns [T] or [T, K].
    """
    values, each = np.asarray(values), (slice(None),) + (None,) * (np.ndim(values) - 1)
    steps = np.diff(knots)
    step = steps[each]
    secant = np.diff(values, axis=0) / step
    before, after = secant[:-1], secant[1:]
    weight_before, weight_after = step[:-1] + 2 * step[1:], 2 * step[:-1] + step[1:]
    same_sign = before * after > 0
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = (weight_before + weight_after) / (weight_before / before + weight_after / after)
    slope = np.zeros(values.shape)
    slope[1:-1] = np.where(same_sign, mean, 0.0)
    k = np.clip(np.searchsorted(knots, at, side="right") - 1, 0, len(steps) - 1)
    s, h = ((at - knots[k]) / steps[k])[each], step[k]
    return ((1 + 2 * s) * (1 - s) ** 2 * values[k] + s * (1 - s) ** 2 * h * slope[k]
            + s**2 * (3 - 2 * s) * values[k + 1] + s**2 * (s - 1) * h * slope[k + 1])


def quintic(s, start, end):
    """The quintic on s in [0, 1] with given (value, first, second derivative by s) at both ends.

    s: [T]; start, end: three values each, scalars or [D]. Returns [T] or [T, D].
    """
    s = np.asarray(s, dtype=float)
    value, slope, bend = (np.asarray(x, dtype=float) for x in start)
    residual = [np.asarray(end[0]) - (value + slope + bend / 2), np.asarray(end[1]) - (slope + bend),
                np.asarray(end[2]) - bend]
    third = 10 * residual[0] - 4 * residual[1] + residual[2] / 2
    fourth = -15 * residual[0] + 7 * residual[1] - residual[2]
    fifth = 6 * residual[0] - 3 * residual[1] + residual[2] / 2
    powers = np.stack([s**0, s, s**2, s**3, s**4, s**5], axis=-1)
    return powers @ np.stack([value + 0 * third, slope + 0 * third, bend / 2 + 0 * third, third, fourth, fifth])
