"""Every public name says what it is, names each parameter, and gives shapes and units where there are quantities."""
from __future__ import annotations

import dataclasses
import functools
import inspect
import re

import pytest

import echopath as ep
from echopath import dataset

# Parameters that are objects, names or counts: they have neither a unit nor a shape.
NO_QUANTITY = {
    "actor", "args", "arguments", "batches", "block", "clothing", "color_by", "dataset", "evaluate", "exponent", "folder",
    "footprint", "frame", "function", "glob", "interpolation", "keep", "keyframes", "keywords", "kwargs", "material", "max",
    "max_bounces",
    "ax", "figure", "labels", "map", "mesh", "mesh_or_actor", "method", "min", "mirror", "modelled", "motion", "multiplexing",
    "name", "noise_seed", "note", "number",
    "num_batches", "num_rays", "num_slots", "num_threads", "parent", "parts", "path", "paths", "pattern", "picture",
    "preview",
    "progress", "radar", "reason", "receivers", "replay", "retrace", "scale", "scene", "seed", "selection", "selections", "shard",
    "show", "skin", "smooth", "source", "spectrum", "state", "subdivisions", "tags", "text", "title", "trace",
    "transmitters", "unknown", "visible", "waveform", "what", "window", "zero_pad",
}
UNITS = r"(m|s|Hz|W|K|rad|sr|dB|dBm|m/s|rad/s|m/s\^2|Hz/s|S/m|1/s|m\^2|J/K|sqrt\(W\)|degrees|cycles|[Ll]inear|metres)"
QUANTITY = re.compile(rf"\[[\w, *]+\]|(?<![\w/]){UNITS}(?![\w/])")
SIGNATURE = re.compile(r"^(?:\d+\. )?\w+\((.*)\)(?: -> .*)?$", re.MULTILINE)


def public_names() -> dict:
    """{dotted name: object} of the package, of its actors, of datasets and of pictures."""
    names = {name: getattr(ep, name) for name in ep.__all__}
    names |= {f"{module.__name__.removeprefix('echopath.')}.{name}": getattr(module, name)
              for module in (dataset, ep.plots) for name in module.__all__}
    names |= {f"actors.{name}": getattr(ep.actors, name) for name in dir(ep.actors)
              if not name.startswith("_") and inspect.isfunction(getattr(ep.actors, name))}
    return {name: value for name, value in names.items() if not inspect.ismodule(value) and not isinstance(value, float)}


def members(name: str, value) -> dict:
    """Methods and properties of a class, inherited ones left out; a property may tell of the parameter of its name."""
    if not inspect.isclass(value):
        return {}
    fields = {field.name for field in dataclasses.fields(value)} if dataclasses.is_dataclass(value) else set()
    return {f"{name}.{key}": member for key, member in vars(value).items() if not key.startswith("_") and key not in fields}


def docstring(value) -> str:
    """Without the signature lines that pybind11 puts first."""
    value = value.__func__ if isinstance(value, (staticmethod, classmethod)) else value
    text = value.func.__doc__ if isinstance(value, functools.cached_property) else value.__doc__
    text = re.sub(SIGNATURE, "", inspect.cleandoc(text or "")).replace("Overloaded function.", "")
    return "" if text.startswith(("(self:", "(arg0:")) else text.strip()


def parameters(value) -> list:
    """Names of the parameters of a function, a method or a constructor, of the core too."""
    value = value.__func__ if isinstance(value, (staticmethod, classmethod)) else value
    if dataclasses.is_dataclass(value):
        return [field.name for field in dataclasses.fields(value)]
    constructor = inspect.isclass(value) and vars(value).get("__init__")
    target = constructor or value
    if not callable(target) or inspect.isclass(target):
        return []
    if inspect.isfunction(target):
        found = list(inspect.signature(target).parameters)
    else:  # of the core: "name(self: Type, first: Type = value, ...) -> Type"
        found = [name for line in SIGNATURE.findall(target.__doc__ or "")
                 for name in re.findall(r"(?:^|, )\*{0,2}(\w+)(?=: |$|,)", line)]
    return [name for name in dict.fromkeys(found) if name not in ("self", "kwargs", "args", "unknown")]


PUBLIC = {}
for _name, _value in public_names().items():
    PUBLIC |= {_name: _value} | members(_name, _value)


def complaints(name: str) -> list[str]:
    """What the docstring of a public name lacks: each parameter by its name, and a shape or unit where one is a quantity."""
    names = parameters(PUBLIC[name])
    text = "\n".join([docstring(PUBLIC[name]), *(f"{key.split('.')[-1]}: {docstring(member)}"
                                                 for key, member in members(name, PUBLIC[name]).items())])
    found = [f"{name}: the docstring does not tell of {one}" for one in names if not re.search(rf"\b{one}\b", text)]
    quantities = sorted(one for one in set(names) - NO_QUANTITY if not one.startswith("num_"))
    if quantities and not QUANTITY.search(text):
        found.append(f"{name}: neither a shape nor a unit for {quantities}")
    return found


def test_public_names_have_a_docstring():
    assert [name for name, value in PUBLIC.items() if len(docstring(value)) < 2] == []


def test_docstrings_name_each_parameter_and_give_shapes_and_units():
    assert len(PUBLIC) > 100
    assert [complaint for name in PUBLIC for complaint in complaints(name)] == []


def test_quantities_are_recognised():
    for text in ("[V, 3]", "position: [3] in m", "power in W", "in sqrt(W)", "1/s, at least 60"):
        assert QUANTITY.search(text), text
    for text in ("a copy of it", "many meshes", "T . R", "the worst case"):
        assert not QUANTITY.search(text), text


# They judge or follow what another function has checked already.
RAISES_NOTHING = {"check_rays", "check_signal", "effects"}


def silent_functions() -> list[str]:
    """Public functions and methods with parameters whose docstrings do not tell what they raise."""
    functions = [name for name, value in PUBLIC.items() if callable(value) and not inspect.isclass(value)]
    return [name for name in functions if parameters(PUBLIC[name]) and "raises" not in docstring(PUBLIC[name]).lower()]


def test_functions_say_what_they_raise():
    assert set(silent_functions()) <= RAISES_NOTHING


@pytest.mark.parametrize("call, error", [
    (lambda: ep.actors.plate(-1, 1), ValueError), (lambda: ep.actors.box(1, edgy=1), TypeError),
    (lambda: ep.hits(""), ValueError), (lambda: ep.Isotropic(-1), ValueError), (lambda: ep.CosinePower(-1), ValueError)])
def test_what_docstrings_say_is_raised(call, error):
    with pytest.raises(error):
        call()
