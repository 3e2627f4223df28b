"""`echopath bench receiver`: faults of a receiver beside their closed forms, codes beside turns, and what they cost in a street.

Levels are those of a tone, laws those of shifts, gains and extents in time; the cost is processor time of `ep.receive`,
`ep.demultiplex` or `ep.interference` for the cube of a street of some twenty objects.
"""
from __future__ import annotations

from ..suite import describe_parts, run_parts
from . import codes, cost, faults, laws, off

PARTS = {"faults": faults, "laws": laws, "codes": codes, "off": off, "cost": cost}


def run_receiver(folder, *, quick: bool = False, progress=None) -> dict:
    """Measures every part and writes receiver.json into `folder`; returns what it holds.

    quick: small, for a look; progress: callable (stage, fraction) or None
    """
    return run_parts("receiver", PARTS, folder, quick=quick, progress=progress)


def describe(results: dict) -> list[str]:
    """Lines for people."""
    return describe_parts(PARTS, results)
