"""Objects whose __init__ has not run yet hold nothing: whatever asks them for a value gets an error, and nothing is read."""
import inspect

import pytest

import echopath as ep
from echopath import _core

CLASSES = {name: made for name, made in vars(_core).items() if inspect.isclass(made) and not issubclass(made, BaseException)}


@pytest.mark.parametrize("name", CLASSES)
def test_objects_that_are_not_made_have_no_values(name):
    unmade = CLASSES[name].__new__(CLASSES[name])
    properties = [each for each, value in inspect.getmembers(CLASSES[name]) if isinstance(value, property)]
    for each in properties:
        with pytest.raises(TypeError):
            getattr(unmade, each)


def test_a_class_that_reads_itself_before_it_is_made_is_told_so():
    class Corner(ep.Antenna):
        def __init__(self):
            repr(self)  # as a debugger shows it
            super().__init__((0.1, 0, 0))

    with pytest.raises(TypeError, match="the object is not made yet: its __init__ has not been called"):
        Corner()


def test_calls_refuse_objects_that_are_not_made():
    with pytest.raises(TypeError, match="not made yet"):
        ep.Mesh.__new__(ep.Mesh) == ep.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])


def test_a_mesh_that_is_none_is_refused():
    with pytest.raises(TypeError, match="tessellation"):
        _core.tessellation(None)
