"""Frames that were simulated in weather and saved: the file tells the weather, and what uses it agrees with the frame."""
import h5py
import numpy as np
import pytest

import echopath as ep
from support.files.frame_edits import edited
from support.frames_in_time import make_radar
from support.shapes import quad

WET = ep.Weather(rain_mm_per_hour=20.0, fog_g_per_m3=0.1, wind=(3.0, 0.0, 0.0))
CHOICES = [{}, {"echoes of rain": False}, {"attenuation by weather": False}]


@pytest.fixture(scope="module", params=CHOICES, ids=["all of it", "no echoes", "no attenuation"])
def frames(request, tmp_path_factory):
    """A frame in rain, its file, and the frame of that."""
    scene = ep.Scene(weather=WET)
    scene.add(quad((5, -1, -1), (5, 1, -1), (5, 1, 1), (5, -1, 1)), name="plate", material="metal")
    frame = ep.simulate(scene, make_radar(), num_rays=400, effects=request.param, noise_seed=2)
    path = tmp_path_factory.mktemp("wet") / "frame.h5"
    ep.save_frame(frame, path)
    return frame, path, ep.load_frame(path)


def test_a_file_tells_the_weather_of_its_frame(frames):
    frame, _, loaded = frames
    assert loaded.scene.weather == WET and loaded.effect_choices == frame.effect_choices
    assert loaded.effects == frame.effects
    assert [node.name for node in loaded.scene.nodes] == [node.name for node in frame.scene.nodes]


def test_signals_of_a_loaded_scene_are_those_of_the_frame(frames):
    frame, _, loaded = frames
    again = ep.simulate(loaded.scene, loaded.radar, num_rays=400, effects=dict(loaded.effect_choices), noise_seed=2)
    assert np.array_equal(again.cube, frame.cube) and np.array_equal(again.noisy_cube, frame.noisy_cube)


def test_labels_detections_and_validity_of_a_loaded_frame_are_those_of_the_frame(frames):
    frame, _, loaded = frames
    for one in (frame, loaded):
        one.labels = ep.annotate_frame(one)
        one.detections = ep.detect_frame(one, false_alarm_rate=0.01)
    assert loaded.labels == frame.labels and loaded.detections == frame.detections
    assert str(ep.validity(loaded.paths)) == str(ep.validity(frame.paths))


def test_a_file_without_weather_says_nothing_of_it(tmp_path):
    scene = ep.Scene()
    scene.add(quad((5, -1, -1), (5, 1, -1), (5, 1, 1), (5, -1, 1)), name="plate", material="metal")
    ep.save_frame(ep.simulate(scene, make_radar(), num_rays=200), tmp_path / "frame.h5")
    with h5py.File(tmp_path / "frame.h5") as file:
        assert "weather" not in file["scene"].attrs and "effects" not in file["scene"].attrs
    assert ep.load_frame(tmp_path / "frame.h5").scene.weather is None


@pytest.mark.parametrize("name, text, told", [("weather", '{"rain_mm_per_hour": -1}', "rain_mm_per_hour"),
                                              ("weather", "[1]", "scene"), ("effects", '[["echo", true]]', "echo")])
def test_damaged_weather_is_refused_by_name(frames, tmp_path, name, text, told):
    path = tmp_path / "frame.h5"
    path.write_bytes(frames[1].read_bytes())
    with edited(path) as file:
        file["scene"].attrs[name] = np.bytes_(text)
    with pytest.raises(ep.FileError, match=told):
        ep.load_frame(path)
