"""Whatever is wrong with an argument, the error names the argument: thousands of wrong ones, for every public function.

A public function needs an entry in `GOOD`, with arguments that it takes; classes join by theirs. Each argument in turn is
replaced by each of `ODD`. Some of these are right for some arguments; the others must raise an error whose text has the
name of the argument.
"""
from __future__ import annotations

import inspect
import warnings
from types import SimpleNamespace

import numpy as np
import pytest

import echopath as ep
from support.files.gltf_files import box_file
from support.odd_values import EXPECTED, ODD, SURROGATE, is_named, make_radar, make_scene

# How many of the arguments tried must be wrong, so that the test cannot run empty.
FEWEST_WRONG = 6000


@pytest.fixture(scope="module")
def good(tmp_path_factory) -> dict:
    """{public name: arguments that it takes}"""
    folder = tmp_path_factory.mktemp("files")
    scene, radar = make_scene(), make_radar()
    frame = ep.simulate(scene, radar, num_rays=200, parts={"plate": "T 'plate' R"}, labels=True, guard=False)
    paths, cube, spectrum, probe = frame.paths, frame.cube, frame.spectrum, ep.SignalProbe()
    ep.synthesize(paths, probe=probe)
    ep.save_frame(frame, folder / "frame.h5")
    frame.save_raw(folder / "raw.bin")
    in_time = {"scene": scene, "radar": radar, "frames": 2, "interval": 0.1}
    ep.Sequence(**in_time, num_rays=200, guard=False).save(folder / "frames")
    (folder / "mesh.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    (folder / "box.glb").write_bytes(box_file().glb())
    (folder / "antenna.csv").write_text("azimuth_deg,elevation_deg,gain_db\n" + "".join(
        f"{azimuth},{elevation},0\n" for azimuth in (-10, 10) for elevation in (-10, 10)))
    (folder / "sensor.cfg").write_text(
        "% Platform : xWR68xx\nchannelCfg 1 1 0\nadcCfg 2 1\nprofileCfg 0 60 7 6 40 0 0 70 1 64 5000 0 0 30\n"
        "chirpCfg 0 0 0 0 0 0 0 1\nframeCfg 0 0 8 0 50 1 0\n")
    (folder / "drive.csv").write_text("t,x,y\n0,0,0\n1,1,0\n")
    mesh, of_map = {"path": folder / "mesh.obj"}, {"spectrum": spectrum, "radar": radar}
    labels = next(iter(frame.labels.values()))
    return {
        "angle_time": {"frames": frame}, "range_time": {"frames": frame}, "spectrogram": {"frames": frame},
        "spectrogram_labels": {"parts": {"plate": ep.spectrogram(frame)}}, "truth": {"frame": frame},
        "track": {"detections": [np.zeros((1, 2)), []], "times": [0.0, 1.0]},
        "add_noise": {"cube": cube, "radar": radar, "seed": 1}, "add_traffic": {"scene": ep.Scene(), "trajectories": {}},
        "angle_fft": of_map, "beamform": of_map, "read_trajectories": {"path": folder / "drive.csv"},
        "annotate": {"paths": paths, "parts": {"plate": "T 'plate' R"}},
        "annotate_frame": {"frame": frame, "parts": {"again": {"plate": "T 'plate' R"}}},
        "around_corners": {"scene": scene, "radar": radar, "num_rays": 50},
        "synthesize_around_corners": {"scene": scene, "radar": radar, "num_rays": 50},
        "backproject": {"cube": cube, "radar": radar, "points": (1, 0, 0)},
        "calibrate": {"cube": cube, "radar": radar, "position": (1, 0, 0)},
        "cfar": of_map, "check_rays": {"probe": probe, "frame": paths.frame}, "check_signal": {"cube": cube, "probe": probe},
        "demultiplex": {"cube": cube, "radar": radar}, "load_radar": {"path": folder / "sensor.cfg"},
        "load_sensor": {"path": folder / "sensor.cfg"}, "receive": {"cube": cube, "radar": radar, "seed": 1},
        "receive_parts": {"parts": {"whole": cube}, "radar": radar, "seed": 1},
        "compensate_tdm": of_map, "decompose": {"paths": paths, "parts": {"plate": "T 'plate' R"}}, "detect": of_map,
        "detect_frame": {"frame": frame}, "effects": {"scene": scene, "radar": radar},
        "estimate_angles": of_map | {"cells": [[0, 1]]}, "families": {"paths": paths},
        "find_objects": {"scene": scene, "radar": radar},
        "first": {"glob": "plate"},
        "hits": {"glob": "plate"}, "last": {"glob": "plate"}, "load_antenna": {"path": folder / "antenna.csv"},
        "load_frame": {"path": folder / "frame.h5"}, "load_labels": {"path": folder / "frame.h5"}, "load_mesh": mesh,
        "load_meshes": mesh, "load_model": {"path": folder / "box.glb"}, "load_scene": {"path": folder / "box.glb"},
        "load_sequence": {"path": folder / "frames"},
        "adapt_materials": {"scene": ep.Scene(), "radar": radar},  # which it changes
        "mark_mirrors": {"scene": ep.Scene(), "radar": radar},  # which it changes
        "mesh_from": {"source": SimpleNamespace(vertices=np.eye(3), faces=np.array([[0, 1, 2]]))},
        "mie_rcs": {"radius": 0.1, "frequency": 1e9},
        "noise_power": {"radar": radar}, "num_threads": {},
        "passes": {"glob": "plate"}, "path_cells": {"paths": paths, "spectrum": spectrum},
        "plot_rays": {"scene": scene, "paths": paths}, "power_by_chirp": {"cube": cube},
        "point_targets": {"radar": radar, "positions": [(1, 0, 0)], "rcs": 1.0}, "range_azimuth": of_map,
        "range_doppler": {"cube": cube, "radar": radar},
        "rcs": {"scene": scene, "frequency": 10e9, "incidence": (-1, 0, 0), "num_rays": 200},
        "received_power": {"paths": paths},
        "received_powers": {"paths": paths, "group_of_path": np.zeros(paths.num_paths, np.uint32), "num_groups": 1},
        "renew": {"paths": paths, "time": 0.0}, "save_frame": {"frame": frame, "path": folder / "saved.h5"},
        "save_label_images": {"labels": labels, "folder": folder / "images"},
        "save_labels": {"labels": frame.labels, "path": folder / "labels.h5"}, "set_num_threads": {"num_threads": 0},
        "interference": {"radar": radar, "other": radar.replace(position=(9, 0, 0))},
        "interference_radar": {"radar": radar, "other": radar},
        "music": of_map | {"azimuth": [0.0, 0.1], "cells": [[0, 1]], "num_sources": 1}, "remove_clutter": {"cube": cube},
        "save_raw": {"frames": frame, "path": folder / "saved.bin"}, "load_raw": {"path": folder / "raw.bin", "radar": radar},
        "sheet_coefficients": {"material": ep.materials["glass_pane"], "frequency": 77e9, "incidence": 0.3},
        "simulate": {"scene": scene, "radar": radar, "num_rays": 200, "guard": False}, "synthesize": {"paths": paths},
        "trace": {"scene": scene, "radar": radar, "num_rays": 200},
        "unresolved": {"paths": paths}, "validity": {"paths": paths}, "view": {"what": scene, "paths": paths},
        "virtual_array": {"radar": radar}, "visibility": {"scene": scene, "radar": radar, "num_directions": 16},
        "TraceSettings": {}, "SignalSettings": {}, "LabelSettings": {}, "Sequence": in_time, "Receiver": {}, "Adc": {},
        "PhaseNoise": {"offsets": [1e3], "levels": [-90.0]},
    }


# Classes whose constructors are held to the same.
CLASSES = ["TraceSettings", "SignalSettings", "LabelSettings", "Sequence", "Receiver", "Adc", "PhaseNoise"]
# Of the extension, which checks their arguments itself; and what reads foreign files, whose readers have tests of their own.
APART = {"CosinePower", "GainTable", "GaussianBeam", "Isotropic"}
FUNCTIONS = sorted(name for name in ep.__all__ if inspect.isroutine(getattr(ep, name)) and name not in APART)
# Arguments that nothing is wrong for: whatever is passed on as it is.
FREE = {("plot_rays", "cmap"), ("plot_rays", "plotter")}


def faults(name: str, arguments: dict):
    """(argument, odd value, what is wrong with the error) of those that do not name the argument; and how many were refused."""
    function, wrong, found = getattr(ep, name), 0, []
    for argument in inspect.signature(function).parameters:
        for odd, make in ODD.items():
            value = make()
            try:
                function(**arguments | {argument: value})
            except EXPECTED as error:
                wrong += 1
                if not is_named(argument, value, error):
                    found.append((argument, odd, repr(error)))
            except Exception as error:
                wrong += 1
                found.append((argument, odd, f"{type(error).__name__}: {error!r}"))
    return [fault for fault in found if (name, fault[0]) not in FREE], wrong


def test_every_public_function_is_tried(good):
    assert sorted(good) == sorted(FUNCTIONS + CLASSES)


def test_wrong_arguments_are_named(good, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("echopath.viewing.viewer._viewer", lambda: _NoViewer)
    total, found = 0, {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            for name, arguments in good.items():
                bad, wrong = faults(name, arguments)
                total += wrong
                found |= {name: bad} if bad else {}
        finally:
            ep.set_num_threads(0)
    words = "\n".join(f"{name}({argument}={odd}): {what}" for name, bad in found.items() for argument, odd, what in bad)
    assert not found, f"of {total} wrong arguments {sum(map(len, found.values()))} are not named:\n{words}"
    assert total >= FEWEST_WRONG, f"only {total} of the arguments tried are wrong"


class _NoViewer:
    """In the place of the viewer, which would open a window for what is right."""

    view = staticmethod(lambda *what, **keywords: None)
    plot_rays = staticmethod(lambda *what, **keywords: None)


@pytest.mark.parametrize("name", [*FUNCTIONS, *CLASSES])
def test_signatures_are_explicit_and_annotated(name):
    """No *arguments or **keywords, no parameter without a type."""
    for parameter in inspect.signature(getattr(ep, name)).parameters.values():
        assert parameter.kind not in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD), parameter
        assert parameter.annotation is not parameter.empty, parameter


@pytest.mark.parametrize("name", [*FUNCTIONS, *CLASSES])
def test_unknown_keywords_are_refused_by_name(name, good):
    for word in ("num_rayz", SURROGATE):
        with pytest.raises(TypeError, match="num_rayz|wall.ud800"):
            getattr(ep, name)(**good[name], **{word: 1})


@pytest.mark.parametrize("value", [1e2, 100.0, np.int16(100), np.float32(100), np.array(100)])
def test_whole_floats_and_numpy_integers_are_counts(good, value):
    traced = [ep.trace(**good["trace"] | {"num_rays": rays}) for rays in (100, value)]
    assert np.array_equal(traced[0].weight, traced[1].weight)
    assert ep.TraceSettings(num_rays=value).num_rays == 100


@pytest.mark.parametrize("span", [np.timedelta64(50_000_000, "ns"), np.timedelta64(50, "ms"), np.array(np.timedelta64(5, "ns"))])
def test_spans_of_time_are_no_numbers(good, span):
    """50 ms as a table has them, whose whole number of nanoseconds would be as many seconds or rays."""
    for name, argument in (("Sequence", "interval"), ("trace", "start_time"), ("trace", "num_rays")):
        with pytest.raises(TypeError, match=f"^{argument}: must be a (finite|whole) number"):
            getattr(ep, name)(**good[name] | {argument: span})


@pytest.mark.parametrize("objects", [{"plate", "pl*"}, frozenset(["plate"])])
def test_objects_are_no_sets_which_have_no_order(good, objects):
    """The first that takes a path has it: which is the first of a set hangs on the seed of Python's hashes."""
    with pytest.raises(TypeError, match="^objects: must be a dict or a list of globs"):
        ep.families(**good["families"], objects=objects)
    assert ep.families(**good["families"], objects={"plate": 1}.keys()).objects == ("plate",)


def test_arrays_are_not_copied_by_checks():
    from echopath.arguments.checks import array

    cube = np.zeros((1, 2, 3, 4), np.complex64)
    assert array("[T, R, C, S]", kind="complex")("cube", cube) is cube
