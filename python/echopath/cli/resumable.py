"""Commands that go on where they were stopped."""
from __future__ import annotations

import sys
from collections.abc import Iterable


class Unread(BrokenPipeError):
    """Nobody reads the lines of a command any more, as behind `| head`, before its work is done."""


def print_resumable(lines: Iterable[str], folder) -> None:
    """Prints each line as soon as it is made; after Ctrl-C says that the same command goes on in `folder`.

    It is said here and not by what makes the lines, which hears nothing of a Ctrl-C that comes while a line is printed.
    Raises Unread, which says the same, where nobody reads the lines: what makes them stops there.
    """
    try:
        for line in lines:
            _print(line, folder)
    except KeyboardInterrupt:
        print(f"\nthe same command goes on in {folder}", file=sys.stderr)
        raise


def _print(line: str, folder) -> None:
    try:
        print(line, flush=True)
    except BrokenPipeError:
        raise Unread(f"stopped, as nobody reads its output any more; the same command goes on in {folder}") from None
