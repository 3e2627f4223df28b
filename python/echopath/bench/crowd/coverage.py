"""How often the interval that a run claims covers the true value: coherent, diffuse, ghost and two-bounce echoes."""
from __future__ import annotations

import numpy as np

import echopath as ep

from ...paths.resolution import interval_of
from ..physics import targets
from .echoes import Echo, all_echoes

NUM_SEEDS, QUICK_SEEDS = 60, 4
RAYS, QUICK_RAYS = (2 ** 12, 2 ** 14, 2 ** 16), (2 ** 12,)
TRUE_RAYS, TRUE_RAYS_OF_EACH, QUICK_TRUE_RAYS = 2 ** 22, 2 ** 20, 2 ** 16
BATCHES = 8
WANTED = (0.90, 0.98)   # of a class of echoes
WANTED_OF_ONE = 0.80    # at least, of one body and number of rays
FIRST_SEED = 1000


def measure_coverage(*, quick: bool) -> dict:
    """A row for each echo and number of rays, and one for each class of echoes, over all of its bodies."""
    seeds = [FIRST_SEED + seed for seed in range(QUICK_SEEDS if quick else NUM_SEEDS)]
    rays = QUICK_RAYS if quick else RAYS
    claims = {(echo.kind, count): found for echo in all_echoes() for count, found in _claims(echo, seeds, rays, quick).items()}
    rows = [{"kind": kind, "rays": count, **covered(*found)} for (kind, count), found in claims.items()]
    return {"seeds": len(seeds), "wanted": WANTED, "wanted_of_one": WANTED_OF_ONE, "rows": rows, "classes": _by_class(claims)}


def _claims(echo: Echo, seeds: list, rays: tuple, quick: bool) -> dict:
    """{rays: (what runs claim, the truth), both by seed}"""
    drawn = [echo.draw(seed) for seed in seeds]
    truths = _truths(echo, drawn, quick)
    return {count: ([power_of(echo, scene, num_rays=count, seed=seed, batches=BATCHES) for (scene, _), seed in zip(drawn, seeds)],
                    truths) for count in rays}


def _truths(echo: Echo, drawn: list, quick: bool) -> list:
    """Power of each scene, W."""
    if drawn[0][1] is not None:
        return [truth for _, truth in drawn]
    if echo.differs:
        return [power_of(echo, scene, num_rays=QUICK_TRUE_RAYS if quick else TRUE_RAYS_OF_EACH)[0].power for scene, _ in drawn]
    return [power_of(echo, drawn[0][0], num_rays=QUICK_TRUE_RAYS if quick else TRUE_RAYS)[0].power] * len(drawn)


def _by_class(claims: dict) -> list[dict]:
    """Rows over all bodies and numbers of rays of a class: what the promise of the intervals is about."""
    together = {}
    for (kind, _), (found, truths) in claims.items():
        all_found, all_truths = together.setdefault(kind.split(",")[0], ([], []))
        all_found += found
        all_truths += truths
    num_counts = len({count for _, count in claims})
    return [{"kind": name, "count": len(found), **covered(found, truths, len(found) // num_counts)}
            for name, (found, truths) in together.items()]


def covered(found: list, truths: list, num_independent: int | None = None) -> dict:
    """Share of the powers whose interval holds the truth with its standard error, and how far they are from it, in dB.

    found: (Interval in W, half of it in dB) of each seed; truths: W; num_independent: how many of them are, None: all. Runs of
    one scene with more rays err alike.
    """
    holds = [one.low <= truth <= one.high for (one, _), truth in zip(found, truths)]
    ratios = [one.power / truth for (one, _), truth in zip(found, truths)]
    count = num_independent or len(holds)
    share = (count * np.mean(holds) + 2.0) / (count + 4.0)  # Agresti and Coull 1998: no error of zero where all hold
    return {"coverage": float(np.mean(holds)), "coverage_error": float(np.sqrt(share * (1.0 - share) / (count + 4.0))),
            "mean_error_db": float(10.0 * np.log10(max(np.mean(ratios), 1e-12))),
            "claimed_db": float(np.median([half for _, half in found])),
            "unresolved": int(sum(not one.resolved for one, _ in found))}


def power_of(echo: Echo, scene, **settings):
    """(Interval, half of it in dB). Where no path tells of the echo, the interval is that of surface which no ray has met."""
    paths = ep.trace(scene, targets.radar(), max_bounces=echo.max_bounces, **settings)
    found = ep.received_power(paths.select(echo.selection))
    if echo.objects and not found.high > 0.0:
        name = next(iter(echo.objects))
        return next(one.interval for one in ep.unresolved(paths, echo.objects) if one.name == name), float("inf")
    return interval_of(found), found.interval_db
