"""Commands that go on where they were stopped."""
from __future__ import annotations

import sys
from collections.abc import Iterable


def print_resumable(lines: Iterable[str], folder) -> None:
    """Prints each line as soon as it is made; after Ctrl-C says that the same command goes on in `folder`.

    It is said here and not by what makes the lines, which hears nothing of a Ctrl-C that comes while a line is printed.
    """
    try:
        for line in lines:
            print(line, flush=True)
    except KeyboardInterrupt:
        print(f"\nthe same command goes on in {folder}", file=sys.stderr)
        raise
