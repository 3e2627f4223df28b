"""Names, places and motions of other radars that a call must refuse or keep apart."""
import numpy as np
import pytest

import echopath as ep
from echopath.cli import main
from support.radars import build_radar

SLOW = {"num_samples": 256, "num_chirps": 16, "transmit_power": 1.0}
RADAR = build_radar(**SLOW)
BALL_AT = np.hypot(8, 3) - 0.2  # m, the nearest point of the ball


def scene_of(*others):
    """A ball aside, and other radars."""
    scene = ep.Scene(interferers=others)
    scene.add(ep.actors.sphere(0.2), name="ball", material=ep.Material.metal(), smooth=True, position=(8, 3, 0))
    return scene


def direct(**settings):
    """Another radar with parallel chirps, whose line stands where the ball's echo does, and which is 20 dB above it."""
    radar = build_radar(**SLOW).replace(**{"position": (2 * BALL_AT, 0, 0)} | settings)
    return ep.Interferer(radar=radar, over="direct")


def frame_of(*others, **settings):
    return ep.simulate(scene_of(*others), RADAR, **{"num_rays": 500, "max_bounces": 1, "guard": False} | settings)


def test_nothing_of_paths_takes_the_name_of_what_no_path_makes():
    frame = frame_of(direct())
    with pytest.raises(ValueError, match="^parts: must not be named 'interference'"):
        ep.annotate_frame(frame, {"interference": "T 'ball' R"})
    with pytest.raises(ValueError, match="^parts: must not be named 'rain'"):
        ep.annotate(frame.paths, {"rain": "T 'ball' R"})
    with pytest.raises(ValueError, match="^parts: must not be named 'rain'"):
        ep.detect(frame.spectrum, frame.radar, paths=frame.paths, parts={"rain": "T 'ball' R"})
    with pytest.raises(ValueError, match="^beside: must have other names than parts, got 'interference' in both"):
        ep.detect(frame.spectrum, frame.radar, parts={"interference": frame.cube}, beside=frame.beside_spectra)


def test_detections_by_labels_and_cubes_leave_other_radars_without_an_object():
    frame = frame_of(direct(), labels=True)
    by_labels = {"labels": frame.labels["parts"]}
    by_cubes = {"parts": {"ball": frame.cube, "interference": frame.interference_cube}}
    for known in (by_labels, by_cubes):
        found = ep.detect(frame.spectrum, frame.radar, paths=frame.paths, **known)
        strongest = found.power.argmax()
        assert (found.part[strongest], found.object[strongest]) == ("interference", "")
        assert len(found.paths(int(strongest))[0]) > 0  # the ball's echoes are in the cell


SHORT = ep.KeyframeMotion(times=[0, 0.02], translations=[[0, 0, 0], [1, 0, 0]], rotations=[[1, 0, 0, 0]] * 2)
LEAVES = r"^interferers\[1\].radar: must have a motion that covers all frames: .*0.02"


def test_motions_of_other_radars_cover_the_frames_before_the_work():
    scene = scene_of(direct(), direct(motion=SHORT))
    ep.Sequence(scene, RADAR, frames=2, interval=0.01, num_rays=500)
    with pytest.raises(ValueError, match=LEAVES):
        ep.Sequence(scene, RADAR, frames=10, interval=0.01, num_rays=500)
    with pytest.raises(ValueError, match=LEAVES):
        ep.simulate(scene, RADAR, num_rays=500, start_time=0.1)
    ep.Sequence(scene, RADAR, frames=10, interval=0.01, num_rays=500, effects={"interference": False})


def test_another_radar_in_the_place_of_the_radar_is_refused():
    nearer = r"interferers\[1\].radar: must be at least a wavelength, 0.00389 m, from the receivers that hear it, got 0.0$"
    scene = scene_of(direct(), direct(position=(0, 0, 0)))
    with pytest.raises(ValueError, match=nearer):
        ep.simulate(scene, RADAR, num_rays=500)
    with pytest.raises(ValueError, match=nearer):
        ep.Sequence(scene, RADAR, frames=2, interval=0.01, num_rays=500)
    with pytest.raises(ValueError, match="^other: must be at least a wavelength"):
        ep.interference(RADAR, RADAR)
    at_chirp_8 = 8 * RADAR.waveform.chirp_interval
    passing = RADAR.replace(position=(-0.5, 0, 0), motion=ep.LinearMotion(velocity=(0.5 / at_chirp_8, 0, 0)))
    with pytest.raises(ValueError, match="^other: must be at least a wavelength"):
        ep.interference(RADAR, passing)


def test_motions_need_cover_no_more_than_the_frame():
    """Of a single chirp, behind whose end nothing is known."""
    radar = build_radar(num_samples=128, num_chirps=1)
    way = ep.KeyframeMotion([0.0, radar.frame_duration], translations=[(0, 0, 0), (0, 0, 1e-6)])
    other = radar.replace(position=(30, 0, 0), motion=way)
    frame = ep.simulate(scene_of(ep.Interferer(radar=other)), radar.replace(motion=way), num_rays=100, guard=False)
    assert frame.interference_cube.any()


