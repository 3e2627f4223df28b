"""`echopath bench worlds`: figures of large scenes beside what they must reach, in one run."""
from __future__ import annotations

from ..suite import describe_parts, run_parts
from . import city, crowd, motion, moved

PARTS = {"crowd": crowd, "city": city, "motion": motion, "moved": moved}


def run_worlds(folder, *, quick: bool = False, progress=None) -> dict:
    """Measures every part, writes worlds.json into `folder` and returns what it holds.

    quick: small scenes, for a look; progress: callable (stage, fraction) or None
    """
    return run_parts("worlds", PARTS, folder, quick=quick, progress=progress)


def describe(results: dict) -> list[str]:
    """Lines for people."""
    return describe_parts(PARTS, results)
