"""What halves and batches of the rays of one run say of each other.

Model: at the eight samples of the first probed chirp each share of the rays gives an estimate of the received power:
coherent fields by their sum, paths over rough surfaces by their powers. Halves of the rays are compared by what rough
surfaces return alone: half of a lattice aliases, so that coherent fields of halves differ by decibels where the whole is
right to hundredths; batches are lattices of their own. All that is compared comes from the rays of the run: what none of
them has found, and what all of them do wrong in the same way (a coarse mesh, a footprint), shows nowhere here.
"""
from __future__ import annotations

import math

import numpy as np

from .. import _core
from ..arguments.checks import an, checked
from .check import Check

# Without batches a run gives no standard errors, and promises no more than this.
HALVES_DB = 3.0
STRONGEST_SHARE = 0.25  # of the power, in one path: another ray may as well have missed it
# Of each of the tests between batches, where these scatter normally: one warning in a thousand runs by chance.
FALSE_ALARM_RATE = 1e-3 / 3.0
# Relative scatter of batches that is added to theirs: lattices that hit a target equally often, but for one, would make much
# of a difference that is none.
ALIKE = 0.01
FEWEST_BATCHES = 4      # fewer say nothing of a single one
HALVES = "halves of the rays"


@checked(probe=an(_core.SignalProbe), frame=an(_core.TraceFrame))
def check_rays(probe: _core.SignalProbe, frame: _core.TraceFrame) -> list[Check]:
    """What the shares of the rays say of each other.

    probe: a SignalProbe that was filled with all paths of a trace; frame: TraceFrame of these paths
    Returns list [C] of Check: halves of the rays in dB, or with batches in standard errors; half of the batches and each
    single one against the others; the share of the strongest path; the error in dB where a target was set. Empty for no
    paths. Raises TypeError naming the argument.
    """
    if len(probe.share_power) != 2 * frame.num_batches + 1 or not _has_paths(probe):
        return []
    checks = _halves(probe) if frame.num_batches == 1 else _batches(probe, frame.num_batches)
    return [*checks, *_strongest(probe), *_target(frame)]


def _has_paths(probe) -> bool:
    return bool(probe.strongest[0] > 0.0)


def _level(field, power) -> float:
    """Power in W of coherent fields [8] and of rough surfaces."""
    return float(np.mean(np.abs(field) ** 2) + power)


def _halves(probe) -> list[Check]:
    steady = _level(probe.share_field.sum(axis=0), probe.share_power[2])
    one, two = steady + 2.0 * probe.share_power[:2]
    apart = abs(10.0 * math.log10(one / two)) if one > 0.0 and two > 0.0 else math.inf
    return [Check(HALVES, apart, HALVES_DB, "dB", 2)] if np.any(probe.share_power[:2]) else []


def _strongest(probe) -> list[Check]:
    """Of the sum of powers where fields cancel: there many paths are stronger than their sum."""
    whole = max(_level(probe.share_field.sum(axis=0), probe.share_power.sum()), float(probe.power_sum[0]))
    share = float(probe.strongest[0]) / whole if whole > 0.0 else 0.0
    return [Check("strongest path", share, STRONGEST_SHARE, "of the power", 1)]


def _target(frame) -> list[Check]:
    if frame.target_error_db == 0.0:
        return []
    return [Check("error against its target", frame.error_db, frame.target_error_db, "dB", 1)]


def _batches(probe, count: int) -> list[Check]:
    """Tests of Student between estimates that would scatter alike, if the batches were what they claim to be."""
    power = probe.share_power[:-1].reshape(count, 2)
    alike = ALIKE * _level(probe.share_field.sum(axis=0), probe.share_power.sum())
    halves = _of_mean(count * (power[:, 0] - power[:, 1]), alike)
    checks = [_check(HALVES, halves, count - 1)] if np.any(power) else []
    if count < FEWEST_BATCHES:
        return checks
    estimates = _estimates(probe, count)
    return [*checks, _check("halves of the batches", _of_two(estimates, alike), count - 2),
            _check("one batch against the others", _outlier(estimates, alike), count - 2, num_tests=count)]


def _estimates(probe, count: int):
    """Power of each batch in W as an estimate of the whole, but for what all have in common. Fields f of the batches with
    the mean m count by 2 Re m* (f - m), the first order of |f|^2."""
    field = probe.share_field[:-1].reshape(count, 2, -1).sum(axis=1)
    power = probe.share_power[:-1].reshape(count, 2).sum(axis=1)
    mean = field.sum(axis=0) + probe.share_field[-1]
    return count * (2.0 * np.mean((field * np.conj(mean)).real, axis=-1) + power)


def _check(name: str, statistic: float, freedom: int, num_tests: int = 1) -> Check:
    from scipy.special import stdtrit

    promise = -float(stdtrit(freedom, 0.5 * FALSE_ALARM_RATE / num_tests))  # of |t| of Student's distribution
    return Check(name, statistic, promise, "standard errors", freedom + 1)


def _ratio(difference: float, error: float) -> float:
    return abs(difference) / error if error > 0.0 else 0.0


def _of_mean(values, alike: float) -> float:
    """Mean over its standard error. alike: scatter that is added to that of the values, here and below."""
    return _ratio(float(values.mean()), math.hypot(values.std(ddof=1), alike) / math.sqrt(len(values)))


def _of_two(values, alike: float) -> float:
    """The first half of the values against the others, by the scatter within both."""
    one, two = np.array_split(values, 2)
    scatter = math.sqrt((one.var() * len(one) + two.var() * len(two)) / (len(values) - 2))
    return _ratio(float(one.mean() - two.mean()), math.hypot(scatter, alike) * math.sqrt(1.0 / len(one) + 1.0 / len(two)))


def _outlier(values, alike: float) -> float:
    """The value that lies furthest from the others, by their scatter."""
    def apart(index: int) -> float:
        others = np.delete(values, index)
        scatter = math.hypot(others.std(ddof=1), alike) * math.sqrt(1.0 + 1.0 / len(others))
        return _ratio(float(values[index] - others.mean()), scatter)

    return max(map(apart, range(len(values))))
