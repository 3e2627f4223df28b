"""Benchmarks that consist of parts, each with rows of figures beside what they must reach."""
from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType

from ..base.files import write_texts
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


def judged(found: Mapping[str, float], limits: Mapping[str, float]) -> list[dict]:
    """Rows of figures by name: what, measured, limit and whether it holds; None where there is no limit."""
    return [judged_row(what, value, limits.get(what)) for what, value in found.items()]


def judged_row(what: str, measured: float, limit: float | None) -> dict:
    """One row of `judged`."""
    return {"what": what, "measured": measured, "limit": limit, "holds": None if limit is None else bool(measured <= limit)}


def describe_judged(rows: list[dict], title: str = "", *, width: int = 44, measured: str = "12.4g", limit: str = "10.3g"
                    ) -> list[str]:
    """A line for each row of `judged`: what, the figure, its limit, and whether it holds.

    title: of the first column; width: of that column; measured, limit: how the numbers of the others are written
    """
    lines = [f"{title:<{width}}{'measured':>{measured.partition('.')[0]}}{'limit':>{limit.partition('.')[0]}}"]
    for row in rows:
        verdict = "" if row["limit"] is None else f"{row['limit']:{limit}}  {'holds' if row['holds'] else 'MISSED'}"
        lines.append(f"{row['what']:<{width}}{row['measured']:{measured}}{verdict}")
    return lines


def describe_parts(parts: Mapping[str, ModuleType], results: dict) -> list[str]:
    """Lines for people."""
    lines = [f"{results['machine']['processor']}, {results['machine']['threads']} threads"]
    for name, part in parts.items():
        lines += ["", *part.describe(results["rows"][name])]
    return lines
