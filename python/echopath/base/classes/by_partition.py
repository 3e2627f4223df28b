"""Tables by partition, which say what they have where they are asked for what they lack."""
from __future__ import annotations

from typing import NoReturn, TypeVar

Value = TypeVar("Value")


class ByPartition(dict[str, Value]):
    """{partition: value} of a frame; a name that it lacks raises KeyError, which says what there is or how to have some."""

    def __missing__(self, name: object) -> NoReturn:
        there = f"there are {', '.join(self)}" if self else ("the frame has none of these: simulate(parts=) makes signals "
                                                             "of parts, simulate(labels=True) labels")
        raise KeyError(f"no partition '{name}'; {there}")
