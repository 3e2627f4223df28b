"""Numbers on the command line: what argparse takes as type=."""
from __future__ import annotations

import argparse

from ..checks import LARGEST_COUNT


def positive(text: str) -> int:
    """A number of rays; 2e6 and 2_000_000 will do too."""
    return _whole_number(text, 1)


def natural(text: str) -> int:
    """A seed."""
    return _whole_number(text, 0)


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


def _whole_number(text: str, least: int) -> int:
    try:
        value = float(text)
        if value >= least and value == int(value):
            return int(value)
    except (ValueError, OverflowError):
        pass
    raise argparse.ArgumentTypeError(f"must be a whole number of at least {least}, got '{text}'")
