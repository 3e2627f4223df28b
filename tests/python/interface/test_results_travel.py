"""Results cross to another process, are copied and compared: the same bits come out, whatever comes out of them too."""
import copy
import multiprocessing
import pickle

import numpy as np
import pytest

import echopath as ep
from support.labelled import trace_plates_and_wall

COLUMNS = ("hits", "offsets", "num_bounces", "diffuse", "weight", "stratum", "batch", "flags", "curved_cell", "jones")
SETTINGS = {"num_rays": 3000, "batches": 2, "seed": 7}
PARTS = {"car": "T 'car' R"}


def there_and_back(value):
    return pickle.loads(pickle.dumps(value))


def make_scene():
    """A smooth moving ball of metal and a rough wall."""
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.4), name="car", material="metal", position=(8, 1, 0), smooth=True,
              motion=ep.LinearMotion(velocity=(-4.0, 0.0, 0.0)))
    scene.add(ep.actors.plate(6.0, 4.0), name="wall", material="concrete", position=(9, 4, 0), yaw=-1.8)
    return scene


@pytest.fixture(scope="module")
def radar():
    chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=0.5e9, num_samples=64, sampling_rate=5e6, num_chirps=32,
                              chirp_interval=2e-4)
    half_wave = 0.5 * chirps.wavelength
    return ep.Radar(chirps, transmitters=[ep.Antenna(pattern=ep.CosinePower(2.0))], transmit_power=1.0,
                    receivers=[ep.Antenna((0.0, k * half_wave, 0.0)) for k in range(4)])


@pytest.fixture(scope="module")
def frame(radar):
    return ep.simulate(make_scene(), radar, **SETTINGS, parts=PARTS, labels=True, detections=True)


@pytest.fixture(scope="module")
def paths(frame):
    return frame.paths


def bits_of(paths) -> list:
    """All that a record tells and all that follows from it, as bytes."""
    times = [paths.frame.start_time, paths.frame.trace_time]
    made = [paths.amplitudes(times), paths.lengths(times), paths.points(times[0]), ep.synthesize(paths),
            paths.select("T 'wall' .* R").weight, ep.families(paths).family_of_path]
    return [np.ascontiguousarray(array).tobytes() for array in [*(getattr(paths, name) for name in COLUMNS), *made]]


def bits_of_frame(frame) -> list:
    arrays = [frame.cube, frame.noisy_cube, frame.spectrum.values, frame.range_azimuth.power, frame.parts["parts"]["car"],
              frame.part_of_path["parts"], frame.labels["parts"].power, frame.labels["parts"].ghost_map,
              frame.detections.power, *frame.detections.paths(0)]
    return bits_of(frame.paths) + [np.ascontiguousarray(array).tobytes() for array in arrays]


def assert_same_bits(found, expected):
    assert len(found) == len(expected) and all(a == b for a, b in zip(found, expected))


# --- across processes ---

def test_paths_and_frames_are_the_same_in_a_spawned_process(paths, frame):
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert_same_bits(pool.apply(bits_of, (paths,)), bits_of(paths))
        assert_same_bits(pool.apply(bits_of_frame, (frame,)), bits_of_frame(frame))


def test_what_a_spawned_process_traces_is_what_this_one_does(radar, paths):
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        there = pool.apply(ep.trace, (make_scene(), radar), SETTINGS)
    assert_same_bits(bits_of(there), bits_of(paths))


# --- paths ---

@pytest.mark.parametrize("copied", [there_and_back, copy.deepcopy, copy.copy], ids=["pickle", "deepcopy", "copy"])
def test_copies_of_paths_have_the_same_bits(paths, copied):
    other = copied(paths)
    assert other is not paths and other.frame == paths.frame
    assert_same_bits(bits_of(other), bits_of(paths))


def test_polarised_paths_and_selections_travel(radar):
    vertical = ep.Radar(radar.waveform, transmitters=[ep.Antenna(polarization=(0, 0, 1))],
                        receivers=[ep.Antenna((0, 0.01, 0), polarization=(0, 1, 0))])
    paths = ep.trace(make_scene(), vertical, num_rays=2000, polarization="jones")
    assert len(paths.jones)
    assert_same_bits(bits_of(there_and_back(paths)), bits_of(paths))
    some = paths.select(ep.num_bounces == 1)
    assert_same_bits(bits_of(there_and_back(some)), bits_of(some))
    none = paths.select(np.zeros(paths.num_paths, bool))
    assert there_and_back(none).num_paths == 0


@pytest.mark.parametrize("name, value, error", [
    ("offsets", lambda paths: paths.offsets + paths.num_hits, "offsets"), ("num_bounces", lambda paths: None, "num_bounces"),
    ("weight", lambda paths: "text", "weight"), ("flags", lambda paths: paths.flags[1:], "must have one entry per path")])
def test_a_damaged_state_is_refused_by_name(paths, name, value, error):
    state = paths.__getstate__() | {name: value(paths)}
    with pytest.raises((ValueError, TypeError), match=error):
        ep.Paths.__new__(ep.Paths).__setstate__(state)


# --- maps and other values of the extension ---

