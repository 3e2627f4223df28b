"""What errors say to somebody who wrote something close to what is right."""
import copy
import dataclasses
import pickle
import re
import weakref

import numpy as np
import pytest

import echopath as ep
from echopath.arguments.keywords import known_keywords

RADAR = ep.Radar(ep.ChirpSequence(num_samples=16, num_chirps=4), transmitters=[ep.Antenna()], receivers=[ep.Antenna()])
CHIRPS = RADAR.waveform


@pytest.fixture(scope="module")
def scene():
    made = ep.Scene()
    made.add(ep.actors.plate(1, 1), name="plate", material="metal", position=(5, 0, 0))
    return made


@pytest.fixture(scope="module")
def frame(scene):
    return ep.simulate(scene, RADAR, num_rays=500, guard=False)


@pytest.mark.parametrize("call, wrong, right", [
    (ep.ChirpSequence, "fc", "start_frequency"), (ep.ChirpSequence, "carrier_frequency", "start_frequency"),
    (ep.ChirpSequence, "f0", "start_frequency"), (ep.ChirpSequence, "sample_rate", "sampling_rate"),
    (RADAR.replace, "velocity", "speed"), (RADAR.replace, "tx", "transmitters"), (RADAR.replace, "rx", "receivers"),
    (RADAR.replace, "heading", "yaw"), (ep.trace, "rays", "num_rays"), (ep.trace, "n_rays", "num_rays"),
    (ep.trace, "max_depth", "max_bounces"), (ep.detect, "pfa", "false_alarm_rate"), (ep.range_doppler, "pad", "zero_pad"),
    (ep.range_doppler, "padding", "zero_pad"), (ep.Scene().add, "rotation", "yaw"), (ep.Scene().add, "velocity", "speed"),
    (ep.actors.pedestrian, "velocity", "speed"), (ep.mie_rcs, "fc", "frequency"), (ep.Mesh, "faces", "triangles"),
    (ep.Material, "eps_r", "permittivity"), (ep.TraceSettings, "depth", "max_bounces"),
])
def test_words_of_others_lead_to_ours(call, wrong, right):
    with pytest.raises(TypeError, match=f"unknown keyword '{wrong}', the nearest right one is '{right}'"):
        call(**{wrong: 1})


@pytest.mark.parametrize("call", [ep.ChirpSequence, RADAR.replace, ep.trace, ep.Scene().add, ep.TraceSettings])
def test_words_unlike_any_get_the_list_instead(call):
    with pytest.raises(TypeError, match="unknown keyword 'qqqq'; its arguments are [a-z_]+, "):
        call(qqqq=1)


def test_a_list_without_the_arguments_that_are_given_says_so():
    with pytest.raises(TypeError, match="unknown keyword 'qqqq'; its other arguments are full_scale_dbm, "):
        ep.Adc(bits=12, qqqq=1)


@pytest.mark.parametrize("word, owner", [("bandwidth", "the ChirpSequence in 'waveform'"),
                                         ("pattern", "each Antenna in 'transmitters'")])
def test_words_of_an_argument_lead_to_it(word, owner):
    with pytest.raises(TypeError, match=f"^Radar: unknown keyword '{word}'; it belongs to {owner}$"):
        RADAR.replace(**{word: 1})


@pytest.mark.parametrize("given, meant", [("hanning", "hann"), ("Hamming", "hamming"), ("blackmanharris", "blackman_harris"),
                                          ("boxcar", "rect"), ("chebwin", "chebyshev")])
def test_windows_of_other_libraries(frame, given, meant):
    with pytest.raises(ValueError, match=rf"nearest: {meant}\)"):
        ep.range_doppler(frame.cube, RADAR, window=given)


