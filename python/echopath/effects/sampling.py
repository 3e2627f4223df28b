"""How the rays are spread, and what they tell of their own error."""
from __future__ import annotations

from ..base.numerics.decibels import in_dbm
from ..tracing.faint_paths import faint_power_of
from ..tracing.lost_rays import unaimed
from .rules import Case, rule


@rule("even spread of the rays", "trace.sampler")
def _sampler(case: Case):
    return case.settings.sampler != "random", f'sampler = "{case.settings.sampler}"'


@rule("rays aimed at objects")
def _aimed(case: Case):
    if len(case.objects) == 0:
        return False, "nothing but mirrors: all rays fill the field of view"
    images = " and at their images" if len(case.mirrors) and case.settings.max_bounces > 1 else ""
    strata = () if case.paths is None else case.paths.frame.strata
    lost = unaimed(case.statistics, strata) if case.statistics else ""
    missing = f"; {lost}" if lost else ""
    return True, f"a cone or strip that fits each object{images}; the rest of the rays fills the field of view{missing}"


@rule("standard errors", "trace.batches")
def _errors(case: Case):
    count = case.settings.batches
    return count > 1, f"batches = {count}" if count > 1 else "one set of rays; batches = 8 gives them"


@rule("rays until an error is met", "trace.target_error_db")
def _target(case: Case):
    target = case.settings.target_error_db
    return target is not None, "no target_error_db" if target is None else f"target_error_db = {target:g}"


@rule("few faint paths for many", "trace.faint_power")
def _faint_paths(case: Case):
    if len(case.diffuse) == 0:
        return False, "no material scatters diffusely"
    power = faint_power_of(case.settings.faint_power, case.radar)
    if power == 0.0:
        return False, "faint_power = 0: every diffuse path is kept"
    left_out = f", {case.statistics.num_faint_paths} left out" if case.statistics else ""
    return True, f"one in 4, 16 or 64 of the diffuse paths below {in_dbm(power / 4.0):.1f} dBm, with the power of all{left_out}"
