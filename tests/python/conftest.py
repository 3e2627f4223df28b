"""Fixtures of several tests."""
import signal

import pytest

import echopath as ep
from support.labelled import trace_plates_and_wall


@pytest.fixture
def ctrl_c_is_heard():
    """Python's usual handler of Ctrl-C, which a process started in the background does not have."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture(scope="session")
def plates_and_wall():
    """(paths, selections, {part: (range, velocity)} by closed form) of two plates beside a mirror wall."""
    return trace_plates_and_wall()


@pytest.fixture(scope="session")
def labels(plates_and_wall):
    """Labels of `plates_and_wall` on a map whose cells are half as wide."""
    paths, parts, _ = plates_and_wall
    return ep.annotate(paths, parts, window="blackman_harris", zero_pad=2, dynamic_range_db=80.0)
