"""What all benchmarks share: work in steps that are told, and tables as text."""
from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

Step = TypeVar("Step")


def told(steps: Sequence[Step], stage: str, progress: Callable | None) -> Iterator[Step]:
    """The steps one after the other; `progress(stage, fraction)`, or None, is told before each and at the end."""
    for index, step in enumerate(steps):
        if progress:
            progress(stage, index / len(steps))
        yield step
    if progress:
        progress(stage, 1.0)


def csv_text(rows: list[dict], columns: Sequence[str] | None = None) -> str:
    """A table with a head, a line for each row; columns: which of the keys, in this order, None: all of the first row."""
    stream = io.StringIO()
    writer = csv.DictWriter(stream, columns or list(rows[0]), restval="", extrasaction="ignore" if columns else "raise",
                            lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return stream.getvalue()
