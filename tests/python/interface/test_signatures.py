"""Editors and help() show the parameters of whatever is public, with defaults that can be read."""
import inspect
import pydoc

import numpy as np
import pytest

import echopath as ep
from echopath import dataset

CLASSES = [name for name in ep.__all__ if inspect.isclass(getattr(ep, name)) and not issubclass(getattr(ep, name), Exception)]


def _methods(name: str) -> list[str]:
    """Public methods that a class defines itself."""
    return [method for method, value in vars(getattr(ep, name)).items()
            if not method.startswith("_") and callable(getattr(getattr(ep, name), method)) and not isinstance(value, type)]


CALLABLES = [*CLASSES, *(name for name in ep.__all__ if inspect.isroutine(getattr(ep, name))),
             *(f"{name}.{method}" for name in CLASSES for method in _methods(name))]


def _named(name: str):
    found = ep
    for word in name.split("."):
        found = getattr(found, word)
    return found


@pytest.mark.parametrize("name", CALLABLES)
def test_every_public_callable_has_a_signature(name):
    parameters = inspect.signature(_named(name)).parameters.values()
    for one in parameters:
        assert one.kind is not one.VAR_POSITIONAL, name
        assert one.kind is not one.VAR_KEYWORD or name.endswith(".replace"), name


@pytest.mark.parametrize("name", CALLABLES)
def test_what_takes_arguments_says_what_it_raises(name):
    called = _named(name)
    parameters = [one for one in inspect.signature(called).parameters if one not in ("self", "progress")]
    text = (called.__doc__ or "") + (inspect.getdoc(called.__init__) or "" if inspect.isclass(called) else "")
    # Records are made by the package, which fills them in; each reader of foreign files says what it raises.
    data = inspect.isclass(called) and (hasattr(called, "__dataclass_fields__") or issubclass(called, (tuple, dict)))
    data = data or name == "load_model"
    assert not parameters or "raises" in text.lower() or data, name


def test_signatures_of_the_extension_are_as_they_are_written():
    """Worked out by hand from the docstrings."""
    assert str(inspect.signature(ep.ChirpSequence)) == (
        "(*, start_frequency=77000000000.0, bandwidth=1000000000.0, num_samples=512, sampling_rate=20000000.0, "
        "num_chirps=128, chirp_interval=6e-05, real=False, extra_idle=(), frequency_steps=(), bandwidth_steps=())")
    assert list(inspect.signature(ep.Radar).parameters)[:3] == ["waveform", "transmitters", "receivers"]
    assert inspect.signature(ep.Antenna).parameters["polarization"].default == (0.0, 0.0, 1.0)
    assert str(inspect.signature(ep.CosinePower)) == "(exponent, peak_gain=None)"
    assert str(inspect.signature(ep.Paths.load)) == "(path)"
    assert str(inspect.signature(ep.Mesh.part)) == "(self, triangles)"
    assert str(inspect.signature(ep.Mesh(np.eye(3), [[0, 1, 2]]).part)) == "(triangles)"


def test_help_stays_readable():
    told = pydoc.render_doc(ep.Antenna, renderer=pydoc.plaintext)
    assert "position=(0.0, 0.0, 0.0)" in told and "One element of a radar." in told
    assert "\n--\n" not in told and ")--" not in told
    assert ep.Paths.select.__doc__.count("\n") > 3 and "The paths that a selection takes" in ep.Paths.select.__doc__


@pytest.mark.parametrize("module", [ep, dataset, ep.plots])
def test_signatures_name_types_as_they_are_written(module):
    """Python writes those of a NamedTuple as ForwardRef('float') where a module postpones its annotations."""
    classes = [value for value in map(vars(module).get, module.__all__) if inspect.isclass(value) and issubclass(value, tuple)]
    assert classes and not [one for one in classes if "ForwardRef" in str(inspect.signature(one))]


@pytest.mark.parametrize("name, maker", [("Paths", "ep.trace"), ("RangeDoppler", "ep.range_doppler"),
                                         ("Motion", "LinearMotion"), ("AntennaPattern", "ep.CosinePower")])
def test_classes_that_functions_make_say_which(name, maker):
    with pytest.raises(TypeError, match=f"^{name}: is made by .*{maker}"):
        getattr(ep, name)(1, what=2)
