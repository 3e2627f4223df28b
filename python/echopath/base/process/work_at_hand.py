"""Which of several frames a thread is working on, for who tells people of its warnings."""
from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

_AT_HAND: ContextVar[str] = ContextVar("work at hand", default="")


def work_at_hand() -> str:
    """What the calling thread is working on, in words; "": nobody said."""
    return _AT_HAND.get()


@contextmanager
def at_work_on(what: str) -> Iterator[None]:
    """Within the block the calling thread works on what these words say."""
    before = _AT_HAND.set(what)
    try:
        yield
    finally:
        _AT_HAND.reset(before)
