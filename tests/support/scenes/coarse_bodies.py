"""Bodies of the benchmark of crowds for tests."""
from __future__ import annotations

import functools
from contextlib import contextmanager

import pytest

from echopath.bench.crowd import echoes


@contextmanager
def coarse_bodies():
    """Triangles of curved bodies are three times as wide, which changes echoes over two of them by .1 dB: making a fine mesh
    takes longer than tracing it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(echoes, "EDGE", 3.0 * echoes.EDGE)
        patch.setattr(echoes, "_body", functools.cache(echoes._body.__wrapped__))
        yield
