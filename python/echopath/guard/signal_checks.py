"""Samples against direct sums, and moving echoes against exact ones, at places of the frame drawn by chance."""
from __future__ import annotations

import numpy as np

from .. import _core
from .._core import amplitude_tolerance
from ..arguments.checks import ArrayLike, an, checked, refused
from ..arguments.settings import SignalSettings
from .check import Check

LARGEST_OF_RMS = 6.0    # how much a NUFFT may err in one sample, over its rms of all samples
ROUNDING = 1e-13        # of the sum of |amplitude|: of the direct sums
BEYOND_TAIL = 10.0      # what a polynomial leaves out may add up to, over its last two coefficients, which the aims are for


@checked(**SignalSettings.RULES, probe=an(_core.SignalProbe))
def check_signal(cube: ArrayLike, probe: _core.SignalProbe, *, tolerance: float = SignalSettings.tolerance,
                 phase_tolerance: float = SignalSettings.phase_tolerance) -> list[Check]:
    """What spot checks say of a signal.

    cube: complex [tx, rx, chirp, sample] in sqrt(W), of `synthesize` or the sum of the parts of `decompose`; probe: the
    SignalProbe that was filled with it; tolerance: rms of the samples, relative, and phase_tolerance: rad, as promised
    Returns list [C] of Check: samples against direct sums of all echoes, then phases and amplitudes of moving echoes between
    nodes against evaluation at the chirp (none where nothing moves), amplitudes over the largest of the echoes in the frame.
    Raises TypeError or ValueError naming the argument, also for a probe that no signal has filled and for a cube without the
    samples that it has drawn.
    """
    _require_samples(cube, probe)
    checks = [_samples(cube, probe, tolerance)]
    count = int(probe.num_echoes.sum())
    if count == 0:
        return checks
    name = "moving echoes"
    phase, amplitude = float(np.max(probe.phase_error)), float(np.max(probe.amplitude_error))
    return [*checks, Check(f"{name}, phase", phase, BEYOND_TAIL * phase_tolerance, "rad rms", count),
            Check(f"{name}, size", amplitude, BEYOND_TAIL * amplitude_tolerance(phase_tolerance), "of the largest amplitude rms",
                  count)]


def _require_samples(cube, probe) -> None:
    """Raises ValueError unless there are samples of the probe, and the cube reaches as far as they do."""
    if not len(probe.chirp):
        raise refused(ValueError, "probe", "one that synthesize or decompose has filled", probe)
    least = [int(np.max(drawn)) + 1 for drawn in (probe.tx, probe.rx, probe.chirp, probe.sample)]
    if any(size < needed for size, needed in zip(cube.shape, least)):
        raise refused(ValueError, "cube", f"the one that the probe was filled with, of at least {least}", cube)


def _samples(cube, probe, tolerance: float) -> Check:
    """The rms over the samples drawn of each chirp, the largest of all chirps."""
    got = cube[probe.tx[:, None], probe.rx[:, None], probe.chirp[:, None], probe.sample]
    apart = np.sqrt(np.mean(np.abs(got - probe.value) ** 2, axis=1))
    with np.errstate(divide="ignore", invalid="ignore"):
        error = np.where(apart == 0.0, 0.0, apart / probe.amplitude_sum)
    promise = LARGEST_OF_RMS * max(tolerance, ROUNDING)
    return Check("samples against direct sums", float(np.max(error, initial=0.0)), promise, "of the sum of |a|", got.size)
