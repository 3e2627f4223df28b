"""Benchmarks that consist of parts, each with rows of figures beside what they must reach."""
from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType, ModuleType

from ..base.storage.files import write_texts
from .machine import machine
from .pace import REFERENCE_MACHINE, pace, told_at_reference, verdict
from .steps import json_text, told

SECONDS = re.compile(r", (s|ms|us|ns)\b")  # names of figures in seconds end so, or go on with what the seconds are for


def run_parts(name: str, parts: Mapping[str, ModuleType], folder, *, quick: bool, progress,
              options: Mapping[str, Mapping] = MappingProxyType({})) -> dict:
    """Measures every part, writes `name`.json into `folder` and returns what it holds.

    Limits of rows that are "timed" are those of the reference machine: such rows get "paces", of this machine before and
    after their part, and are judged again. Quick runs are not.

    parts: modules with rows(quick=) and describe(rows); quick: small, for a look
    progress: callable (stage, fraction) or None; options: further keywords of rows, by the names of their parts
    """
    found = {}
    before = None if quick else pace()
    for part in told(list(parts), name, progress):
        rows = parts[part].rows(quick=quick, **options.get(part, {}))
        after = None if quick else pace()
        found[part] = rows if before is None or after is None else at_reference(rows, sorted((before, after)))
        before = after
    results = {"machine": machine(), "quick": quick, "rows": found}
    write_texts(Path(folder), {f"{name}.json": json_text(results)})
    return results


def judged(found: Mapping[str, float], limits: Mapping[str, float]) -> list[dict]:
    """Rows of figures by name: what, measured, limit and whether it holds; None where there is no limit."""
    return [judged_row(what, value, limits.get(what)) for what, value in found.items()]


def judged_row(what: str, measured: float, limit: float | None) -> dict:
    """One row of `judged`; it is "timed" where its name ends with a unit of seconds and it has a limit."""
    holds = None if limit is None else bool(measured <= limit)
    row = {"what": what, "measured": measured, "limit": limit, "holds": holds}
    return row | {"timed": True} if limit is not None and SECONDS.search(what) else row


def at_reference(rows: list[dict], paces: list[float]) -> list[dict]:
    """Rows of a machine of these paces, [least, most]: those that are timed have them, and what `judged` made is judged so."""
    return [_at_reference(row, paces) if row.get("timed") else row for row in rows]


def _at_reference(row: dict, paces: list[float]) -> dict:
    if "measured" not in row:
        return row | {"paces": paces}
    holds = {"holds": True, "MISSED": False, "undecided": None}[verdict(row["measured"], row["limit"], paces)]
    return row | {"paces": paces, "holds": holds}


def describe_judged(rows: list[dict], title: str = "", *, width: int = 44, measured: str = "12.4g", limit: str = "10.3g"
                    ) -> list[str]:
    """A line for each row of `judged`, below their titles: what, the figure, its limit, and whether it holds. None of no rows.

    title: of the first column; width: of that column; measured, limit: how the numbers of the others are written
    """
    if not rows:
        return []
    lines = [f"{title:<{width}}{'measured':>{measured.partition('.')[0]}}{'limit':>{limit.partition('.')[0]}}"]
    for row in rows:
        lines.append(f"{row['what']:<{width}}{row['measured']:{measured}}{_judgement(row, limit)}")
    return lines


def _judgement(row: dict, form: str) -> str:
    if row["limit"] is None:
        return ""
    said = {True: "holds", False: "MISSED", None: "undecided"}[row["holds"]]
    return f"{row['limit']:{form}}  {said}{told_at_reference(row['measured'], row.get('paces'))}"


def describe_parts(parts: Mapping[str, ModuleType], results: dict) -> list[str]:
    """Lines for people."""
    lines = [f"{results['machine']['processor']}, {results['machine']['threads']} threads"]
    for name, part in parts.items():
        rows = results["rows"][name]
        lines += ["", *part.describe(rows), *_told_paces(rows)]
    return lines


def _told_paces(rows: list[dict]) -> list[str]:
    for row in rows:
        if "paces" in row:
            least, most = row["paces"]
            return [f"pace: FINUFFT takes {least:.2f} to {most:.2f} times as long as on {REFERENCE_MACHINE}, for which limits in "
                    "seconds are stated"]
    return []
