"""Settings objects are the home of the keywords of `simulate`: the same frame, the same checks, and no second list."""
import dataclasses
import inspect
import re

import numpy as np
import pytest

import echopath as ep

KINDS = [ep.TraceSettings, ep.SignalSettings, ep.LabelSettings]


def make_scene() -> ep.Scene:
    scene = ep.Scene()
    scene.add(ep.actors.plate(1.0, 1.0), name="plate", material="concrete", position=(6.0, 0.0, 0.0))
    return scene


def make_radar() -> ep.Radar:
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=0.5e9, num_samples=32, sampling_rate=10e6, num_chirps=8,
                                chirp_interval=50e-6)
    return ep.Radar(waveform, transmitters=[ep.Antenna()], receivers=[ep.Antenna()])


def test_settings_stand_for_keywords_and_keywords_go_before_them():
    scene, radar = make_scene(), make_radar()
    trace = ep.TraceSettings(num_rays=3e2, max_bounces=2, seed=5, start_time=0.25)
    signal = ep.SignalSettings(noise_seed=7, window="rect", zero_pad=2)
    frame = ep.simulate(scene, radar, trace=trace, signal=signal, labels=ep.LabelSettings(dynamic_range_db=20.0), seed=6)
    other = ep.simulate(scene, radar, num_rays=300, max_bounces=2, seed=6, start_time=0.25, noise_seed=7, window="rect",
                        zero_pad=2, labels={"dynamic_range_db": 20.0})
    assert frame.paths.frame.seed == 6 and frame.paths.frame.start_time == 0.25
    assert np.array_equal(frame.spectrum.values, other.spectrum.values) and frame.spectrum.window == "rect"
    assert frame.labels["parts"].dynamic_range_db == other.labels["parts"].dynamic_range_db == 20.0


@pytest.mark.parametrize("function, kind", [(ep.trace, ep.TraceSettings), (ep.synthesize, ep.SignalSettings)])
def test_functions_take_what_concerns_them(function, kind):
    scene, radar = make_scene(), make_radar()
    given = (scene, radar) if function is ep.trace else (ep.trace(scene, radar, num_rays=100),)
    changes = {"num_rays": 200} if function is ep.trace else {"tolerance": 1e-3, "method": "direct"}
    by_settings, by_keywords = function(*given, settings=kind(**changes)), function(*given, **changes)
    if function is ep.trace:
        by_settings, by_keywords = by_settings.weight, by_keywords.weight
    assert np.array_equal(by_settings, by_keywords)


@pytest.mark.parametrize("function, kinds", [
    (ep.trace, [ep.TraceSettings]), (ep.synthesize, [ep.SignalSettings]), (ep.decompose, [ep.SignalSettings]),
    (ep.simulate, [ep.TraceSettings, ep.SignalSettings]), (ep.annotate, [ep.SignalSettings, ep.LabelSettings]),
    (ep.annotate_frame, [ep.LabelSettings]), (ep.range_doppler, [ep.SignalSettings]), (ep.validity, [ep.SignalSettings])])
def test_defaults_are_those_of_the_settings(function, kinds):
    own = inspect.signature(function).parameters
    shared = {field.name: field.default for kind in kinds for field in dataclasses.fields(kind) if field.name in own}
    assert shared and {name: own[name].default for name in shared} == shared


def test_simulate_has_every_setting_of_trace_and_signal():
    own = set(inspect.signature(ep.simulate).parameters)
    assert {field.name for kind in KINDS[:2] for field in dataclasses.fields(kind)} <= own


@pytest.mark.parametrize("kind", KINDS)
def test_settings_are_frozen_values(kind):
    settings = kind()
    assert settings == kind() and settings.replace() == settings and set(settings.RULES) == set(settings.keywords())
    field = dataclasses.fields(kind)[-1].name
    with pytest.raises(dataclasses.FrozenInstanceError):
        setattr(settings, field, None)
    with pytest.raises(TypeError, match="unknown keyword 'nonsense'; its arguments are"):
        kind(nonsense=1)
    with pytest.raises(TypeError, match="unknown keyword 'nonsense'; its arguments are"):
        settings.replace(nonsense=1)


def test_settings_that_differ_are_not_equal_and_hash_by_value():
    one, other = ep.TraceSettings(seed=2), ep.TraceSettings(seed=3)
    assert one != other and one.replace(seed=3) == other and hash(one.replace(seed=3.0)) == hash(other)


def test_objects_of_labels_are_values_of_their_own():
    given = {"plates": ["plate", "wall*"], "car": "car"}
    settings = ep.LabelSettings(objects=given)
    same = ep.LabelSettings(objects={"plates": iter(["plate", "wall*"]), "car": ["car"]})
    assert hash(settings) == hash(same) and settings == same == same.replace(noise=True)
    given["plates"].append("roof")
    given["ghost"] = "nothing"
    assert settings.objects == (("plates", ("plate", "wall*")), ("car", ("car",)))
    assert ep.LabelSettings(objects=["car"]) == ep.LabelSettings(objects={"car": "car"})
    assert settings != ep.LabelSettings(objects=dict(reversed(settings.objects)))  # the first that a path touches owns it


def test_functions_that_take_settings_are_those_that_the_module_names():
    said = (ep.arguments.settings.__doc__ or "").split("Keywords of the call")
    takes = {name for name in ep.__all__ if callable(getattr(ep, name)) and inspect.isfunction(getattr(ep, name))
             and any(kind.__name__ in str(parameter.annotation) for kind in KINDS
                     for parameter in inspect.signature(getattr(ep, name)).parameters.values())}
    assert takes == set(re.findall("`([a-z_]+)`", said[0])) and not takes & set(re.findall("`([a-z_]+)`", said[1]))


def test_settings_of_another_kind_are_refused():
    with pytest.raises(TypeError, match="signal: must be a SignalSettings, got TraceSettings"):
        ep.simulate(make_scene(), make_radar(), signal=ep.TraceSettings())


def test_what_shows_is_what_users_need():
    shown = dir(ep)
    assert set(shown) == {*ep.__all__, "__version__", "dataset"} and "plots" in shown and ep.plots.plot_range_doppler
    modules = {name for name in shown if inspect.ismodule(getattr(ep, name))}
    assert modules == {"actors", "dataset", "plots"}
    for name in modules:
        module = getattr(ep, name)
        assert dir(module) == sorted(module.__all__) and not any(inspect.ismodule(getattr(module, one)) for one in dir(module))
