"""Warnings of the core name the line of the user, however many functions of the package lie between."""
import os
import subprocess
import sys
import warnings
from pathlib import Path

import pytest

import echopath as ep
from echopath.base.process import callers
from echopath.sequence.ahead import one_ahead

METAL = ep.Material.metal()


@pytest.fixture(scope="module")
def radar():
    return ep.Radar(ep.ChirpSequence(num_samples=64, num_chirps=16), transmitters=[ep.Antenna()], receivers=[ep.Antenna()])


@pytest.fixture(scope="module")
def scene():
    made = ep.Scene()
    corners = [[5, -1, -1], [5, 1, -1], [5, 1, 1], [5, -1, 1]]
    made.add(ep.Mesh(corners, [[0, 2, 1], [0, 3, 2]]), name="plate", material=ep.Material(reflectivity=0.5, scattering=0.5),
             motion=ep.LinearMotion((1, 0, 0)))
    return made


def _lines(record, words: str) -> list[str]:
    return [one.filename for one in record if words in str(one.message)]


def _coarse_ball() -> ep.Scene:
    made = ep.Scene()
    made.add(ep.actors.shapes.sphere(0.3, subdivisions=2), name="ball", material=METAL, smooth=True, position=(5, 0, 0))
    return made


def _line() -> int:
    """Of the file, from which this is called."""
    return sys._getframe(1).f_lineno


def test_a_missed_target(scene, radar):
    with warnings.catch_warnings(record=True) as record:
        warnings.simplefilter("always")
        ep.trace(scene, radar, num_rays=100, target_error_db=1e-3, max_rays=2000)
    assert _lines(record, "was reached at an error") == [__file__]


def test_antennas_that_tell_no_azimuths_apart(scene, radar):
    spectrum = ep.range_doppler(ep.synthesize(ep.trace(scene, radar, num_rays=1000), radar), radar)
    with warnings.catch_warnings(record=True) as record:
        warnings.simplefilter("always")
        ep.range_azimuth(spectrum, radar)
    assert _lines(record, "tell no azimuths apart") == [__file__]


def test_a_map_without_noise_in_detections_of_frames(scene, radar):
    with warnings.catch_warnings(record=True) as record:
        warnings.simplefilter("always")
        frame = ep.simulate(scene, radar, num_rays=100, noise_seed=None, detections=True, guard=False)
        ep.detect_frame(frame)
        ep.detect(frame.spectrum, radar)
    assert _lines(record, "holds no noise of the radar") == 3 * [__file__]


def test_a_script_beside_a_package_behind_a_link(tmp_path):
    package, beside = Path(ep.__file__).parent, tmp_path / "echopath_study"
    beside.mkdir()
    (tmp_path / "echopath").symlink_to(package)
    (beside / "run.py").write_text(
        "from echopath.base.process import callers\n"
        "code = compile('level = level_of_user()', callers.__file__, 'exec')\n"
        "names = {'level_of_user': callers.level_of_user}\ndef main():\n    exec(code, names)\nmain()\n"
        "print(callers.__file__, names['level'])\n")
    run = subprocess.run([sys.executable, beside / "run.py"], env={**os.environ, "PYTHONPATH": str(tmp_path)},
                         capture_output=True, text=True, check=True)
    assert run.stdout.split() == [str(tmp_path / "echopath" / "base" / "process" / "callers.py"), "2"]


def test_a_package_beside_this_one_is_not_the_user():
    names = {"warn_user": callers.warn_user}
    exec(compile("def draw(*beside): warn_user('drawn', RuntimeWarning, *beside)", "/beside/plot.py", "exec"), names)
    with warnings.catch_warnings(record=True) as record:
        warnings.simplefilter("always")
        names["draw"]()
        names["draw"]("/besi")
        names["draw"]("/beside")
    assert _lines(record, "drawn") == ["/beside/plot.py", "/beside/plot.py", __file__]


def test_an_empty_scene_traced_by_itself_and_in_sequences(radar):
    with warnings.catch_warnings(record=True) as record:
        warnings.simplefilter("always")
        ep.trace(ep.Scene(), radar, num_rays=100)
        ep.simulate(ep.Scene(), radar, num_rays=100)
        ep.Sequence(ep.Scene(), radar, frames=1, interval=0.1, num_rays=100)[0]
    assert _lines(record, "has no mesh that takes part") == 3 * [__file__]


