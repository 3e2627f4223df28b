"""What tests of scenes that change share."""
from __future__ import annotations

import pytest

from support.street import street_table


@pytest.fixture
def table():
    """{name: keywords of Scene.add} of a street of twenty objects."""
    return street_table()
