"""Measurements in processes of their own: what comes back, and what is said of it."""
import os
import warnings
from concurrent.futures.process import BrokenProcessPool

import pytest

from echopath.bench.alone import alone


def noisy(times: int) -> int:
    """The process that it runs in; it warns more often than it has something to say."""
    for _ in range(times):
        warnings.warn("at least 3 objects have no rays of their own", RuntimeWarning, stacklevel=1)
    return os.getpid()


def test_warnings_of_a_process_are_those_of_the_run_once_each():
    with pytest.warns(RuntimeWarning, match="3 objects") as told:
        found = alone(noisy, 5)
    assert found != os.getpid()
    assert [one.filename for one in told] == [__file__]


def test_a_process_that_ends_before_it_returns_is_an_error():
    with pytest.raises(BrokenProcessPool):
        alone(os._exit, 3)
