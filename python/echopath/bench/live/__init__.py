"""`echopath bench live`: figures of scenes that change and go on in time beside what they must reach, in one run."""
from __future__ import annotations

import json
from pathlib import Path

from ...files import write_texts
from ..machine import machine
from ..steps import told
from . import drive, edits

PARTS = {"edits": edits, "drive": drive}


def run_live(folder, *, quick: bool = False, progress=None) -> dict:
    """Measures every part, writes live.json into `folder` and returns what it holds.

    quick: small scenes and few frames, for a look; progress: callable (stage, fraction) or None
    """
    found = {name: PARTS[name].rows(quick=quick) for name in told(list(PARTS), "live", progress)}
    results = {"machine": machine(), "quick": quick, "rows": found}
    write_texts(Path(folder), {"live.json": json.dumps(results, indent=1) + "\n"})
    return results


def describe(results: dict) -> list[str]:
    """Lines for people."""
    lines = [f"{results['machine']['processor']}, {results['machine']['threads']} threads"]
    for name, part in PARTS.items():
        lines += ["", *part.describe(results["rows"][name])]
    return lines
