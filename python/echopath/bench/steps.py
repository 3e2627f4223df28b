"""What all benchmarks share: work in steps that are told, and results as text."""
from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, TypeVar

import numpy as np

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


def json_text(results: Mapping) -> str:
    """Results as JSON that every reader takes: it has no number for what is infinite or undefined, which is null there."""
    return json.dumps(_plain(results), indent=1, allow_nan=False) + "\n"


def _plain(value: Any) -> Any:
    """A value of Python or NumPy in the types that JSON has."""
    if isinstance(value, Mapping):
        return {name: _plain(one) for name, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(one) for one in value]
    number = value.item() if isinstance(value, np.generic) else value
    return None if isinstance(number, float) and not math.isfinite(number) else number