@pytest.mark.parametrize("others, told", [
    # Chirps of 0.9 of the slope, which begin after this radar's, are below them ever after; the other one crosses them.
    ([direct(waveform=RADAR.waveform.replace(bandwidth=1.1e9)),
      ep.Interferer(radar=RADAR.replace(position=(30, 2, 0), waveform=RADAR.waveform.replace(bandwidth=0.9e9)), offset=2e-6)],
     r"^interferers\[1\]: is never heard in the frame: its chirps never come near"),
    ([ep.Interferer(radar=RADAR.replace(position=(16, 6, 0)), over="direct")],  # behind the ball
     r"^interferers\[0\]: is never heard in the frame: no way leads from it"),
    ([direct(position=(-5, 0, 0), yaw=np.pi, transmitters=[ep.Antenna(pattern=ep.CosinePower(2))])],  # looks away
     r"^interferers\[0\]: is never heard in the frame: no way leads from it to the radar on which the antennas of both"),
    ([ep.Interferer(radar=RADAR.replace(position=(16, 6, 0)), over="direct", interval=1.0)],  # behind the ball, in no pause
     r"^interferers\[0\]: is never heard in the frame: no way leads from it"),
])
def test_a_radar_that_is_never_heard_is_named(others, told):
    with pytest.warns(RuntimeWarning, match=told) as warned:
        frame_of(*others)
    assert len([one for one in warned if "never heard" in str(one.message)]) == 1
    assert warned[0].filename == __file__


def test_a_radar_in_its_pause_is_no_mistake(recwarn):
    one = direct().replace(interval=1.0, offset=0.5)
    assert not frame_of(one).interference_cube.any()
    assert frame_of(one, start_time=4.5).interference_cube.any()
    assert not [warned for warned in recwarn if "never heard" in str(warned.message)]


@pytest.mark.parametrize("key, outside, lifetime", [
    ("rides_on", "", (1.0, 3.0)), ("trajectory", "", (1.0, 3.0)), ("trajectory", 'outside = "stands"\n', None)])
def test_radars_on_vehicles_that_come_and_go_send_with_them(tmp_path, key, outside, lifetime):
    (tmp_path / "cars.csv").write_text("time,id,x,y\n1,late,60,3\n2,late,50,3\n3,late,40,3\n0,ego,0,0\n4,ego,40,0\n")
    waveform = "start_frequency = 77e9\nbandwidth = 1e9\nnum_samples = 64\nsampling_rate = 20e6\nnum_chirps = 4\n"
    table = "[{0}waveform]\n" + waveform + "chirp_interval = 2e-5\n[[{0}transmitters]]\nposition = [0, 0, 0]\n"
    given = 'rides_on = "late"\n' if key == "rides_on" else 'trajectory = "cars.csv"\nid = "late"\n'
    text = (table.format("radar.") + '[[radar.receivers]]\nposition = [0, 0, 0]\n[[traffic]]\nfile = "cars.csv"\n'
            + f"[[interferers]]\n{given}{outside}" + table.format("interferers."))
    (tmp_path / "street.toml").write_text(text)
    interferer, = ep.load_scene(tmp_path / "street.toml").scene.interferers
    assert interferer.lifetime == lifetime
    np.testing.assert_allclose(interferer.radar.world_from_radar(2.0)[:3, 3], [50.0, 3.0, 0.0], atol=1.0)


def test_info_and_notebooks_tell_of_other_radars(tmp_path, capsys):
    """Slopes of 1 GHz in 12.8 us and of half of that: 20 MHz are crossed in 0.512 us."""
    waveform = "start_frequency = {start}\nbandwidth = {band}\nnum_samples = 256\nsampling_rate = 20e6\nnum_chirps = 4\n"
    table = "[{0}waveform]\n" + waveform + "chirp_interval = 2e-5\n[[{0}transmitters]]\nposition = [0, 0, 0]\n"
    text = (table.format("radar.", start=77e9, band=1e9) + "[[radar.receivers]]\nposition = [0, 0, 0]\n"
            + "[[interferers]]\nposition = [30, 2, 0]\nyaw_deg = 180\n" + table.format("interferers.", start=77.2e9, band=5e8))
    path = tmp_path / "two.toml"
    path.write_text(text)
    assert main(["info", str(path)]) == 0
    told = " ".join(capsys.readouterr().out.split())
    assert "interferers[0] (30, 2, 0) m, yaw 180 deg, pitch 0 deg; 77.2 GHz + 0.5 GHz in 12.8 us, every 20 us" in told
    assert "crossings of at most 0.512 us" in told
    scene = ep.load_scene(path).scene
    assert "1 other radar)" in repr(scene) and "1 other radar<" in scene._repr_html_()
