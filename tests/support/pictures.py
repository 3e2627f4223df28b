"""Pictures of tests that look at all else."""
from __future__ import annotations

from contextlib import contextmanager

import pytest


@contextmanager
def plain():
    """Pictures are drawn where their axes stand at first, which laying them out would take twice as long as; tests of pictures
    themselves look at their layout."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("echopath.plots.style._settled", _as_it_stands)
        yield


@contextmanager
def _as_it_stands(figure):
    figure.set_layout_engine("none")
    yield
