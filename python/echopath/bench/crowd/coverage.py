"""How often the interval that a run claims covers the true value: coherent, diffuse, ghost and two-bounce echoes, and crowns by
one batch of rays."""
from __future__ import annotations

import numpy as np

import echopath as ep

from ...paths.resolution import interval_of
from ..physics import targets
from ..steps import told
from .echoes import Echo, all_echoes, class_of

# Scenes of each body, by class of echoes: the slow ones get fewer, so that all together take some ten minutes.
NUM_SEEDS = {"coherent": 40, "diffuse": 60, "ghost": 40, "two bounces": 20, "one batch": 60}
QUICK_SEEDS = 4
RAYS, QUICK_RAYS = (2 ** 12, 2 ** 14, 2 ** 16), (2 ** 12,)
TRUE_RAYS, TRUE_RAYS_OF_EACH, QUICK_TRUE_RAYS = 2 ** 22, 2 ** 20, 2 ** 16
TRUE_DB = 0.1           # a trace that does not know a power to this is no truth, half its own interval
MOST_DRAWN = 2          # times as many seeds as are wanted, to find scenes whose truth is known
WANTED = (0.90, 0.98)   # of a class of echoes
WANTED_OF_ONE = 0.80    # at least, of one body and number of rays
FIRST_SEED = 1000


def measure_coverage(*, quick: bool, seeds: int | None = None, progress=None) -> dict:
    """A row for each echo and number of rays, and one for each class of echoes, over all of its bodies; left_out: of how many
    scenes that were drawn the truth is not known, by the kind of echo.

    seeds: scenes of each body, None: NUM_SEEDS of its class; progress: callable (stage, fraction) or None
    """
    rays = QUICK_RAYS if quick else RAYS
    claims, left_out = {}, {}
    for echo in told(all_echoes(), "coverage", progress):
        count = QUICK_SEEDS if quick else seeds or NUM_SEEDS[echo.of_class]
        drawn = _drawn(echo, count, quick)
        left_out[echo.kind] = drawn[-1][0] - FIRST_SEED + 1 - count
        claims |= {(echo.kind, of): found for of, found in _claims(echo, drawn, rays).items()}
    rows = [{"kind": kind, "rays": of, **covered(*found)} for (kind, of), found in claims.items()]
    return {"left_out": {kind: number for kind, number in left_out.items() if number > 0},
            "wanted": WANTED, "wanted_of_one": WANTED_OF_ONE, "rows": rows, "classes": _by_class(claims)}


def _claims(echo: Echo, drawn: list, rays: tuple) -> dict:
    """{rays: (what runs claim, the truth), both by seed}"""
    return {count: ([_claim(echo, scene, num_rays=count, seed=seed) for seed, scene, _ in drawn],
                    [truth for _, _, truth in drawn]) for count in rays}


def _drawn(echo: Echo, num_seeds: int, quick: bool) -> list:
    """(seed, scene, power in W) of as many scenes. One that differs from seed to seed counts where its truth is known."""
    if echo.differs:
        return _known(echo, num_seeds, QUICK_TRUE_RAYS if quick else TRUE_RAYS_OF_EACH, np.inf if quick else TRUE_DB)
    scenes = [(seed, *echo.draw(seed)) for seed in range(FIRST_SEED, FIRST_SEED + num_seeds)]
    if scenes[0][2] is not None:
        return scenes
    truth = power_of(echo, scenes[0][1], num_rays=QUICK_TRUE_RAYS if quick else TRUE_RAYS)[0].power
    return [(seed, scene, truth) for seed, scene, _ in scenes]


def _known(echo: Echo, num_scenes: int, num_rays: int, most_db: float) -> list:
    """(seed, scene, power in W) of the first scenes whose power so many rays know to `most_db`.

    Where launch cells become narrower than facets, more rays may know the body that a mesh stands for less well: a fifth of
    such traces of lofted cars claim no better than .9 dB, and are no truth. What is left out is judged by the interval of these
    traces, so that the coverage is that of scenes which many rays resolve.
    """
    found = []
    for seed in range(FIRST_SEED, FIRST_SEED + MOST_DRAWN * num_scenes):
        scene, _ = echo.draw(seed)
        truth, half_db = power_of(echo, scene, num_rays=num_rays)
        if half_db <= most_db:
            found.append((seed, scene, truth.power))
        if len(found) == num_scenes:
            return found
    raise ValueError(f"{echo.kind}: the power of {len(found)} scenes only is known to {most_db} dB, wanted {num_scenes}")


def _by_class(claims: dict) -> list[dict]:
    """Rows over all bodies and numbers of rays of a class: what the promise of the intervals is about."""
    together = {}
    for (kind, _), (found, truths) in claims.items():
        all_found, all_truths = together.setdefault(class_of(kind), ([], []))
        all_found += found
        all_truths += truths
    num_counts = len({count for _, count in claims})
    return [{"kind": name, **covered(found, truths, len(found) // num_counts)}
            for name, (found, truths) in together.items()]


def covered(found: list, truths: list, num_independent: int | None = None) -> dict:
    """Count of the powers, share of them whose interval holds the truth with its standard error, and how far they are from it,
    in dB.

    found: (Interval in W, half of it in dB) of each seed; truths: W; num_independent: how many of them are, None: all. Runs of
    one scene with more rays err alike.
    """
    holds = [one.low <= truth <= one.high for (one, _), truth in zip(found, truths)]
    ratios = [one.power / truth for (one, _), truth in zip(found, truths)]
    count = num_independent or len(holds)
    share = (count * np.mean(holds) + 2.0) / (count + 4.0)  # Agresti and Coull 1998: no error of zero where all hold
    return {"count": len(holds), "coverage": float(np.mean(holds)),
            "coverage_error": float(np.sqrt(share * (1.0 - share) / (count + 4.0))),
            "mean_error_db": float(10.0 * np.log10(max(np.mean(ratios), 1e-12))),
            "claimed_db": float(np.median([half for _, half in found])),
            "unresolved": int(sum(not one.resolved for one, _ in found))}


def _claim(echo: Echo, scene, **settings):
    """What a run with the echo's own batches and sampler claims, as `power_of`."""
    return power_of(echo, scene, batches=echo.batches, sampler=echo.sampler, **settings)


def power_of(echo: Echo, scene, **settings):
    """(Interval, half of it in dB). Where no path tells of the echo, the interval is that of surface which no ray has met."""
    paths = ep.trace(scene, targets.radar(), max_bounces=echo.max_bounces, **settings)
    found = ep.received_power(paths.select(echo.selection))
    if echo.objects and not found.high > 0.0:
        name = next(iter(echo.objects))
        return next(one.interval for one in ep.unresolved(paths, echo.objects) if one.name == name), float("inf")
    return interval_of(found), found.interval_db
