"""Fixtures of several tests."""
import signal

import pytest


@pytest.fixture
def ctrl_c_is_heard():
    """Python's usual handler of Ctrl-C, which a process started in the background does not have."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)
