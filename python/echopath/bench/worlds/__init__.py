"""`echopath bench worlds`: figures of large scenes beside what they must reach, in one run."""
from __future__ import annotations

from ..suite import describe_parts, run_parts
from . import city, crowd, models, motion, moved, public_cities

PARTS = {"crowd": crowd, "city": city, "public cities": public_cities, "models": models, "motion": motion, "moved": moved}


def run_worlds(folder, *, quick: bool = False, progress=None, cities=None, sionna: str | None = None, models=None) -> dict:
    """Measures every part, writes worlds.json into `folder` and returns what it holds.

    quick: small scenes, for a look; progress: callable (stage, fraction) or None
    cities: folder of scenes as Sionna RT ships them, None: those of the peer; sionna: a Python that has sionna-rt, None: this one
    models: folder of foreign files, None: none are read
    """
    options = {"public cities": {"scenes": cities, "python": sionna}, "models": {"folder": models}}
    return run_parts("worlds", PARTS, folder, quick=quick, progress=progress, options=options)


def describe(results: dict) -> list[str]:
    """Lines for people."""
    return describe_parts(PARTS, results)
