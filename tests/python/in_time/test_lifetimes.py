"""Vehicles come and go while frames follow each other: each is in the frames alone that its way covers wholly."""
from __future__ import annotations

import pickle
import warnings

import numpy as np
import pytest

import echopath as ep
from echopath.cli import main
from echopath.sequence.pictures import drive_of
from support.files.scene_text import ANTENNAS, WAVEFORM
from support.frames_in_time import make_radar

# Fronts of three cars of SUMO, by second: two drive at 2 m/s along lanes of their own, one passes behind them.
ROWS = {"early": (0, 2, -4.0), "late": (1, 4, 0.0), "through": (0, 4, 4.0)}  # {name: (first, last) s, y in m}
START, SPEED = 9.0, 2.0  # m, m/s
FRAMES, INTERVAL = 9, 0.5
ROUGH = ep.Material(reflectivity=0.3, scattering=1.0)


def fcd() -> str:
    steps = []
    for second in range(5):
        rows = [f'<vehicle id="{name}" x="{START + SPEED * second}" y="{y}" angle="90" type="car" speed="{SPEED}"/>'
                for name, (first, last, y) in ROWS.items() if first <= second <= last]
        steps.append(f'<timestep time="{second}.00">{"".join(rows)}</timestep>')
    return f"<fcd-export>{''.join(steps)}</fcd-export>"


def there(time: float, duration: float, goes_on: float = 0.0) -> list[str]:
    """The names of those whose rows reach over a frame."""
    return [name for name, (first, last, _) in ROWS.items()
            if first - goes_on <= time + 1e-9 and time + duration <= last + goes_on + 1e-9]


def street(path, **ends) -> ep.Scene:
    path.write_text(fcd())
    scene = ep.Scene()
    for name, trajectory in ep.read_trajectories(path, **ends).items():
        scene.add(ep.actors.box((4.0, 1.8, 1.5)), name=name, material=ROUGH, motion=trajectory)
    return scene


def drive(scene: ep.Scene, **settings) -> ep.Sequence:
    given = {"frames": FRAMES, "interval": INTERVAL, "num_rays": 2000, "guard": False, "labels": True, "truth": True}
    return ep.Sequence(scene, make_radar(), **given | settings)


@pytest.mark.parametrize("ends", [{}, {"goes_on": 0.7}, {"outside": "stands"}])
def test_frames_have_those_alone_whose_rows_reach_over_them(tmp_path, ends):
    sequence = drive(street(tmp_path / "fcd.xml", **ends))
    for time, frame in zip(sequence.times, sequence):
        duration = frame.radar.frame_duration
        wanted = list(ROWS) if "outside" in ends else there(time, duration, ends.get("goes_on", 0.0))
        assert sorted(frame.truth.name) == sorted(wanted)
        assert sorted(one.name for one in frame.labels["parts"].objects) == sorted(wanted)
        assert {name for name in ROWS if frame.scene[name].visible} == set(wanted)
        assert {mesh.name.split("/")[0] for mesh in frame.paths.scene.meshes} == set(wanted)
        if "outside" not in ends:  # the middle of a SUMO vehicle lies half a length behind its front
            middles = START + SPEED * (time + 0.5 * duration) - 0.5 * 4.3
            assert frame.truth.origin[:, 0] == pytest.approx(middles, abs=1e-5)


def test_a_frame_is_as_if_what_is_absent_had_never_been(tmp_path):
    """The last object of the scene, so that the random numbers of the others are the same without it, too."""
    scene = street(tmp_path / "fcd.xml")
    assert list(scene)[0] == "early" and scene.meshes[-1].name == "late"
    without = scene.copy()
    without.remove("late")
    with_late, bare = drive(scene)[1], drive(without)[1]  # at 0.5 s
    assert with_late.truth.name.tolist() == bare.truth.name.tolist()
    assert np.array_equal(with_late.cube, bare.cube) and np.abs(bare.cube).max() > 0.0
    assert not np.array_equal(drive(scene)[5].cube, drive(without)[5].cube)


