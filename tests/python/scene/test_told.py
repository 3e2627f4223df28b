"""What radars, scenes, templates and frames tell of themselves: their repr, in notebooks, and to `echopath info`."""
import re
from math import pi
from pathlib import Path

import pytest

import echopath as ep
from echopath import dataset
from echopath.cli.info import _body, describe_file
from echopath.cli.report import folded_velocities
from echopath.scene import closing_speeds as closing_speeds_module
from echopath.scene.closing_speeds import bodies_faster_than, closing_speeds
from support.files.scene_text import SMALL_RADAR
from support.radars import build_radar
from support.shapes import quad

TEMPLATE = Path(__file__).parents[3] / "data" / "datasets" / "crossing.toml"
RAIN = ep.Weather(rain_mm_per_hour=20.0)


def wet_scene():
    scene = ep.Scene(weather=RAIN)
    scene.add(quad((5, -1, -1), (5, 1, -1), (5, 1, 1), (5, -1, 1)), name="plate", material="metal")
    return scene


def coded_radar():
    return build_radar([(0, 0, 0), (0, 0.01, 0)], [(0, 0, 0)], num_samples=16, num_chirps=12, multiplexing="ddm",
                       receiver=ep.Receiver(iq_gain_db=0.5))


def test_a_radar_tells_its_code_and_its_receiver():
    told = coded_radar()._repr_html_()
    assert "ddm" in told and "iq_gain_db" in told
    assert "ideal but for its noise" in coded_radar().replace(receiver=None)._repr_html_()


def test_slots_that_differ_are_told():
    waveform = coded_radar().waveform
    told = waveform.replace(extra_idle=(0.0, 1e-6))
    assert "slots differ" in repr(told) and "slots differ" not in repr(waveform)
    assert "slots differ" in coded_radar().replace(waveform=told)._repr_html_()


def test_a_scene_and_a_frame_tell_their_weather():
    scene = wet_scene()
    frame = ep.simulate(scene, coded_radar(), num_rays=200)
    for told in (scene._repr_html_(), frame._repr_html_(), repr(scene)):
        assert "rain_mm_per_hour 20" in told
    assert "weather" not in repr(ep.Scene())


def test_a_scene_tells_its_mirrors():
    scene = ep.Scene()
    for name, height in (("left", 6.0), ("right", 0.1)):
        scene.add(ep.actors.wall(8.0, height), name=name, material="brick", position=(0, 5, 0))
    assert ep.mark_mirrors(scene, coded_radar()) == ("left",)
    told = re.sub("<[^>]*>", " ", scene._repr_html_())
    assert re.search(r"(?s)left .* brick, mirror .* right .* brick +at rest", told), told


def test_info_tells_code_receiver_and_weather_of_a_frame(tmp_path):
    ep.save_frame(ep.simulate(wet_scene(), coded_radar(), num_rays=200), tmp_path / "frame.h5")
    told = "\n".join(describe_file(tmp_path / "frame.h5"))
    assert "ddm" in told and "iq_gain_db" in told and re.search(r"\n  weather +rain_mm_per_hour 20\n", told)


def test_info_counts_the_mirrors_of_a_group():
    scene = ep.Scene()
    scene.add(None, name="houses")
    for name, mirror in (("a", True), ("b", False), ("c", True)):
        scene.add(ep.actors.wall(8.0, 3.0), name=name, parent="houses", material=ep.materials["brick"].replace(mirror=mirror))
    assert _body(scene, list(scene.meshes)) == "3 meshes, 6 triangles, 2 of them mirrors"
    assert _body(scene, list(scene.meshes)[:2]) == "2 meshes, 4 triangles, 1 of them a mirror"
    assert _body(scene, list(scene.meshes)[:1]) == "2 triangles, mirror"


FAST = -19.0  # m/s
ALIKE = 1e-3  # m/s: speeds are told to 1/100, differences over 1e-4 s bend by less


def fast_frame(num_transmitters: int):
    """A small plate that drives at a radar whose transmitters take turns, before a wall; the map tells 16.2 m/s of one of
    them."""
    scene = ep.Scene()
    scene.add(quad((5, -0.05, -0.05), (5, 0.05, -0.05), (5, 0.05, 0.05), (5, -0.05, 0.05)), name="plate", material="metal",
              motion=ep.LinearMotion(velocity=(FAST, 0.0, 0.0)))
    scene.add(quad((9, -1, -1), (9, 1, -1), (9, 1, 1), (9, -1, 1)), name="wall", material="concrete")
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=200e6, num_samples=32, sampling_rate=2e6, num_chirps=64,
                                chirp_interval=60e-6)
    radar = ep.Radar(waveform, transmitters=[ep.Antenna((0, 0.002 * k, 0)) for k in range(num_transmitters)],
                     receivers=[ep.Antenna((0, 0, 0))])
    return ep.simulate(scene, radar, num_rays=2000, guard=False)


