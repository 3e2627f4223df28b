"""What tests of the model share."""
from __future__ import annotations

import pytest

from echopath_viewer.model import Session, from_frame


@pytest.fixture
def session(frame):
    """Of the small frame, with everything shown."""
    return Session(from_frame(frame))
