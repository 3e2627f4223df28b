"""Warnings of a command as lines for people, without the places in the code that those who script want."""
from __future__ import annotations

import re
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from ..base.process.callers import warn_user
from ..base.process.work_at_hand import work_at_hand
from ..base.text.counts import counted

_QUOTED = re.compile(r"('[^']*')")
_NUMBER = re.compile(r"\d[\d.,]*(?:e[-+]?\d+)?")
_FIRST_WORDS = 80  # characters


@contextmanager
def warnings_in_lines() -> Iterator[None]:
    """Within the block warnings are lines on standard error, once for each text: with the frame in which it came first.

    Texts that differ in numbers alone, but for those in names, are one: how many more came is told at the end.
    """
    said: dict[str, list[str]] = {}  # Python forgets what it has shown whenever some code filters warnings

    def show(message, category, filename, lineno, file=None, line=None) -> None:
        text = str(message)
        alike = said.setdefault(_without_numbers(text), [])
        if text not in alike:
            alike.append(text)
            if len(alike) == 1:
                _print(text)

    with warnings.catch_warnings():
        warnings.showwarning = show
        try:
            yield
        finally:
            for first, *others in said.values():
                if others:
                    _print(f"{counted(len(others), 'more warning')} with other numbers, of: {_shortened(first)}", is_late=True)


@contextmanager
def pictures_warned(told: str) -> Iterator[None]:
    """What keeps pictures in the block from being made is a warning, `told` and the reason: the results are there anyway."""
    try:
        yield
    except Exception as error:  # of drawing, of memory or of the disk
        warn_user(f"{told}: {str(error) or type(error).__name__}")


def _without_numbers(text: str) -> str:
    """The text with all numbers alike that are not in quotes."""
    parts = _QUOTED.split(text)
    return "".join(part if part.startswith("'") else _NUMBER.sub("0", part) for part in parts)


def _shortened(text: str) -> str:
    return text if len(text) <= _FIRST_WORDS else text[:_FIRST_WORDS].rsplit(" ", 1)[0] + " ..."


def _print(message: str, is_late: bool = False) -> None:
    where = f"first in {work_at_hand()}: " if work_at_hand() and not is_late else ""
    text = f"warning: {where}{message}"
    if sys.stderr.isatty():
        from tqdm import tqdm

        tqdm.write(text, file=sys.stderr)  # above a progress bar
    else:
        with suppress(BrokenPipeError):  # that nobody reads its warnings is no reason to end a run
            print(text, file=sys.stderr, flush=True)