def values_of(frame, radar) -> dict:
    spectrum, paths = frame.spectrum, frame.paths
    powers = ep.received_powers(paths, np.zeros(paths.num_paths, np.uint32), 1)
    return {
        "RangeDoppler": spectrum, "RangeAzimuth": ep.range_azimuth(spectrum, radar),
        "AngleSpectrum": ep.angle_fft(spectrum, radar), "BeamPower": ep.beamform(spectrum, radar),
        "beams of cells": ep.beamform(spectrum, radar, cells=[[3, 4]]),
        "AngleEstimates": ep.estimate_angles(spectrum, radar, cells=[[16, 20], [3, 4]]),
        "CfarResult": ep.cfar(spectrum, radar, method="os", false_alarm_rate=1e-3),
        "ReceivedPower": powers[0], "one batch": ep.received_power(ep.trace(make_scene(), radar, num_rays=500, batches=1)),
        "TraceFrame": paths.frame, "Stratum": paths.frame.strata[0], "TraceStatistics": paths.frame.statistics,
        "ValidityShares": ep.validity(paths).shares, "Selection": ep.hits("wall") & (ep.power > 1e-15) | ~(ep.num_bounces >= 2),
        "Chebyshev": ep.range_doppler(frame.cube, radar, window=("chebyshev", 60.0), zero_pad=2),
        "VirtualArray": ep.virtual_array(radar), "CoplanarOverlap": overlapping_scene().coplanar_overlaps()[0],
    }


def overlapping_scene():
    """Two plates of which one lies on a quarter of the other."""
    scene = ep.Scene()
    scene.add(ep.actors.plate(2.0, 2.0), name="large", material="metal")
    scene.add(ep.actors.plate(1.0, 1.0), name="small", material="concrete", position=(0.0, 0.5, 0.5))
    return scene


@pytest.fixture(scope="module")
def values(frame, radar):
    return values_of(frame, radar)


KINDS = ("RangeDoppler", "RangeAzimuth", "AngleSpectrum", "BeamPower", "beams of cells", "AngleEstimates", "CfarResult",
         "ReceivedPower", "one batch", "TraceFrame", "Stratum", "TraceStatistics", "ValidityShares", "Selection", "Chebyshev",
         "VirtualArray", "CoplanarOverlap")


def properties(value) -> dict:
    names = [name for name, member in vars(type(value)).items() if isinstance(member, property)]
    return {name: getattr(value, name) for name in names}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("copied", [there_and_back, copy.deepcopy], ids=["pickle", "deepcopy"])
def test_copies_of_values_are_equal_in_every_property(values, kind, copied):
    value = values[kind]
    other = copied(value)
    assert other is not value and other == value and not other != value
    assert other != 3 and (repr(other) == repr(value) or " object at " in repr(value))
    for name, found in properties(other).items():
        expected = properties(value)[name]
        if isinstance(expected, np.ndarray):
            assert found.dtype == expected.dtype and found.shape == expected.shape
            assert found.tobytes() == expected.tobytes(), name
        elif not (isinstance(expected, (float, complex)) and expected != expected):
            assert found == expected or repr(found) == repr(expected), name


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind not in ("Selection", "ValidityShares")])
def test_equality_minds_every_field(values, kind):
    """A copy with one field changed differs, whichever it is."""
    value = values[kind]
    for name, field in value.__getstate__().items():
        if isinstance(field, np.ndarray) and field.size:
            changed = field.copy()
            changed.flat[-1] = changed.flat[-1] + 1
        elif isinstance(field, (int, float)) and not isinstance(field, bool):
            changed = 1.0 if field != field else 2.0 if np.isinf(field) else field + 1
        else:
            continue
        state = value.__getstate__() | {name: changed}
        other = type(value).__new__(type(value))
        try:
            other.__setstate__(state)
        except (ValueError, TypeError):
            continue  # fields that must fit others
        assert other != value, name


def test_states_that_lack_fields_or_have_others_are_refused_by_name(values):
    spectrum = values["RangeDoppler"]
    state = spectrum.__getstate__()
    for damaged, error in [({key: value for key, value in state.items() if key != "window"}, "must have the field 'window'"),
                           (state | {"phase": 1}, "got 'phase'"), (state | {"values": state["values"][1:]}, "values: must have"),
                           (state | {"zero_pad": "two"}, "zero_pad: must be as a pickle has it, got a value of type str")]:
        with pytest.raises((ValueError, TypeError), match=error):
            ep.RangeDoppler.__new__(ep.RangeDoppler).__setstate__(damaged)


def test_validity_with_arrays_and_renewals_travel(paths):
    report = ep.validity(paths, arrays=True)
    other = there_and_back(report)
    assert other == report and str(other) == str(report) and other.objects == report.objects
    assert np.array_equal(other.phase_error, report.phase_error) and len(other.power) == paths.num_paths
    renewed = ep.renew(paths, time=0.0)
    other = there_and_back(renewed)
    assert other.num_moved == renewed.num_moved
    assert_same_bits(bits_of(other.paths), bits_of(renewed.paths))


# --- results of Python ---

