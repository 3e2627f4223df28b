"""What tests of actors share."""
import pytest

from support.scenes.pedestrians import HEIGHT, SPEED, Person


@pytest.fixture(scope="module")
def person():
    return Person(HEIGHT, SPEED)