def test_frames_alone_have_the_bits_of_the_run_and_of_simulate(tmp_path):
    scene = street(tmp_path / "fcd.xml")
    sequence = drive(scene)
    for place, frame in enumerate(sequence):
        assert np.array_equal(frame.cube, sequence[place].cube)
    one = ep.simulate(scene, make_radar(), start_time=sequence.times[7], num_rays=2000, scatterers="surface", guard=False,
                      labels=True)
    assert np.array_equal(one.cube, sequence[7].cube) and not one.scene["early"].visible
    assert scene["early"].visible and sequence.scene["early"].visible  # what is simulated stays as it is


def test_the_points_of_rough_surfaces_stay_where_another_body_before_them_comes_and_goes():
    """What is always there has its part of the rays, whether or not what comes and goes is there."""
    scene = ep.Scene()
    scene.add(ep.actors.plate(2.0, 2.0), name="guest", material=ROUGH, position=(14.0, -4.0, 0.0), yaw=np.pi)
    scene.add(ep.actors.plate(2.0, 2.0), name="host", material=ROUGH, position=(10.0, 2.0, 0.0), yaw=np.pi)
    scene["guest"].lifetime = 0.4, np.inf
    alone, beside = drive(scene, frames=2, num_rays=4000)

    def points(frame) -> set:
        chosen = frame.paths.select("T 'host' R")
        chosen = chosen.select(chosen.diffuse > 0)
        hits = chosen.hits[chosen.offsets]
        return {(int(hit["triangle_id"]), round(float(hit["u"]), 5), round(float(hit["v"]), 5)) for hit in hits}

    assert [len(frame.paths.scene.meshes) for frame in (alone, beside)] == [1, 2]
    assert len(points(alone)) > 100
    assert len(points(beside) ^ points(alone)) < 0.02 * len(points(alone))  # those next to an edge, as the radar goes on


@pytest.mark.parametrize("start, is_there", [(0.1 * 3, True), (0.3, True), (0.3 - 1e-6, False), (0.5, True)])
def test_a_frame_that_begins_with_the_lifetime_but_for_rounding_is_in_it(start, is_there):
    scene = ep.Scene()
    scene.add(ep.actors.plate(2.0, 2.0), name="plate", material="metal", position=(10.0, 0.0, 0.0), yaw=np.pi)
    radar = make_radar()
    scene["plate"].lifetime = 0.3, 0.5 + radar.frame_duration
    paths = ep.trace(scene, radar, start_time=start, num_rays=500) if is_there else None
    if not is_there:
        with pytest.warns(RuntimeWarning, match="'plate' is absent from 0.299999 to"):
            paths = ep.trace(scene, radar, start_time=start, num_rays=500)
    assert (paths.num_paths > 0) == is_there


def test_what_enters_where_the_radar_stood_at_first_is_an_object():
    """Before it is there it stands at the begin of its way, about the antenna, and does not surround it."""
    scene = ep.Scene()
    way = ep.Trajectory([(0.0, 0.0), (40.0, 0.0)], speed=20.0, start_time=1.0, outside="absent")
    scene.add(ep.actors.box((4.0, 1.8, 1.5)), name="car", material="metal", motion=way)
    frame = drive(scene, start_time=0.0, frames=4)[3]
    assert frame.truth.name.tolist() == ["car"] == [one.name for one in frame.labels["parts"].objects]


def test_a_motion_is_asked_for_nothing_where_its_object_is_absent():
    scene, short = ep.Scene(), ep.KeyframeMotion([0.9, 2.1], translations=[(0, 0, 0), (1, 0, 0)])
    scene.add(ep.actors.plate(2.0, 2.0), name="plate", material="metal", position=(10.0, 0.0, 0.0), yaw=np.pi, motion=short)
    with pytest.raises(ValueError, match="node plate"):
        drive(scene)
    scene["plate"].lifetime = 1.0, 2.1
    assert [frame.truth.name.tolist() for frame in drive(scene)] == [[], [], ["plate"], ["plate"], ["plate"], [], [], [], []]