@pytest.mark.parametrize("num_transmitters", [1, 2, 3])
def test_info_tells_what_the_map_of_velocity_folds_and_where_it_shows_it(tmp_path, num_transmitters):
    frame = fast_frame(num_transmitters)
    frame.save(tmp_path / "frame.h5")
    told = [line for line in describe_file(tmp_path / "frame.h5") if line.startswith("    plate") and " shown at " in line]
    name, speed, *_, shown, _ = told[0].split()
    assert len(told) == 1 and (name, speed) == ("plate", f"{FAST:+.2f}")
    power = abs(frame.spectrum.values[0, 0]) ** 2
    near = abs(frame.spectrum.range - 4.9) < 1.0  # where the plate is in the middle of the frame
    peak = frame.spectrum.velocity[power[:, near].max(axis=1).argmax()]
    assert float(shown) == pytest.approx(peak, rel=0, abs=0.51 * abs(frame.spectrum.velocity[1] - frame.spectrum.velocity[0]))


def test_velocities_that_a_map_tells_are_not_told_of():
    frame = fast_frame(1)
    slower = frame.radar.replace(waveform=frame.radar.waveform.replace(chirp_interval=50e-6))  # +- 19.4 m/s
    assert folded_velocities(frame.scene, frame.radar, 0.0) and not folded_velocities(frame.scene, slower, 0.0)


def test_closing_speeds_are_those_of_the_fastest_point():
    """A rod of 0.4 m that turns by 30 rad/s across the line of sight has 30 x 0.2 m/s at its ends; a radar that drives by 5 m/s
    has all that stands still come towards it."""
    scene = ep.Scene()
    rod = quad((-0.01, -0.2, 0.0), (0.01, -0.2, 0.0), (0.01, 0.2, 0.0), (-0.01, 0.2, 0.0))
    scene.add(rod, name="rod", material="metal", position=(50.0, 0.0, 0.0),
              motion=ep.LinearMotion(angular_velocity=(0.0, 0.0, 30.0)))
    scene.add(quad((9, -1, -1), (9, 1, -1), (9, 1, 1), (9, -1, 1)), name="wall", material="metal")
    radar = build_radar([(0, 0, 0)], [(0, 0, 0)], num_samples=16, num_chirps=16)
    found = closing_speeds(scene, radar, 0.0)
    assert set(found) == {"rod"} and max(abs(found["rod"])) == pytest.approx(6.0, rel=ALIKE, abs=0)
    driving = closing_speeds(scene, radar.replace(motion=ep.LinearMotion(velocity=(5.0, 0.0, 0.0))), 0.0)
    assert min(driving["rod"]) == pytest.approx(-11.0, rel=ALIKE, abs=0)
    assert min(driving["wall"]) == pytest.approx(-5.0 * 9.0 / 81.0 ** 0.5, rel=0.02, abs=0)  # of its corners, 9.1 m away


def test_a_blade_that_points_at_the_radar_in_mid_frame_is_as_fast_as_one_that_stands_across():
    """Its ends go 30 x 0.2 m/s about an upright axis: across the line of sight a quarter of a turn earlier or later."""
    chirps = ep.ChirpSequence(num_chirps=1024, chirp_interval=0.1 / 1024)  # half a turn
    radar = ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 0))], receivers=[ep.Antenna((0, 0, 0))])
    for yaw in (0.0, 0.5 * pi):
        scene = ep.Scene()
        blade = quad((-0.2, 0.0, -0.03), (0.2, 0.0, -0.03), (0.2, 0.0, 0.03), (-0.2, 0.0, 0.03))
        scene.add(blade, name="blade", material="metal", position=(50.0, 0.0, 0.0), yaw=yaw,
                  motion=ep.LinearMotion(angular_velocity=(0.0, 0.0, 30.0)))
        (body,) = bodies_faster_than(4.0, scene, radar, 0.0)
        assert (body.name, body.as_whole) == ("blade", False) and abs(body.speed) == pytest.approx(6.0, rel=0.03)
        assert not bodies_faster_than(6.1, scene, radar, 0.0)


