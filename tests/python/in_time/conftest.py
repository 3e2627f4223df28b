"""What tests of live scenes share."""
import pytest

import echopath as ep
from support.live import make_live


@pytest.fixture
def live() -> ep.Live:
    made = make_live()
    made.update()
    return made
