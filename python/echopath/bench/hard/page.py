"""The page of the hard cases, in Markdown."""
from __future__ import annotations

HEAD = """# Hard cases

What is known to break a ray tracer or a coherent sum, what must hold there, and what `echopath bench hard` measured
({machine}).
The last column says how each case was seen to fail: what was taken out of the program, and the value that came out.
{count} cases, {holding} hold.
"""
COLUMNS = "| case | expected | bound | measured | verdict | seen to fail |\n|---|---|---|---|---|---|"


def page(results: list, machine: str) -> str:
    """The page as text; results: of the cases, in order; machine: where they were measured."""
    parts = [HEAD.format(machine=machine, count=len(results), holding=sum(one.holds for one in results))]
    for group in dict.fromkeys(one.case.group for one in results):
        rows = [row(one) for one in results if one.case.group == group]
        parts.append("\n".join([f"## {group}", COLUMNS, *rows, ""]))
    return "\n".join(parts)


def row(result) -> str:
    """One case as a row of the table, no cell empty."""
    case = result.case
    measured = result.error or f"{result.value:.5g} {case.unit}".rstrip()
    verdict = "holds" if result.holds else "**fails**"
    return "| " + " | ".join(map(_cell, (case.name, case.expected, case.bound_text, measured, verdict, case.broken))) + " |"


def _cell(text: str) -> str:
    return " ".join(text.split()).replace("|", "\\|")
