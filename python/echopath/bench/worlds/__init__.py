"""`echopath bench worlds`: figures of large scenes beside what they must reach, in one run."""
from __future__ import annotations

import json
from pathlib import Path

from ...files import write_texts
from ..machine import machine
from ..steps import told
from . import city, crowd, motion, moved

PARTS = {"crowd": crowd, "city": city, "motion": motion, "moved": moved}


def run_worlds(folder, *, quick: bool = False, progress=None) -> dict:
    """Measures every part, writes worlds.json into `folder` and returns what it holds.

    quick: small scenes, for a look; progress: callable (stage, fraction) or None
    """
    found = {name: PARTS[name].rows(quick=quick) for name in told(list(PARTS), "worlds", progress)}
    results = {"machine": machine(), "quick": quick, "rows": found}
    write_texts(Path(folder), {"worlds.json": json.dumps(results, indent=1) + "\n"})
    return results


def describe(results: dict) -> list[str]:
    """Lines for people."""
    lines = [f"{results['machine']['processor']}, {results['machine']['threads']} threads"]
    for name, part in PARTS.items():
        lines += ["", *part.describe(results["rows"][name])]
    return lines