@pytest.mark.parametrize("keep", ["all", "maps"])
def test_files_of_a_run_know_who_was_there(tmp_path, keep):
    sequence = drive(street(tmp_path / "fcd.xml"))
    for where in ("drive", "drive.h5"):
        stored = sequence.save(tmp_path / where, keep=keep)
        assert stored.scene["late"].lifetime == (1.0, 4.0) and stored.scene["late"].visible
        rows = {(int(frame), str(name)) for frame, name in zip(stored.truth.frame, stored.truth.name)}
        duration = sequence.radar.frame_duration
        assert rows == {(place, name) for place, time in enumerate(sequence.times) for name in there(time, duration)}
        named = stored.to_xarray()
        assert np.isnan(named.truth_range.sel(truth_object="late")[:2]).all()
    if keep == "all":
        loaded = ep.load_sequence(tmp_path / "drive")[0]
        assert not loaded.scene["late"].visible and loaded.scene["late"].lifetime == (1.0, 4.0)
        assert np.array_equal(loaded.cube, sequence[0].cube)


@pytest.mark.usefixtures("blank_pictures")
def test_scene_files_and_the_command_line_do_the_same(tmp_path):
    (tmp_path / "fcd.xml").write_text(fcd())
    parts = "\n".join(f"""[[objects]]
name = "{name}"
actor = "box"
parameters = {{size = [4.0, 1.8, 1.5]}}
material = {{reflectivity = 0.3, scattering = 1.0}}
trajectory = "fcd.xml"
id = "{name}"
{more}""" for name, more in (("early", "goes_on = 0.7"), ("late", ""), ("through", 'outside = "stands"')))
    path = tmp_path / "street.toml"
    path.write_text(WAVEFORM + ANTENNAS + parts + "\n[trace]\nnum_rays = 500\n[truth]\n[labels]\n")
    scene = ep.load_scene(path).scene
    assert [scene[name].lifetime for name in ROWS] == [(-0.7, 2.7), (1.0, 4.0), None]
    assert main(["run", str(path), "--out", str(tmp_path / "out"), "--frames", "6", "--interval", "1.0"]) == 0
    stored = ep.load_sequence(tmp_path / "out")
    found = [stored.truth.of_frame(place).name.tolist() for place in range(6)]
    assert found == [["early", "through"], ["early", "late", "through"], ["early", "late", "through"], ["late", "through"],
                     ["through"], ["through"]]


@pytest.mark.parametrize("lines, message", [
    ("goes_on = 1.0\nspeed = 1.0", "goes_on: needs a trajectory that is a file"),
    ('outside = "stands"', "outside: needs a trajectory that is a file"),
    ('trajectory = "fcd.xml"\nid = "late"\ngoes_on = -1.0', "goes_on: must be"),
    ('trajectory = "fcd.xml"\nid = "late"\noutside = "gone"', "outside: must be 'stands' or 'absent'"),
])
def test_keys_of_scene_files_are_checked(tmp_path, lines, message):
    (tmp_path / "fcd.xml").write_text(fcd())
    path = tmp_path / "street.toml"
    path.write_text(WAVEFORM + ANTENNAS + f"""[[objects]]
name = "car"
actor = "car"
{lines}
""")
    with pytest.raises(ValueError) as fault:
        ep.load_scene(path)
    assert f"objects[0].{message}" in str(fault.value)


def test_a_run_that_nobody_takes_part_in_is_told(tmp_path):
    scene = street(tmp_path / "fcd.xml")
    with pytest.warns(RuntimeWarning, match="'early', 'through', 'late' are absent from 10 to 14.* from 0 to 4 s alone"):
        drive(scene, start_time=10.0)