def arm(length):
    """From an axle along +y, thin."""
    return quad((0.0, 0.0, -0.01), (0.0, length, -0.01), (0.0, length, 0.01), (0.0, 0.0, 0.01))


def turning(scene, name, length, yaw, **keywords):
    """An arm that makes 30 rad/s; with yaw 0 its end comes straight to the radar with 30 times its length."""
    scene.add(arm(length), name=name, material="metal", yaw=yaw, motion=ep.LinearMotion(angular_velocity=(0.0, 0.0, 30.0)),
              **keywords)


def test_what_comes_faster_at_the_end_of_a_frame_has_that_speed():
    """The end of an arm that makes a quarter of a turn begins at rest and comes at last with 6 m/s."""
    chirps = ep.ChirpSequence(num_chirps=1024, chirp_interval=pi / 60.0 / 1024)
    radar = ep.Radar(chirps, transmitters=[ep.Antenna()], receivers=[ep.Antenna()])
    scene, middle = ep.Scene(), radar.middle_of_frame(0.0)
    turning(scene, "arm", 0.2, -pi / 4.0 - 30.0 * middle, position=(50.0, 0.0, 0.0))
    (body,) = bodies_faster_than(5.0, scene, radar, middle)
    assert body.speed == pytest.approx(-6.0, rel=1e-3, abs=0)


def test_of_parts_that_come_and_go_the_fastest_counts_and_of_a_body_that_stands_its_moving_part():
    radar = build_radar([(0, 0, 0)], [(0, 0, 0)], num_samples=16, num_chirps=16)
    scene = ep.Scene()
    turning(scene, "mill", 0.2, 0.0, position=(50.0, 0.0, 0.0))
    scene.add(arm(0.16), name="other", parent="mill", material="metal", yaw=pi)
    scene.add(arm(1.0), name="gate", material="metal", position=(20.0, 0.0, 0.0))
    scene.add(arm(1.0), name="leaf", parent="gate", material="metal", motion=ep.LinearMotion(velocity=(4.5, 0.0, 0.0)))
    mill, leaf = bodies_faster_than(4.0, scene, radar, 0.0)
    assert (mill.name, mill.as_whole, leaf.name, leaf.as_whole) == ("mill", False, "gate/leaf", True)
    assert (mill.speed, leaf.speed) == (pytest.approx(-6.0, rel=0.01, abs=0), pytest.approx(4.5, rel=0.01, abs=0))


def test_what_is_far_slower_than_the_map_tells_is_looked_at_thrice(monkeypatch):
    """In the middle of a frame and at its ends, and not at the ten times of what may be too fast."""
    radar = build_radar([(0, 0, 0.5)], [(0, 0, 0.5)], num_samples=16, num_chirps=16)
    scene, looks = ep.Scene(), {}
    for name, speed in (("slow", 1.0), ("fast", 30.0)):
        scene.add(quad((9, -1, -1), (9, 1, -1), (9, 1, 1), (9, -1, 1)), name=name, material="metal",
                  motion=ep.LinearMotion((speed, 0.0, 0.0)))

    def count(meshes, *others):
        looks.update({mesh.name: looks.get(mesh.name, 0) + 1 for mesh in meshes})
        return ways(meshes, *others)

    ways = closing_speeds_module._ways
    monkeypatch.setattr(closing_speeds_module, "_ways", count)
    (body,) = bodies_faster_than(20.0, scene, radar, 0.0)
    assert body.name == "fast" and looks == {"slow": 4, "fast": 12}


def test_of_a_car_that_the_map_tells_only_the_wheels_are_named():
    """At 12 m/s the tops of the wheels go 24 m/s, and beyond +- 16 m/s velocities fold; at 20 m/s all of the car does."""
    radar = build_radar([(0, 0, 0.5)], [(0, 0, 0.5)], num_samples=16, num_chirps=16)
    radar = radar.replace(waveform=radar.waveform.replace(
        chirp_interval=ep.speed_of_light / (4.0 * 16.0 * radar.waveform.start_frequency)))

    def told(speed: float) -> list[str]:
        scene = ep.Scene()
        scene.add(ep.actors.car(speed=speed), name="car", position=(40.0, 0.0, 0.0))
        return folded_velocities(scene, radar, 0.0)[1:]

    (wheels,), (car,) = told(12.0), told(20.0)
    name, *up_to, speed, _, _, _, shown, _ = wheels.split()
    assert (name, up_to) == ("car/wheel", ["up", "to"]) and 23.0 < float(speed) < 24.1 and -9.0 < float(shown) < -7.5
    name, speed, *_, shown, _ = car.split()
    assert name == "car" and float(speed) == pytest.approx(20.0, abs=0.1) and float(shown) == pytest.approx(-12.0, abs=0.3)
    assert not told(7.0)


