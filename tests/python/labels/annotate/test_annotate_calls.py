"""How labels are asked for: by themselves and from `simulate`, with right and wrong keywords, beside other threads."""
import sys
import threading

import numpy as np
import pytest

import echopath as ep
from echopath import _core
from echopath.labels import AzimuthPeak, Peak
from echopath.labels.report import peak_words
from support.labelled import make_radar

ROUNDING = 1e-9  # relative: sums in another order


def test_simulate_carries_the_labels_of_its_parts(plates_and_wall):
    paths, parts, _ = plates_and_wall
    settings = {"num_rays": 5000, "parts": parts, "tolerance": 1e-9}
    frame = ep.simulate(paths.scene, make_radar(), labels={"dynamic_range_db": 50.0}, **settings)
    (labels,) = frame.labels.values()
    alone = ep.annotate(frame.paths, parts, dynamic_range_db=50.0, tolerance=1e-9)
    assert np.array_equal(labels.dominant, alone.dominant) and labels.objects[0].cells == alone.objects[0].cells
    assert np.abs(labels.power - alone.power).max() < ROUNDING * alone.whole.max()
    assert ep.simulate(paths.scene, make_radar(), **settings).labels == {}
    bare = ep.simulate(paths.scene, make_radar(), num_rays=1000, labels=True)
    assert bare.parts == {} and bare.labels["parts"].part_names == ["other"]


def test_a_frame_of_parts_is_labelled_by_the_same_selections(plates_and_wall):
    """They take the place of the partition of that name, which the frame has already."""
    paths, parts, _ = plates_and_wall
    frame = ep.simulate(paths.scene, make_radar(), num_rays=1000, parts=parts, guard=False)
    labelled = ep.annotate_frame(frame, parts)
    assert list(labelled) == list(frame.parts) and labelled["parts"].part_names == list(frame.parts["parts"])


@pytest.mark.parametrize("yaw", [0.0, 2.0])
def test_a_person_close_before_the_radar_is_an_object(yaw):
    """A sensor at a bed or in a car: the sphere about a body of 1.7 m holds an antenna 0.3 m before its chest."""
    scene, ahead = ep.Scene(), np.array([np.cos(yaw), np.sin(yaw), 0.0])
    scene.add(ep.actors.standing_person(height=1.7), name="person", position=0.45 * ahead, yaw=yaw + np.pi)
    scene.add(ep.actors.box((0.1, 0.1, 1.3)), name="stand", material="wood", position=(0.0, 0.0, 0.65) - 0.15 * ahead, yaw=yaw)
    radar = make_radar(height=0.0, bandwidth=3e9).replace(position=(0.0, 0.0, 1.15), yaw=yaw)
    frame = ep.simulate(scene, radar, num_rays=1000, labels=True, detections=True, truth=True, guard=False)
    assert [one.name for one in frame.labels["parts"].objects] == ["person"] == frame.truth.name.tolist()
    assert "person" in frame.detections.object and frame.truth.range[0] < 0.6
    turned = ep.annotate(ep.trace(scene, radar.replace(yaw=yaw + np.pi), num_rays=1000))  # what is behind may carry the radar
    assert [one.name for one in turned.objects] == ["stand"]


def test_a_peak_that_rounds_to_zero_has_no_minus_before_it():
    assert peak_words(Peak(6.0, -0.004, 1.0)) == "6.00 m +0.00 m/s"
    assert peak_words(AzimuthPeak(6.0, -1e-17, 1.0)) == "6.00 m +0.0 deg"


def test_words_name_objects_and_ghosts(labels):
    text = str(labels)
    assert "object a: seen" in text and "ghost  a: type" in text and "part   wall:" in text
    assert "range_doppler" in repr(labels)


@pytest.mark.parametrize("keywords, message", [
    ({"plane": "elevation"}, "plane: must be 'range_doppler' or 'range_azimuth', got 'elevation'"),
    ({"plane": "range_azimuth"}, "plane: 'range_azimuth' needs antennas side by side"),
    ({"angles": {}}, "angles: are for the plane 'range_azimuth'"),
    ({"dynamic_range_db": -1}, "dynamic_range_db: must be a finite number of at least 0 dB, got -1"),
    ({"noise_margin_db": np.nan}, "noise_margin_db: must be a finite number from -300 to 300 dB, got nan"),
    ({"errors": True}, "errors: need 2 independent batches of rays at least, as batches=8 .* --batches 8"),
    ({"window": "han"}, "window"),
    ({"zero_pad": 0}, "zero_pad"),
    ({"objects": ["bicycle"]}, "bicycle"),
    ({"parts": {"one": {"a": "T . R"}}}, r"parts: must be one partition, as parts\['one'\], got a table of partitions: one"),
    ({"parts": {"one": np.zeros((1, 1, 2, 2))}}, "parts: cubes must have shape"),
    ({"parts": ep.signals.parts.Parts({"other": np.zeros((1, 1, 64, 256))}, {}, make_radar(height=1.1)), "radar": make_radar()},
     "parts: must be of the radar, got those of another transmitters"),
])
def test_bad_settings_are_named(plates_and_wall, keywords, message):
    with pytest.raises(ValueError, match=message):
        ep.annotate(plates_and_wall[0], **{"parts": {}} | keywords)