def test_live_scenes_show_what_is_there(tmp_path):
    scene = street(tmp_path / "fcd.xml")
    live = ep.Live(scene, make_radar(), num_rays=2000, start_time=0.5)
    live.update()
    assert {mesh.name.split("/")[0] for mesh in live.paths().scene.meshes} == {"early", "through"}
    live.scene["late"].lifetime = None
    live.update()
    assert "late" in {mesh.name.split("/")[0] for mesh in live.paths().scene.meshes}


def screen_before_a_plate() -> ep.Scene:
    """A screen, which comes first, hides a plate wholly for 1 s."""
    scene = ep.Scene()
    for name, distance, side in (("screen", 10.0, 4.0), ("plate", 20.0, 2.0)):
        scene.add(ep.actors.plate(side, side), name=name, material=ROUGH, position=(distance, 0.0, 0.0), yaw=np.pi)
    scene["screen"].lifetime = 0.0, 1.0
    return scene


@pytest.mark.parametrize("time, shares", [(0.5, {"screen": 1.0, "plate": 0.0}), (1.0, {"screen": 1.0, "plate": 0.0}),
                                          (1.5, {"plate": 1.0})])
def test_what_is_absent_hides_nothing_and_is_not_looked_at(time, shares):
    scene = screen_before_a_plate()
    seen = ep.visibility(scene, make_radar(), time=time, num_directions=256)
    assert {one.name: one.visible_share for one in seen} == shares
    assert {one.name: one.mesh_ids for one in seen} == {name: (number,) for number, name in enumerate(shares)}
    named = ep.visibility(scene, make_radar(), ["screen", "plate"], time=time, num_directions=256)
    assert [one.name for one in named] == list(shares) and scene["screen"].visible


def test_objects_are_found_whenever_they_are_there():
    """A scene file looks for them at the first frame, and labels all."""
    assert ep.find_objects(screen_before_a_plate(), make_radar(), time=9.0) == {"screen": "screen", "plate": "plate"}


@pytest.mark.parametrize("start, names", [(0.5, {"screen", "plate"}), (1.5, {"plate"})])
def test_pictures_show_what_is_there_in_the_frame_of_the_rays(start, names):
    scene = screen_before_a_plate()
    paths = ep.trace(scene, make_radar(), start_time=start, num_rays=500)
    for shown in (scene, paths.scene):
        figure = ep.plots.plot_scene(shown, paths)
        assert {text.get_text().strip() for text in figure.axes[1].texts} & {"screen", "plate"} == names


def test_lifetimes_travel_and_follow_the_motion(tmp_path):
    scene = street(tmp_path / "fcd.xml")
    for again in (scene.copy(), pickle.loads(pickle.dumps(scene)), ep.Scene(scene)):
        assert [again[name].lifetime for name in ROWS] == [(0.0, 2.0), (1.0, 4.0), (0.0, 4.0)]
    scene["late"].motion = ep.LinearMotion((1.0, 0.0, 0.0))
    scene["early"].motion = ep.Trajectory([(0, 0), (1, 0)], speed=1.0, outside="absent")
    assert scene["late"].lifetime is None and scene["early"].lifetime == (0.0, 1.0)
    scene["late"].lifetime = 3.0, np.inf
    assert scene["late"].lifetime == (3.0, np.inf)
    for wrong in ((2.0, 1.0), (np.nan, 1.0), (1.0, 1.0)):
        with pytest.raises(ValueError, match=r"lifetime: must be \(begin, end\) in s, ascending, or None, got"):
            scene["late"].lifetime = wrong
    assert ep.Lane([(0, 0), (9, 0)]).trajectory(speed=3.0, outside="absent", goes_on=1.0).lifetime == (-1.0, 4.0)