def test_values_without_their_names_are_told_the_name(scene):
    told = r"^trace: takes scene, radar alone without a name; write num_rays=1000 if that is meant, got 1000$"
    with pytest.raises(TypeError, match=told):
        ep.trace(scene, RADAR, 1000)
    with pytest.raises(TypeError, match=r"^add: takes mesh_or_actor alone without a name; write name='second'"):
        scene.add(ep.actors.plate(1, 1), "second")
    with pytest.raises(TypeError, match="^pedestrian: takes nothing without a name; write height=1.7, speed=1.4"):
        ep.actors.pedestrian(1.7, 1.4)
    with pytest.raises(TypeError, match=r"^box: takes size alone without a name; write size=\(1.6, 0.8, 0.03\) if that is meant"):
        ep.actors.box(1.6, 0.8, 0.03)
    with pytest.raises(TypeError, match=r"^ground: takes size alone without a name; write size=\(8, 6\) if that is meant, got 6"):
        ep.actors.ground(8, 6)
    with pytest.raises(TypeError, match="^wall: argument 'height' is missing"):
        ep.actors.wall(3)
    with pytest.raises(TypeError, match="^add: argument 'name' is missing"):
        scene.add(ep.actors.plate(1, 1))
    with pytest.raises(TypeError, match="^trace: argument 'scene' is given twice, by its place and by its name"):
        ep.trace(scene, scene=scene, radar=RADAR)


def test_positions_and_names_of_any_function():
    @known_keywords
    def made(first, second=2, *, third=3):
        return first, second, third

    assert made(1, third=5) == (1, 2, 5)
    with pytest.raises(TypeError, match="made: takes first, second alone without a name; write third=9 if that is meant, got 9"):
        made(1, 2, 9)
    with pytest.raises(TypeError, match="made: takes first, second alone without a name, got 9"):
        made(1, 2, 9, third=4)


def test_a_frame_in_the_place_of_what_it_holds(frame):
    for call in (ep.synthesize, ep.unresolved, ep.validity):
        with pytest.raises(TypeError, match=r"^paths: must be a Paths \(its \.paths is one\), got Frame"):
            call(frame)
    with pytest.raises(TypeError, match=r"^cube: .* \(its \.cube is one\), got Frame"):
        ep.range_doppler(frame, RADAR)


@pytest.mark.parametrize("load", [ep.load_frame, ep.Paths.load, ep.load_mesh, ep.load_meshes, ep.load_antenna,
                                  ep.load_labels])
def test_folders_are_no_files(load, tmp_path):
    with pytest.raises(ep.FileError, match="path: must be the name of a file, not of a folder"):
        load(tmp_path)


def test_arrays_in_the_place_of_a_mesh(scene):
    with pytest.raises(TypeError, match=r"^mesh_or_actor: .*; arrays make one by ep\.Mesh\(vertices, triangles\)"):
        scene.add((np.eye(3), np.array([[0, 1, 2]])), name="own", material="metal")


def test_values_that_cannot_be_changed_name_replace():
    for value, name in ((RADAR, "position"), (CHIRPS, "bandwidth"), (ep.Antenna(), "yaw"), (ep.LinearMotion(), "velocity"),
                        (ep.Material.metal(), "mirror"), (RADAR, "speed")):
        with pytest.raises(AttributeError, match=rf"^{name}: cannot be set, a {type(value).__name__} does not change; "
                                                 rf"replace\({name}=...\)"):
            setattr(value, name, 1)


@pytest.mark.parametrize("kind, wrong, right", [
    ("Scene", "interferer", "interferers"), ("Scene", "wheather", "weather"), ("Live", "rader", "radar"),
    ("Frame", "detection", "detections"), ("Frame", "rang_azimuth", "range_azimuth"), ("SceneNode", "postion", "position")])
def test_misspelt_attributes_are_refused_with_the_one_that_is_meant(scene, frame, kind, wrong, right):
    """In silence nothing would be changed by them."""
    value = {"Scene": ep.Scene(scene), "Live": ep.Live(scene, RADAR, num_rays=100), "Frame": frame,
             "SceneNode": scene[next(iter(scene))]}[kind]
    with pytest.raises(AttributeError, match=f"^{wrong}: no attribute of {kind}, the nearest right one is '{right}'$"):
        setattr(value, wrong, None)
    with pytest.raises(AttributeError, match=f"^qqqq: no attribute of {kind}$"):
        value.qqqq = None
    assert not hasattr(value, wrong) and not hasattr(value, "qqqq")


def test_what_can_be_read_alone_is_refused_with_what_can_be_set(scene):
    """Another mesh or name is another object, which is added."""
    for name in ("mesh", "name", "parent", "meshes"):
        with pytest.raises(AttributeError, match=f"^{name}: cannot be set; of SceneNode lifetime, material, motion, position, "
                                                 "transform, visible, yaw can$"):
            setattr(scene[next(iter(scene))], name, None)
    with pytest.raises(AttributeError, match="^scene: cannot be set; of Live radar can$"):
        ep.Live(scene, RADAR, num_rays=100).scene = scene


