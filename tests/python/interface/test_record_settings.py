"""Each setting of a record reaches it, whoever is asked for the record: none is taken and then ignored."""
from __future__ import annotations

import json

import numpy as np
import pytest

import echopath as ep
from support.frames_in_time import make_radar

RAIN = ep.Weather(rain_mm_per_hour=50.0)
RAIN_DB_PER_KM = sum(RAIN.attenuation_db_per_km(make_radar()).values())

# For each setting of the core (RecordSettings): how a caller asks for it, and what the record must then say.
ASKED = {"seed": ({"seed": 7}, 7), "max_bounces": ({"max_bounces": 2}, 2), "polarization": ({"polarization": "jones"}, "jones"),
         "footprint": ({"footprint": "none"}, "none"), "sampler": ({"sampler": "random"}, "random"),
         "num_batches": ({"batches": 2}, 2), "scatterers": ({"scatterers": "surface"}, "surface"),
         "edges": ({"edges": True}, True), "faint_power": ({"faint_power": 1e-9}, 1e-9),
         "attenuation": ({}, pytest.approx(RAIN_DB_PER_KM / 1000.0 * np.log(10.0) / 20.0))}
NOT_OF_LIVE = {"num_batches"}  # whose rays are shared evenly, and which tells no errors
KEYWORDS = {"num_rays": 200}


def scene():
    made = ep.Scene(weather=RAIN)
    made.add(ep.Mesh([[5, -1, -1], [5, 1, -1], [5, 0, 1]], [[0, 1, 2]]), name="plate", material="concrete")
    return made


def of_live(radar, asked):
    live = ep.Live(scene(), radar, **asked)
    live.update()
    return live.paths()


def of_file(radar, asked, folder):
    ep.trace(scene(), radar, **asked).save(folder / "paths.h5")
    return ep.Paths.load(folder / "paths.h5")


def of_sequence(radar, asked):
    return ep.Sequence(scene(), radar, frames=1, interval=1.0, **asked)[0].paths


def of_scene_file(radar, asked, folder):
    """The same scene, written by hand, but for the radar that each such file has: it is the one asked for."""
    waveform = {"start_frequency": 77e9, "bandwidth": 1e9, "num_samples": 16, "sampling_rate": 1e7, "num_chirps": 4,
                "chirp_interval": 1e-4}
    lines = ["[radar]", "transmitters = [{position = [0, 0, 0]}]", "receivers = [{position = [0, 0, 0]}]",
             "[radar.waveform]", *(f"{name} = {value}" for name, value in waveform.items()),
             "[trace]", *(f"{name} = {json.dumps(value)}" for name, value in asked.items()),
             "[weather]", f"rain_mm_per_hour = {RAIN.rain_mm_per_hour}",
             "[[objects]]", 'name = "plate"', 'actor = "plate"', "parameters = {width = 2.0, height = 2.0}",
             'material = "concrete"', "position = [5.0, 0.0, 0.0]"]
    (folder / "scene.toml").write_text("\n".join(lines))
    file = ep.load_scene(folder / "scene.toml")
    return ep.simulate(file.scene, radar, **file.keywords()).paths


MAKERS = {"trace": lambda radar, asked, folder: ep.trace(scene(), radar, **asked), "file": of_file,
          "scene file": of_scene_file,
          "simulate": lambda radar, asked, folder: ep.simulate(scene(), radar, **asked).paths,
          "Sequence": lambda radar, asked, folder: of_sequence(radar, asked),
          "Live": lambda radar, asked, folder: of_live(radar, asked)}


@pytest.mark.parametrize("maker", MAKERS)
@pytest.mark.parametrize("setting", ep._core.RECORD_SETTINGS)
def test_a_setting_reaches_the_record(setting, maker, tmp_path):
    if maker == "Live" and setting in NOT_OF_LIVE:
        with pytest.raises(TypeError):
            ep.Live(scene(), make_radar(), **KEYWORDS, **ASKED[setting][0])
        return
    keywords, told = ASKED[setting]
    found = getattr(MAKERS[maker](make_radar(), KEYWORDS | keywords, tmp_path).frame, setting)
    assert found != ep._core.RECORD_SETTINGS[setting]
    assert found == told