def test_frames_in_a_loop_whose_records_a_thread_makes(radar):
    with warnings.catch_warnings(record=True) as record:
        warnings.simplefilter("always")
        lines = range(_line() + 1, _line() + 3)
        for _ in ep.Sequence(ep.Scene(), radar, frames=2, interval=0.1, num_rays=100):
            pass
    told = [one for one in record if "has no mesh that takes part" in str(one.message)]
    assert [(one.filename, one.lineno in lines) for one in told] == [(__file__, True)]


def test_warnings_of_the_core_in_a_loop_over_frames(scene, radar):
    with warnings.catch_warnings(record=True) as record:
        warnings.simplefilter("always")
        for _ in ep.Sequence(scene, radar, frames=2, interval=0.1, num_rays=100, target_error_db=1e-3, max_rays=2000):
            pass
    assert _lines(record, "was reached at an error") == 2 * [__file__]


def test_a_thread_says_once_what_python_says_once():
    names = {"warn_user": callers.warn_user}
    exec(compile("def work(progress): warn_user('the same')", callers.__file__, "exec"), names)

    def warned_in_threads(action: str) -> list[str]:
        with warnings.catch_warnings(record=True) as record:
            warnings.simplefilter(action)
            for _ in one_ahead(3 * [names["work"]]):
                pass
        return _lines(record, "the same")

    assert warned_in_threads("always") == 3 * [__file__] and warned_in_threads("default") == [__file__]


def test_simulations_in_a_loop_say_once_what_python_says_once(radar):
    coarse, row = _coarse_ball(), [ep.Antenna((0, 0.002 * number, 0)) for number in range(4)]
    for one in (radar, radar.replace(receivers=row)):  # without a map of azimuths, and with one
        with warnings.catch_warnings(record=True) as record:
            warnings.simplefilter("default")
            for _ in range(3):
                ep.simulate(coarse, one, num_rays=100, guard=False)
        assert len(_lines(record, "edges of")) == 1


def test_warnings_that_are_errors_end_the_loop(radar):
    with warnings.catch_warnings(), pytest.raises(RuntimeWarning, match="has no mesh that takes part"):
        warnings.simplefilter("error")
        next(iter(ep.Sequence(ep.Scene(), radar, frames=2, interval=0.1, num_rays=100)))


def test_a_watched_scene(radar):
    live = ep.Live(_coarse_ball(), radar, num_rays=100)
    with warnings.catch_warnings(record=True) as record:
        warnings.simplefilter("always")
        with live.watch(lambda view: None) as watch:
            assert watch.wait(60.0)
    assert _lines(record, "edges of") == [__file__]


def test_a_ball_that_is_too_coarse(radar):
    coarse = _coarse_ball()
    with warnings.catch_warnings(record=True) as record:
        warnings.simplefilter("always")
        ep.trace(coarse, radar, num_rays=100)
        ep.rcs(coarse, frequency=77e9, incidence=(1, 0, 0), observation=(-1, 0, 0), num_rays=100)
    assert _lines(record, "too coarse") + _lines(record, "edges of") == 2 * [__file__]


def test_a_frame_that_is_written_and_read(scene, radar, tmp_path):
    coarse = radar.replace(receiver=ep.Receiver(adc=ep.Adc(bits=4, gain_db=0.0)))
    with warnings.catch_warnings(record=True) as record:
        warnings.simplefilter("always")
        frame = ep.simulate(scene, coarse, num_rays=100, guard=False)
        ep.save_frame(frame, tmp_path / "frame.h5")
        ep.load_frame(tmp_path / "frame.h5")
    files = _lines(record, "receiver.adc")
    assert len(files) > 1 and set(files) == {__file__}


def test_an_object_with_a_single_position(tmp_path):
    table = tmp_path / "tracks.csv"
    table.write_text("id,t,x,y\na,0,0,0\na,1,1,0\na,2,2,0\nb,0,5,5\n")
    with warnings.catch_warnings(record=True) as record:
        warnings.simplefilter("always")
        ep.read_trajectories(table)
    assert _lines(record, "with a single position") == [__file__]
