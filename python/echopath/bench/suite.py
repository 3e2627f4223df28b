"""Benchmarks that consist of parts, each with rows of figures beside what they must reach."""
from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType

from ..files import write_texts
from .machine import machine
from .steps import told


def run_parts(name: str, parts: Mapping[str, ModuleType], folder, *, quick: bool, progress) -> dict:
    """Measures every part, writes `name`.json into `folder` and returns what it holds.

    parts: modules with rows(quick=) and describe(rows); quick: small, for a look
    progress: callable (stage, fraction) or None
    """
    found = {part: parts[part].rows(quick=quick) for part in told(list(parts), name, progress)}
    results = {"machine": machine(), "quick": quick, "rows": found}
    write_texts(Path(folder), {f"{name}.json": json.dumps(results, indent=1) + "\n"})
    return results


def describe_parts(parts: Mapping[str, ModuleType], results: dict) -> list[str]:
    """Lines for people."""
    lines = [f"{results['machine']['processor']}, {results['machine']['threads']} threads"]
    for name, part in parts.items():
        lines += ["", *part.describe(results["rows"][name])]
    return lines
