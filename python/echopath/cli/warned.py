"""Warnings of a command as lines for people, without the places in the code that those who script want."""
from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager

from ..base.work_at_hand import work_at_hand


@contextmanager
def warnings_in_lines() -> Iterator[None]:
    """Within the block warnings are lines on standard error, once for each text: with the frame in which it came first."""
    said: set[str] = set()  # Python forgets what it has shown whenever some code filters warnings

    def show(message, category, filename, lineno, file=None, line=None) -> None:
        if str(message) not in said:
            said.add(str(message))
            _print(str(message))

    with warnings.catch_warnings():
        warnings.showwarning = show
        yield


def _print(message: str) -> None:
    where = f"first in {work_at_hand()}: " if work_at_hand() else ""
    text = f"warning: {where}{message}"
    if sys.stderr.isatty():
        from tqdm import tqdm

        tqdm.write(text, file=sys.stderr)  # above a progress bar
    else:
        print(text, file=sys.stderr, flush=True)
