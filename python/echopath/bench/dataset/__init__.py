"""`echopath bench dataset`: frames of datasets by second and core, what each stage takes of them, and growth with workers.

All times are processor time, so that what else runs on the machine counts little; one thread.
"""
from __future__ import annotations

from ..suite import describe_parts, run_parts
from . import frames, workers

PARTS = {"workers": workers, "frames": frames}  # the peak memory of a process counts what its parent had when it began


def run_dataset(folder, *, quick: bool = False, progress=None) -> dict:
    """Measures every part and writes dataset.json into `folder`; returns what it holds.

    quick: few scenes, for a look; progress: callable (stage, fraction) or None
    """
    return run_parts("dataset", PARTS, folder, quick=quick, progress=progress)


def describe(results: dict) -> list[str]:
    """Lines for people."""
    return describe_parts(PARTS, results)
