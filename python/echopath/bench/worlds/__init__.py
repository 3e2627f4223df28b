"""`echopath bench worlds`: figures of large scenes beside what they must reach, in one run."""
from __future__ import annotations

from pathlib import Path

from ..suite import describe_parts, run_parts
from . import city, crowd, models, motion, moved, peer, public_cities

PARTS = {"crowd": crowd, "city": city, "public cities": public_cities, "models": models, "motion": motion, "moved": moved}


def run_worlds(folder, *, quick: bool = False, progress=None, cities=None, sionna: str | None = None, models=None) -> dict:
    """Measures every part, writes worlds.json into `folder` and returns what it holds.

    quick: small scenes, for a look; progress: callable (stage, fraction) or None
    cities: folder of scenes as Sionna RT ships them, None: those of the peer; sionna: a Python that has sionna-rt, None: this one
    models: folder of foreign files, None: none are read
    Raises ValueError, before anything is measured, for a folder that does not exist and for what is not a Python.
    """
    for option, given in (("--cities", cities), ("--models", models)):
        if given is not None and not Path(given).is_dir():
            raise ValueError(f"{option}: must be a folder that exists, got {given}")
    peer.require_python(sionna, "--sionna")
    options = {"public cities": {"scenes": cities, "python": sionna}, "models": {"folder": models}}
    return run_parts("worlds", PARTS, folder, quick=quick, progress=progress, options=options)


def describe(results: dict) -> list[str]:
    """Lines for people."""
    return describe_parts(PARTS, results)