def parked(lifetime) -> ep.Scene:
    """A van before a plate, which drives off when its lifetime begins, on a way that is known then alone."""
    scene = ep.Scene()
    scene.add(ep.actors.plate(1.0, 1.0), name="plate", material="metal", position=(14.0, 0.0, 0.0), yaw=np.pi)
    scene.add(ep.actors.box((2.0, 3.0, 3.0)), name="van", material="metal", position=(7.0, 0.0, 0.0),
              motion=ep.KeyframeMotion(lifetime, translations=[(0.0, 0.0, 0.0), (0.0, 9.0, 0.0)]))
    scene["van"].lifetime = lifetime
    return scene


def test_what_is_absent_is_no_corner_and_stands_behind_none():
    scene, radar = parked((1.0, 2.0)), make_radar()
    assert ep.around_corners(scene, radar, time=0.5, num_rays=500) == []
    assert [one.name for one in ep.around_corners(scene, radar, time=1.01, num_rays=500)] == ["plate"]


def test_a_film_of_a_radar_that_drives_knows_what_moved_in_each_frame():
    drive_ahead = ep.LinearMotion((1.0, 0.0, 0.0))
    sequence = ep.Sequence(parked((1.0, 2.0)), make_radar().replace(motion=drive_ahead), frames=4, interval=0.5, num_rays=500,
                           guard=False)
    assert [len(rows) for rows in drive_of(sequence).driving.movers] == [0, 0, 1, 1]


def test_other_radars_are_heard_without_a_word_of_what_is_absent(recwarn):
    radar = make_radar()
    scene = parked((0.4, 2.0))
    scene.interferers = [ep.Interferer(radar=radar.replace(position=(20.0, 0.0, 0.0), yaw=np.pi))]
    assert all("interference" in frame.beside_spectra for frame in drive(scene, frames=2))
    scene["van"].visible = False
    ep.trace(scene, radar, num_rays=500)
    assert not [str(warning.message) for warning in recwarn if "absent" in str(warning.message)]


def test_what_is_absent_hides_no_rain():
    """A screen right before the radar, and a motion that is not made for the frames without it."""
    scene = ep.Scene(weather=ep.Weather(rain_mm_per_hour=50.0))
    screen = ep.Mesh([(0.5, -9.0, -9.0), (0.5, 9.0, -9.0), (0.5, 9.0, 9.0), (0.5, -9.0, 9.0)], [(0, 1, 2), (0, 2, 3)])
    still = ep.KeyframeMotion(times=[1.0, 2.0], translations=np.zeros((2, 3)), rotations=[(1.0, 0.0, 0.0, 0.0)] * 2)
    scene.add(ep.actors.box((1.0, 1.0, 1.0)), name="box", material=ROUGH, position=(9.0, 0.0, 0.0))
    scene.add(screen, name="screen", material="metal", motion=still)
    scene["screen"].lifetime = (1.0, 2.0)
    without = scene.copy()
    without.remove("screen")
    given = {"labels": False, "truth": False, "frames": 3, "interval": 0.6}
    absent, there, bare = drive(scene, **given)[0], drive(scene, **given)[2], drive(without, **given)
    assert np.abs(absent.rain_cube).max() > 0.0
    np.testing.assert_array_equal(absent.rain_cube, bare[0].rain_cube)
    assert not np.array_equal(there.rain_cube, bare[2].rain_cube)


def test_info_tells_who_comes_and_goes_and_no_overlaps_of_those_that_are_absent(tmp_path, capsys):
    """Two cars depart from one place, one behind the other."""
    (tmp_path / "fcd.xml").write_text(fcd().replace('x="11.0" y="0.0"', 'x="9.0" y="-4.0"'))
    parts = "\n".join(f'[[objects]]\nname = "{name}"\nactor = "box"\nparameters = {{size = [4, 2, 2]}}\ntrajectory = "fcd.xml"\n'
                      f'id = "{name}"\nmaterial = "metal"\n'
                      for name in ("early", "late"))
    path = tmp_path / "street.toml"
    path.write_text(WAVEFORM + ANTENNAS + parts + "\n[trace]\nnum_rays = 500\n")
    assert ep.load_scene(path).scene.coplanar_overlaps(time=0.0)
    assert main(["info", str(path)]) == 0
    told = capsys.readouterr().out
    assert "'early', 'late'; in the frame at 0 s: 'late' absent" in told
    assert "surfaces on each other            none" in told