def test_the_scene_of_a_live_scene_refuses_misspelt_attributes_and_counts_no_change(scene):
    live = ep.Live(scene, RADAR, num_rays=100)
    with pytest.raises(AttributeError, match="^wheather: .*'weather'$"):
        live.scene.wheather = ep.Weather(rain_mm_per_hour=10.0)
    assert live.number == 0
    live.scene.weather = ep.Weather(rain_mm_per_hour=10.0)
    assert live.number == 1


def test_classes_that_are_derived_from_ours_may_have_attributes_of_their_own(scene):
    class Street(ep.Scene):
        def __init__(self):
            super().__init__(scene)
            self.city = "Ulm"

    street = Street()
    street.mayor = "somebody"
    assert (street.city, street.mayor, len(street)) == ("Ulm", "somebody", 1)


def test_scenes_and_frames_that_refuse_attributes_travel_as_before(scene, frame):
    rainy = ep.Scene(scene, weather=ep.Weather(rain_mm_per_hour=10.0))
    for copied in (copy.copy(rainy), copy.deepcopy(rainy), pickle.loads(pickle.dumps(rainy)), rainy.copy()):
        assert copied.weather == rainy.weather and list(copied) == ["plate"]
    assert weakref.ref(rainy)() is rainy
    assert copy.copy(frame).cube is frame.cube and dataclasses.replace(frame, noise_seed=7).noise_seed == 7


@pytest.mark.parametrize("compare, says", [
    (lambda: ep.num_bounces == "1", "^ep.num_bounces is compared with a count: must be a whole number, got '1'"),
    (lambda: ep.num_bounces >= None, "^ep.num_bounces .*got None"), (lambda: ep.power > "x", "^ep.power .* W: .*got 'x'")])
def test_comparisons_say_what_they_take(compare, says):
    with pytest.raises(TypeError, match=says):
        compare()


def test_whole_floats_are_counts_of_bounces():
    assert (ep.num_bounces == 2.0).text == (ep.num_bounces == 2).text


def test_frames_beyond_the_walk_name_the_duration():
    scene = ep.Scene()
    scene.add(ep.actors.pedestrian(height=1.7, speed=1.4), name="walker", position=(8, 0, 0))
    with pytest.raises(ValueError, match=r"^motion: must be defined from .*duration=.*walker"):
        ep.trace(scene, RADAR.replace(waveform=CHIRPS.replace(num_chirps=2000, chirp_interval=0.01)), num_rays=100)


def test_masked_values_are_refused():
    hidden = np.ma.masked_array(np.eye(3), np.eye(3, dtype=bool))
    with pytest.raises(ValueError, match="^vertices: .*masked"):
        ep.Mesh(hidden, [[0, 1, 2]])
    with pytest.raises(ValueError, match="^position: .*masked"):
        ep.Scene().add(ep.Mesh(np.eye(3), [[0, 1, 2]]), name="a", material="metal", position=hidden[0])
    bare = np.ma.masked_array(np.eye(3))  # nothing of it is masked
    assert ep.Mesh(bare, [[0, 1, 2]]).vertices.shape == (3, 3)


def test_times_of_paths_are_named(frame):
    with pytest.raises(ValueError, match="^times: must be finite, got nan"):
        frame.paths.amplitudes([0.0, np.nan])


def test_detections_take_parts_as_decompose_has_them():
    chirps = ep.ChirpSequence(bandwidth=0.5e9, num_samples=64, sampling_rate=5e6, num_chirps=32, chirp_interval=1e-4)
    radar = RADAR.replace(waveform=chirps, transmit_power=1.0)
    scene = ep.Scene()
    scene.add(ep.actors.sphere(0.4), name="ball", material="metal", position=(8, 0, 0), speed=-4.0, smooth=True)
    paths = ep.trace(scene, radar, num_rays=4000)
    spectrum = ep.range_doppler(ep.add_noise(ep.synthesize(paths), radar, seed=1), radar)
    expected = ep.detect(spectrum, radar, parts=ep.decompose(paths, radar, {"ball": "T 'ball' R"}))
    chosen = ep.detect(spectrum, radar, paths=paths, parts={"ball": "T 'ball' R"})
    assert set(expected.part) == {"ball"} == set(chosen.part)
    assert set(ep.detect(spectrum, radar, parts=ep.decompose(paths, radar, ep.families(paths))).part) == {"ball"}
    with pytest.raises(ValueError, match="^parts: selections need paths"):
        ep.detect(spectrum, radar, parts={"ball": "T 'ball' R"})