def test_a_template_tells_what_it_makes():
    template = dataset.Template(TEMPLATE)
    made = template.settings
    for told in (repr(template), template._repr_html_(), "\n".join(describe_file(TEMPLATE))):
        assert str(made.scenes) in told and made.keep in told
    place, _ = next(iter(template.draw(0).values.items()))
    assert place in template._repr_html_() and place in "\n".join(describe_file(TEMPLATE))


def test_a_template_tells_how_many_values_it_does_not_list():
    busy = TEMPLATE.with_name("busy_street.toml")
    drawn, told = dataset.Template(busy).draw(0).values, describe_file(busy)
    listed = sum(line.split()[0] in drawn for line in told if line.strip())
    assert listed < len(drawn) and f"    and {len(drawn) - listed} more" in told


@pytest.mark.parametrize("written, told", [
    ("{unifrm = [1.0, 2.0]}", "yaw_deg.unifrm: unknown distribution; did you mean 'uniform'?"),
    ("{Uniform = [1.0, 2.0]}", "did you mean 'uniform'?"),
    ("{chioce = [1.0, 2.0], weights = [1, 2]}", "did you mean 'choice'?"),
    ("{normal = [0.0, 1.0], withn = [-1.0, 1.0]}", "yaw_deg.withn: unknown key of a distribution; normal takes normal, within"),
    ("{uniform = 3.0}", "yaw_deg.uniform: must be a list, got 3.0"),
    ("{uniform = [1.0, 2.0], normal = [0.0, 1.0]}", "yaw_deg: must be one distribution, got uniform and normal"),
    ("{gaussian = [0.0, 1.0]}", "distributions are uniform, log_uniform, normal, integer, choice")])
def test_a_misspelt_distribution_is_told_with_the_right_one(tmp_path, written, told):
    path = tmp_path / "crossing.toml"
    path.write_text("[dataset]\nscenes = 1\n[radar]\nyaw_deg = " + written + "\n")
    with pytest.raises(ValueError) as caught:
        dataset.Template(path).check(0)
    assert told in str(caught.value) and str(path) in str(caught.value)


def test_tables_of_names_are_no_distributions(tmp_path):
    path = tmp_path / "named.toml"
    path.write_text('[dataset]\nscenes = 1\n[labels]\nobjects = {choices = ["a"]}\n[parts.uniforms]\nnormal = "T . R"\n')
    table = dataset.Template(path).draw(0).table
    assert table["labels"]["objects"] == {"choices": ["a"]} and table["parts"]["uniforms"] == {"normal": "T . R"}


def test_info_tells_where_a_radar_that_drives_is_and_what_a_run_makes(tmp_path):
    """Along a line at 30 degrees with 10 m/s, from (1, 2) m on, 2 s after time 0."""
    path = tmp_path / "drive.toml"
    path.write_text('[radar]\nposition = [1.0, 2.0, 0.5]\nyaw_deg = 30.0\nspeed = 10.0\n' + SMALL_RADAR
                    + '[[objects]]\nname = "post"\nactor = "pole"\nposition = [60.0, 30.0, 0.0]\n'
                    + '[trace]\nnum_rays = 500\nstart_time = 2.0\n[labels]\n[truth]\n'
                    + '[sequence]\nframes = 5\ninterval = 0.25\nkeep = "labels"\n')
    told = "\n".join(describe_file(path))
    at = ep.load_scene(path).radar.middle_of_frame(2.0)
    place = f"({1.0 + 10.0 * at * 0.75 ** 0.5:.6g}, {2.0 + 5.0 * at:.6g}, 0.5) m, yaw 30 deg, pitch 0 deg, 10 m/s, at {at:.4g} s"
    assert place in told
    for words in ("5, every 0.25 s", "2 to 3 s", "labels, truth"):
        assert words in told
    path.write_text(path.read_text().split("[labels]")[0].replace("speed = 10.0", ""))
    told = "\n".join(describe_file(path))
    assert "(1, 2, 0.5) m, yaw 30 deg, pitch 0 deg\n" in told and "frames in time" not in told and "results" not in told