def test_labels_detections_families_and_parts_are_equal_after_the_round_trip(frame, paths):
    values = {"labels": frame.labels["parts"], "detections": frame.detections, "families": ep.families(paths),
              "parts": ep.decompose(paths, parts=PARTS), "visibility": ep.visibility(frame.scene, frame.radar),
              "unresolved": ep.unresolved(paths), "effects": frame.effects, "cells": ep.path_cells(paths, frame.spectrum),
              "corners": ep.around_corners(frame.scene, frame.radar, num_rays=100),
              "model": ep.Model((ep.ModelNode("a", placement=np.eye(4)),))}
    assert len(values["detections"])
    for name, value in values.items():
        for other in (there_and_back(value), copy.deepcopy(value)):
            assert other == value, name
    assert frame.labels["parts"] != ep.annotate(paths, PARTS, noise_margin_db=20.0)
    assert values["detections"] != ep.detect(frame.spectrum, frame.radar, false_alarm_rate=1e-2)
    assert values["cells"] != ep.path_cells(paths, frame.spectrum, rx=3)
    assert values["model"] != ep.Model((ep.ModelNode("a", placement=2.0 * np.eye(4)),))
    assert hash(values["model"]) == hash(copy.deepcopy(values["model"]))
    changed = copy.deepcopy(values["parts"])
    changed["car"][0, 0, 0, 0] += 1e-18
    assert changed != values["parts"]


def test_parts_keep_their_selections_and_their_radar():
    paths, selections, _ = trace_plates_and_wall()
    parts = there_and_back(ep.decompose(paths, parts={name: ep.Selection(text) for name, text in selections.items()}))
    assert {name: str(selection) for name, selection in parts.selections.items()} == selections
    with pytest.raises(KeyError, match="no part 'gone'"):
        parts["gone"]


def test_families_that_travelled_take_the_signal_apart_as_before(paths):
    families = ep.families(paths)
    expected, found = (ep.decompose(paths, parts=one) for one in (families, there_and_back(families)))
    assert found == expected and list(found) == list(expected)


def test_a_grouping_by_all_travels_too(paths):
    from echopath._core import Grouping

    batches, selections = Grouping.batches(), Grouping.selections(list(PARTS.items()))
    grouping = Grouping.all_of([batches, selections, ep.families(paths).grouping])
    assert ep.decompose(paths, parts=there_and_back(grouping)) == ep.decompose(paths, parts=grouping)
    with pytest.raises(ValueError, match="grouping: must be"):
        Grouping.__new__(Grouping).__setstate__(("colours", None))


def test_frames_read_from_a_file_travel(frame, tmp_path):
    ep.save_frame(frame, tmp_path / "frame.h5")
    loaded = ep.load_frame(tmp_path / "frame.h5")
    assert_same_bits(bits_of_frame(there_and_back(loaded)), bits_of_frame(frame))


@pytest.mark.parametrize("copied", [there_and_back, copy.deepcopy], ids=["pickle", "deepcopy"])
def test_meshes_of_a_scene_travel(copied):
    for mesh in overlapping_scene().meshes:
        other = copied(mesh)
        assert (other.id, other.node, other.name, other.material) == (mesh.id, mesh.node, mesh.name, mesh.material)
        assert other.mesh == mesh.mesh and np.array_equal(other.triangles, mesh.triangles)
        assert other == mesh and hash(other) == hash(mesh)
    with pytest.raises(ValueError, match="state: must have the field 'node'"):
        type(mesh).__new__(type(mesh)).__setstate__({"id": 0, "node_index": 0})


def test_meshes_of_a_scene_are_found_in_its_list_and_in_that_of_a_copy():
    scene = overlapping_scene()
    first, second = scene.meshes
    changed = scene.copy()
    assert changed.meshes == scene.meshes and first != second and first != 0
    assert scene.meshes.index(second) == 1 and {first, second} == set(changed.meshes)
    changed["small"].material = "metal"
    assert [mesh.name for mesh in scene.meshes if mesh not in changed.meshes] == ["small"]
    assert scene.nodes == scene.nodes and scene.nodes != changed.nodes


@pytest.mark.parametrize("copied", [there_and_back, copy.copy, copy.deepcopy], ids=["pickle", "copy", "deepcopy"])
def test_probes_of_signals_travel_with_what_they_found(paths, copied):
    probe = ep.SignalProbe(seed=3)
    cube = ep.synthesize(paths, probe=probe)
    other = copied(probe)
    assert other == probe and other != ep.SignalProbe(seed=3)
    assert_same_bits([np.asarray(value).tobytes() for value in properties(other).values()],
                     [np.asarray(value).tobytes() for value in properties(probe).values()])
    assert ep.check_signal(cube, other) == ep.check_signal(cube, probe)
    assert ep.check_rays(other, paths.frame) == ep.check_rays(probe, paths.frame)


@pytest.mark.parametrize("name", ["power", "num_bounces"])
def test_what_rules_begin_with_stays_itself(name):
    value = getattr(ep, name)
    assert there_and_back(value) is value and copy.copy(value) is value and copy.deepcopy([value])[0] is value
