"""Numbers and names on the command line: what argparse takes as type=."""
from __future__ import annotations

import argparse

from ..arguments.checks import LARGEST_COUNT


def positive(text: str) -> int:
    """A number of rays; 2e6 and 2_000_000 will do too."""
    return _whole_number(text, 1)


def natural(text: str) -> int:
    """A seed."""
    return _whole_number(text, 0)


def named(text: str) -> str:
    """A file or folder. An empty name, as of a variable of the shell that is not set, would be the folder in which one is."""
    if not text:
        raise argparse.ArgumentTypeError("must be the name of a file or folder, got ''")
    return text


def seconds(text: str) -> float:
    """An interval of time in s."""
    try:
        if 0.0 < float(text) < float("inf"):
            return float(text)
    except ValueError:
        pass
    raise argparse.ArgumentTypeError(f"must be a finite number above 0 s, got '{text}'")


def shard(text: str) -> tuple[int, int]:
    """The k-th of n shards: 1/4."""
    k, slash, n = text.partition("/")
    if slash and k.isdecimal() and n.isdecimal() and 1 <= int(k) <= int(n) <= LARGEST_COUNT:
        return int(k), int(n)
    raise argparse.ArgumentTypeError(f"must be K/N, the K-th of N shards, K from 1 to N, got '{text}'")


def number_range(text: str) -> tuple[int, int]:
    """Numbers from the first to the one before the end: 100:200."""
    first, colon, end = text.partition(":")
    if colon and first.isdecimal() and end.isdecimal() and int(first) < int(end) <= LARGEST_COUNT:
        return int(first), int(end)
    raise argparse.ArgumentTypeError(f"must be A:B, whole numbers with A below B, got '{text}'")


def _whole_number(text: str, least: int) -> int:
    try:
        value = int(text) if text.strip().replace("_", "").isdecimal() else float(text)  # not all whole numbers are floats
        if value >= least and value == int(value):
            return int(value)
    except (ValueError, OverflowError):
        pass
    raise argparse.ArgumentTypeError(f"must be a whole number of at least {least}, got '{text}'")


def duration_words(seconds: float) -> str:
    """In words that a person reads at a glance: 40 s, 12 min, 3 h 05 min."""
    if seconds < 99.5:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60.0)
    return f"{minutes} min" if minutes < 100 else f"{minutes // 60} h {minutes % 60:02d} min"