def test_unknown_keywords_name_the_nearest(plates_and_wall):
    with pytest.raises(TypeError, match="annotate: unknown keyword 'tolerence', the nearest right one is 'tolerance'"):
        ep.annotate(plates_and_wall[0], tolerence=1e-6)
    with pytest.raises(TypeError, match="annotate_frame: unknown keyword 'object', the nearest right one is 'objects'"):
        ep.annotate_frame(None, object=["a"])
    with pytest.raises(TypeError,
                       match="labels: unknown keyword 'noise_margin', the nearest right one is 'noise_margin_db'"):
        ep.simulate(ep.Scene(), make_radar(), labels={"noise_margin": 3})


@pytest.mark.parametrize("objects, message", [({"x": "bicycle"}, "objects: .*'bicycle'"),
                                              ({"x": "a", "y": "a"}, "objects: must each have a mesh")])
def test_bad_objects_of_labels_are_told_before_the_trace(plates_and_wall, monkeypatch, objects, message):
    monkeypatch.setattr(sys.modules["echopath.frame.simulate"], "trace_scene", None)
    with pytest.raises(ValueError, match=message):
        ep.simulate(plates_and_wall[0].scene, make_radar(), labels={"objects": objects})


def test_no_keywords_are_all_defaults(plates_and_wall):
    paths, _, _ = plates_and_wall
    frame = ep.simulate(paths.scene, make_radar(), num_rays=1000, labels={}, detections={})
    assert list(frame.labels) == ["parts"] and len(frame.detections) > 0
    none = ep.simulate(paths.scene, make_radar(), num_rays=1000, labels=False, detections=False)
    assert none.labels == {} and none.detections is None


def test_detections_have_the_objects_of_the_labels(plates_and_wall):
    paths, _, _ = plates_and_wall
    frame = ep.simulate(paths.scene, make_radar(), num_rays=5000, labels={"objects": {"target": ["a", "b"]}},
                        detections=True)
    assert {"target"} <= set(frame.detections.object) <= {"target", ""}


@pytest.mark.parametrize("keywords, error, message", [
    ({"false_alarm": 1e-3}, TypeError,
     "detections: unknown keyword 'false_alarm', the nearest right one is 'false_alarm_rate'"),
    ({"false_alarm_rate": 2.0}, ValueError, "false_alarm_rate: must be a finite number from 1e-15 to 0.5, got 2"),
    ({"objects": ["bicycle"]}, ValueError, "bicycle"),
])
def test_bad_keywords_of_detections_are_told_before_the_trace(plates_and_wall, monkeypatch, keywords, error, message):
    monkeypatch.setattr(sys.modules["echopath.frame.simulate"], "trace_scene", None)
    with pytest.raises(error, match=message):
        ep.simulate(plates_and_wall[0].scene, make_radar(), detections=keywords)


GIL_CALLS = {
    "power_shares": lambda power, mask: _core.power_shares(power),
    "cell_masks": lambda power, mask: _core.cell_masks(power[0], 0.5, 0.0),
    "strongest_part": lambda power, mask: _core.strongest_part(power, mask)}
TRIES = 100  # a busy machine may let the other thread wait for longer than one call


@pytest.mark.parametrize("name", GIL_CALLS)
def test_other_threads_run_beside_labels(name):
    power = np.ones((4, 2000, 1000))
    arrays = power, np.ones((2000, 1000), bool)
    go, ran, interval = threading.Lock(), threading.Event(), sys.getswitchinterval()
    go.acquire()
    other = threading.Thread(target=lambda: (go.acquire(), ran.set()))
    other.start()
    sys.setswitchinterval(1000.0)  # s: another thread runs only where this one lets it
    try:
        go.release()
        for _ in range(TRIES):
            GIL_CALLS[name](*arrays)
            if ran.is_set():
                break
        was_run = ran.is_set()
    finally:
        sys.setswitchinterval(interval)
        other.join()
    assert was_run


@pytest.mark.parametrize("wrong", [np.nan, np.inf])
def test_parts_with_what_is_no_number_are_refused(plates_and_wall, wrong):
    paths, parts, _ = plates_and_wall
    broken = dict(ep.decompose(paths, make_radar(), {"a": next(iter(parts.values()))}))
    broken["a"][0, 0, 1, 2] = wrong
    with pytest.raises(ValueError, match=r"^parts.a: must be finite, got .* at \[tx, rx, chirp, sample\] = \[0, 0, 1, 2\]"):
        ep.annotate(paths, broken)
