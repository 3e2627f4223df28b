"""Benchmarks that consist of parts, each with rows of figures beside what they must reach."""
from __future__ import annotations

import json
import re
from collections.abc import Mapping
from pathlib import Path
from types import ModuleType

from ..base.files import write_texts
from .machine import machine
from .pace import REFERENCE, pace_of_machine
from .steps import told

SECONDS = re.compile(r", (s|ms|us|ns)\b")  # what a figure in seconds is called ends so, or goes on with what it is for


def run_parts(name: str, parts: Mapping[str, ModuleType], folder, *, quick: bool, progress) -> dict:
    """Measures every part, writes `name`.json into `folder` and returns what it holds.

    parts: modules with rows(quick=) and describe(rows); quick: small, for a look
    progress: callable (stage, fraction) or None
    """
    found, paces, before = {}, {}, pace_of_machine()
    for part in told(list(parts), name, progress):
        rows, after = parts[part].rows(quick=quick), pace_of_machine()
        paces[part] = None if before is None else min(before, after)  # of its hour, the quicker end
        found[part], before = at_reference_pace(rows, paces[part]), after
    results = {"machine": machine(), "pace": paces, "quick": quick, "rows": found}
    write_texts(Path(folder), {f"{name}.json": json.dumps(results, indent=1) + "\n"})
    return results


def judged(found: Mapping[str, float], limits: Mapping[str, float]) -> list[dict]:
    """Rows of figures by name: what, measured, limit and whether it holds; None where there is no limit."""
    return [judged_row(what, value, limits.get(what)) for what, value in found.items()]


def judged_row(what: str, measured: float, limit: float | None) -> dict:
    """One row of `judged`."""
    return {"what": what, "measured": measured, "limit": limit, "holds": None if limit is None else bool(measured <= limit)}


def at_reference_pace(rows: list[dict], pace: float | None) -> list[dict]:
    """Rows with the pace of the machine, over which limits in seconds are held; None: as they are."""
    return rows if pace is None else [_at_reference_pace(row | {"pace": pace}) for row in rows]


def _at_reference_pace(row: dict) -> dict:
    return row | {"holds": bool(row["measured"] / row["pace"] <= row["limit"])} if _is_timed(row) else row


def _is_timed(row: dict) -> bool:
    return "pace" in row and row.get("limit") is not None and SECONDS.search(row.get("what", "")) is not None


def describe_judged(rows: list[dict], title: str = "", *, width: int = 44, measured: str = "12.4g", limit: str = "10.3g"
                    ) -> list[str]:
    """A line for each row of `judged`: what, the figure, its limit, and whether it holds.

    title: of the first column; width: of that column; measured, limit: how the numbers of the others are written
    """
    lines = [f"{title:<{width}}{'measured':>{measured.partition('.')[0]}}{'limit':>{limit.partition('.')[0]}}"]
    for row in rows:
        verdict = "" if row["limit"] is None else f"{row['limit']:{limit}}  {'holds' if row['holds'] else 'MISSED'}"
        there = f", {row['measured'] / row['pace']:.3g} at the reference's pace" if _is_timed(row) else ""
        lines.append(f"{row['what']:<{width}}{row['measured']:{measured}}{verdict}{there}")
    return lines


def describe_parts(parts: Mapping[str, ModuleType], results: dict) -> list[str]:
    """Lines for people."""
    lines = [f"{results['machine']['processor']}, {results['machine']['threads']} threads"]
    for name, part in parts.items():
        lines += ["", *part.describe(results["rows"][name]), *_pace_line(results.get("pace", {}).get(name))]
    return lines


def _pace_line(pace: float | None) -> list[str]:
    return [] if pace is None else [f"pace: {pace:.2f} times as long as {REFERENCE}, for which limits in seconds are stated, "
                                    "by FINUFFT's time before and after"]
