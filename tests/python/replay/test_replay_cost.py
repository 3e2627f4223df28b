"""What will take long is said before it is begun."""
import warnings

import pytest

import echopath as ep
from support.radars import build_radar
from support.shapes import METAL, plate

LONG = {"num_chirps": 4096, "num_samples": 8192, "chirp_interval": 5e-4}


@pytest.fixture(scope="module")
def paths():
    scene = ep.Scene()
    rough = ep.Material(reflectivity=0.5, scattering=1.0)  # a mirror would be one path
    scene.add(plate((9, 0, 0), (-1, 0, 0), 1.0), name="near", material=rough, motion=ep.LinearMotion(velocity=(1, 0, 0)))
    return ep.trace(scene, build_radar(num_chirps=8), num_rays=1000)


@pytest.fixture
def one_thread():
    ep.set_num_threads(1)
    yield
    ep.set_num_threads(0)


@pytest.mark.parametrize("settings, told", [
    ({"evaluate": "samples"}, r"'samples' takes about \d+ s on this machine for \d+ paths"),
    ({"evaluate": "samples", "replay": "fermat", "retrace": "invalid", "keyframes": 4},
     ".* s on this machine, more with keyframes"),
])
@pytest.mark.parametrize("work", [ep.synthesize, lambda paths, radar, **settings: ep.decompose(paths, radar, {}, **settings)])
def test_long_work_is_told_of_before_it_begins(paths, one_thread, work, settings, told):
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # which ends it
        with pytest.raises(RuntimeWarning, match="evaluate: " + told):
            work(paths, build_radar(**LONG), **settings)


@pytest.mark.parametrize("retrace", ["always", "invalid"])
def test_many_stretches_are_told_of_before_they_begin(paths, one_thread, retrace):
    """Each is a trace or a renewal of its own: 1e8 of them are hours for any record."""
    radar = build_radar(num_chirps=2**31 - 1, chirp_interval=1e-4)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(RuntimeWarning, match=rf"keyframes: 100000000 stretches with retrace '{retrace}' take about \d+ s"):
            ep.synthesize(paths, radar, retrace=retrace, keyframes=100_000_000)


@pytest.mark.parametrize("settings", [{"evaluate": "samples"}, {"evaluate": "chirps", "replay": "fermat"}, {}])
def test_of_short_work_there_is_no_word(paths, settings):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ep.synthesize(paths, build_radar(num_chirps=8), **settings)


def test_of_what_stands_still_there_is_no_word(one_thread):
    scene = ep.Scene()
    scene.add(plate((9, 0, 0), (-1, 0, 0), 1.0), name="near", material=METAL)
    radar = build_radar(num_chirps=4096, num_samples=2048, chirp_interval=2e-4)
    still = ep.trace(scene, radar, num_rays=1000)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        ep.synthesize(still, radar, evaluate="chirps", tolerance=1e-3)