@pytest.mark.parametrize("kind, maker", [
    (ep.Detections, "ep.detect"), (ep.Labels, "ep.annotate"), (ep.Frame, "ep.simulate"), (ep.Truth, "ep.truth"),
    (ep.Spectrogram, "ep.spectrogram"), (ep.Tracks, "ep.track"), (ep.Parts, "ep.decompose"), (ep.SceneFile, "ep.load_scene"),
    (ep.RangeDoppler, "ep.range_doppler"), (ep.Paths, "ep.trace")])
def test_records_that_a_function_makes_lead_to_it(kind, maker):
    with pytest.raises(TypeError, match=rf"^{kind.__name__}: .*is made by .*{maker}"):
        kind(0)


def test_errors_within_a_record_are_not_taken_for_a_call_that_does_not_fit():
    with pytest.raises(TypeError, match="^cubes: must be a dict by the names of the parts, got 0"):
        ep.Parts(0, {})


def test_a_faulty_text_of_paths_names_its_argument(scene):
    paths = ep.trace(scene, RADAR, num_rays=100)
    with pytest.raises(ValueError, match="^selection: path expression: expected"):
        paths.select("nonsense")
    with pytest.raises(ValueError, match=r"^parts\['a'\]: path expression: expected"):
        paths.partition({"a": "T ("})


def test_meshes_that_load_model_may_read_are_told_so(tmp_path):
    with pytest.raises(ep.FileError, match=r"unknown mesh format '.xml', known are .*\.off; load_model reads more kinds$"):
        ep.load_mesh(tmp_path / "street.xml")


def test_a_mirror_among_what_has_a_cross_section_is_named():
    scene = ep.Scene()
    scene.add(ep.actors.wall(4.0, 2.0), name="wall", material=ep.materials["concrete"].replace(mirror=True))
    with pytest.raises(ValueError, match="^scene: must have no mesh marked mirror, which has no cross section, got wall$"):
        ep.rcs(scene, frequency=77e9, incidence=(-1, 0, 0), num_rays=64)


@pytest.mark.parametrize("word, home", [
    ("errors", "labels={'errors': ...}"), ("false_alarm_rate", "detections={'false_alarm_rate': ...}"),
    ("objects", "labels={'objects': ...} or detections={'objects': ...} or truth={'objects': ...}")])
def test_keywords_of_a_dict_among_the_keywords_are_told_where_they_belong(scene, word, home):
    for call, more in ((ep.simulate, {}), (ep.Sequence, {"frames": 2, "interval": 1.0})):
        with pytest.raises(TypeError, match=rf"^{call.__name__}: unknown keyword '{word}', it belongs to {re.escape(home)}$"):
            call(scene, RADAR, **{word: True}, **more)


@pytest.mark.parametrize("table", ["labels", "parts", "selections", "part_of_path", "part_spectra", "mean_part_powers"])
def test_partitions_that_a_frame_lacks_say_how_to_have_them(frame, table):
    with pytest.raises(KeyError, match=r"no partition 'parts'; the frame has none of these: simulate\(parts=\).*labels=True"):
        getattr(frame, table)["parts"]


def test_partitions_of_another_name_are_told(scene, tmp_path):
    asked = ep.simulate(scene, RADAR, num_rays=500, guard=False, parts={"body": {"plate": "T 'plate' R"}}, labels=True)
    asked.save(tmp_path / "frame.h5")
    for made in (asked, ep.load_frame(tmp_path / "frame.h5"), pickle.loads(pickle.dumps(asked))):
        for table in ("labels", "parts", "selections", "part_of_path", "part_spectra", "mean_part_powers", "received_parts"):
            with pytest.raises(KeyError, match="no partition 'parts'; there are body"):
                getattr(made, table)["parts"]
            assert dict.get(getattr(made, table), "parts") is None


@pytest.mark.parametrize("member", ["noisy_cube", "received", "received_parts"])
def test_signals_that_a_record_lacks_are_missed_by_name(frame, tmp_path, member):
    frame.paths.save(tmp_path / "record.h5")
    with pytest.raises(ValueError, match="frame: must have signals, got a record of paths alone"):
        getattr(ep.load_frame(tmp_path / "record.h5"), member)
