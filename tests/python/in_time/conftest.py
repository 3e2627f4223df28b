"""What tests of live scenes share."""
import pytest

import echopath as ep
from support.live import make_live


@pytest.fixture
def live() -> ep.Live:
    made = make_live()
    made.update()
    return made


@pytest.fixture(scope="session")
def live_at_rest() -> ep.Live:
    """The same for tests that leave it as it is."""
    made = make_live()
    made.update()
    return made
