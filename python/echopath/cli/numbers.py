"""Numbers on the command line: what argparse takes as type=."""
from __future__ import annotations

import argparse


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


def _whole_number(text: str, least: int) -> int:
    try:
        value = float(text)
        if value >= least and value == int(value):
            return int(value)
    except (ValueError, OverflowError):
        pass
    raise argparse.ArgumentTypeError(f"must be a whole number of at least {least}, got '{text}'")