def test_a_lifetime_set_by_hand_stays_when_the_motion_changes():
    """One that a trajectory has brought goes with it."""
    way = ep.Trajectory([(0.0, 0.0), (1.0, 0.0)], speed=1.0, outside="absent")
    scene = parked((1.0, 2.0))
    scene["van"].motion = None
    assert scene["van"].lifetime == (1.0, 2.0)
    scene["van"].motion = way
    assert scene["van"].lifetime == (0.0, 1.0)
    scene["van"].motion = ep.LinearMotion((1.0, 0.0, 0.0))
    assert scene["van"].lifetime is None
    scene["van"].motion = way
    scene["van"].lifetime = 0.5, 3.0
    scene["van"].motion = None
    assert scene["van"].lifetime == (0.5, 3.0)


def test_lifetimes_have_one_rule_wherever_they_are_set():
    for empty in ((1.0, 1.0), (2.0, 1.0)):
        told = rf"lifetime: must be \(begin, end\) in s, ascending, or None, got \[{empty[0]}, {empty[1]}\]$"
        with pytest.raises(ValueError, match=told):
            screen_before_a_plate()["screen"].lifetime = empty
        with pytest.raises(ValueError, match=told):
            screen_before_a_plate().nodes[0].replace(lifetime=empty)


def test_lifetimes_of_carriers_and_of_what_they_carry_are_joined():
    scene = ep.Scene()
    scene.add(name="ship")
    scene.add(ep.actors.plate(1.0, 1.0), name="mast", parent="ship", material="metal", position=(9.0, 0.0, 0.0))
    scene["ship"].lifetime, scene["ship/mast"].lifetime = (0.0, 5.0), (-np.inf, 3.0)
    assert [scene._lifetime(index) for index in range(len(scene))] == [(0.0, 5.0), (0.0, 3.0)]
    scene["ship"].lifetime = None
    assert scene._lifetime(1) == (-np.inf, 3.0)


def test_cross_sections_are_of_what_is_there_at_time_0():
    """The van before the plate comes later: the plate has 4 pi A^2 / wavelength^2 at normal incidence."""
    scene, frequency = parked((1.0, 2.0)), 10e9
    plate = ep.rcs(scene, frequency=frequency, incidence=(-1.0, 0.0, 0.0))
    assert plate == pytest.approx(4.0 * np.pi * (frequency / ep.speed_of_light) ** 2, rel=0.02)
    scene["van"].motion, scene["van"].lifetime = None, (-1.0, 2.0)
    assert ep.rcs(scene, frequency=frequency, incidence=(-1.0, 0.0, 0.0)) != pytest.approx(plate, rel=0.2)


@pytest.mark.parametrize("lifetime, is_told", [((0.1, 0.3), True), ((0.1, 0.5), True), ((0.1, 0.6), False), ((-0.2, 0.3), False)])
def test_who_is_there_between_frames_alone_is_named(lifetime, is_told):
    """Frames every 0.5 s, each of some ms."""
    scene = parked((0.0, 3.0))
    scene.add(ep.actors.plate(1.0, 1.0), name="guest", material="metal", position=(9.0, 3.0, 0.0))
    scene["guest"].lifetime = lifetime
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        sequence = drive(scene, labels=None, truth=None)
    told = [str(one.message) for one in caught if "between" in str(one.message)]
    assert bool(told) == is_told and len(told) < 2 and all("'guest' comes and goes between" in one for one in told)
    there = [bool(sequence[place].scene["guest"].visible) for place in (0, 1)]
    assert there == [lifetime[0] < 0.0, lifetime == (0.1, 0.6)]
