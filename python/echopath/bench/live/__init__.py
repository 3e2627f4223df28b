"""`echopath bench live`: figures of scenes that change and go on in time beside what they must reach, in one run."""
from __future__ import annotations

from ..suite import describe_parts, run_parts
from . import drive, edits

PARTS = {"edits": edits, "drive": drive}


def run_live(folder, *, quick: bool = False, progress=None) -> dict:
    """Measures every part, writes live.json into `folder` and returns what it holds.

    quick: small scenes and few frames, for a look; progress: callable (stage, fraction) or None
    """
    return run_parts("live", PARTS, folder, quick=quick, progress=progress)


def describe(results: dict) -> list[str]:
    """Lines for people."""
    return describe_parts(PARTS, results)
