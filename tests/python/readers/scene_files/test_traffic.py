"""Traffic of scene files: everybody of a file of SUMO is where its rows say, as what they say, as long as they say."""
import gzip
import math

import numpy as np
import pytest

import echopath as ep
from support.files.scene_text import ANTENNAS, WAVEFORM

HALF = {"passenger": 4.3 / 2, "truck_heavy": 16.6 / 2, "bus_city": 5.95 / 2, "pt_van": 4.95 / 2, "motorcycle": 1.0,
        "DEFAULT_BIKETYPE": 1.95 / 2}  # m, from the middle of the usual body to its front
TYPES = [*HALF, *["passenger"] * 11]  # of 17 vehicles, beside 3 persons
STEP = 0.25  # s
PLACE = 500.0, -300.0  # m, of the crossing in the network
HERE = f"position = [{-PLACE[0]}, {-PLACE[1]}, 0.0]"
FRONT_TOLERANCE = 0.03  # m: the lengths of the bodies are rounded
ANGLE_TOLERANCE = 1e-5  # rad: curves err by less than 4 microradians
TOLERANCE = 2e-4  # m: rows have four digits behind the point


def rows():
    """[(time in s, id, type or None of a person, x, y in m of the front or the person, angle in degrees from north clockwise)]:
    vehicles drive straight on from a square of places, number i into the direction of 20 i degrees, from time i / 10 s on."""
    found = []
    for number, kind in enumerate(TYPES):
        angle = 20.0 * number
        ahead = np.array([math.sin(math.radians(angle)), math.cos(math.radians(angle))])
        for step in range(9):
            front = np.array(PLACE) + [40.0 * (number % 5), 40.0 * (number // 5)] + (5.0 + 6.0 * step * STEP) * ahead
            found.append((number // 4 * STEP + step * STEP, f"flow/{number}", kind, *front, angle))
    for number in range(3):  # the last one waits
        for step in range(9):
            y = PLACE[1] - 20.0 + (1.25 * step * STEP if number < 2 else 0.0)
            found.append((step * STEP, f"walker{number}", None, PLACE[0] - 20.0 + 4.0 * number, y, 0.0))
    return sorted(found, key=lambda row: row[0])


def fcd() -> str:
    text, last = "", None
    for time, name, kind, x, y, angle in rows():
        if time != last:
            text, last = text + ("</timestep>" if text else "") + f'\n<timestep time="{time:.2f}">\n', time
        tag, of_kind = ("person", 'type="DEFAULT_PEDTYPE"') if kind is None else ("vehicle", f'type="{kind}"')
        text += f'<{tag} id="{name}" x="{x:.4f}" y="{y:.4f}" angle="{angle:.2f}" {of_kind} speed="1.00"/>\n'
    return f"<fcd-export>{text}</timestep></fcd-export>"


SCENE = "[radar]\n" + WAVEFORM + ANTENNAS + """
[[objects]]
name = "ground"
actor = "ground"
parameters = {size = [20, 20]}
material = "asphalt"
[[traffic]]
file = "fcd.xml.gz"
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("traffic")
    with gzip.open(path / "fcd.xml.gz", "wt") as file:
        file.write(fcd())
    return path


@pytest.fixture(scope="module")
def load(folder):
    def loaded(more: str = HERE, radar: str = "") -> ep.SceneFile:
        path = folder / "scene.toml"
        path.write_text(SCENE.replace("[radar]\n", f"[radar]\n{radar}\n", 1) + more)
        return ep.load_scene(path)
    return loaded


@pytest.fixture(scope="module")
def scene(load):
    return load().scene


def own_axes(scene, name: str, time: float) -> np.ndarray:
    """Vertices of an object in the axes in which it looks along +x: by its motion alone, whatever it is made of."""
    points = np.concatenate([scene.world_vertices(mesh.id, time) for mesh in scene.meshes if mesh.name.startswith(f"{name}/")])
    pose = scene[name].motion.at(time)
    return (points - pose[:3, 3]) @ pose[:3, :3]


def test_everybody_is_there_once_behind_the_objects(scene):
    names = list(dict.fromkeys(mesh.name.split("/")[0] for mesh in scene.meshes))
    assert names[0] == "ground" and len(names) == 21
    assert set(names[1:]) == {name.replace("/", "_") for _, name, *_ in rows()}


def test_everybody_stands_and_looks_as_the_rows_say(scene):
    for time, name, kind, x, y, angle in rows():
        pose = scene[name.replace("/", "_")].motion.at(time)
        yaw = math.radians(90.0 - angle)
        back = HALF.get(kind, 0.0)
        np.testing.assert_allclose(pose[:2, 3], [x - PLACE[0] - back * math.cos(yaw), y - PLACE[1] - back * math.sin(yaw)],
                                   rtol=0, atol=TOLERANCE)
        np.testing.assert_allclose(pose[:2, 0], [math.cos(yaw), math.sin(yaw)], rtol=0, atol=ANGLE_TOLERANCE)


def test_bodies_are_those_of_their_types_with_their_fronts_in_place(scene):
    heights = {"passenger": (1.3, 1.7), "truck_heavy": (3.5, 4.2), "bus_city": (2.2, 3.2), "pt_van": (1.7, 2.2),
               "motorcycle": (1.5, 1.9), "DEFAULT_BIKETYPE": (1.6, 2.0)}
    for number, kind in enumerate(HALF):
        name, begin = f"flow_{number}", number // 4 * STEP
        points = own_axes(scene, name, begin + 1.0)
        assert points[:, 0].max() == pytest.approx(HALF[kind], abs=FRONT_TOLERANCE), kind
        assert heights[kind][0] < points[:, 2].max() < heights[kind][1], kind
    own = {mesh.name for mesh in scene.meshes}
    assert any(name.startswith("flow_1/trailer/") for name in own) and "walker1/leg_left/foot" in own


def test_everybody_is_there_between_first_and_last_row_alone(scene):
    times = {}
    for time, name, *_ in rows():
        times.setdefault(name.replace("/", "_"), []).append(time)
    for name, own in times.items():
        assert scene[name].lifetime == (min(own), max(own))


def test_one_who_waits_all_the_time_stands_still(scene):
    before, after = (own_axes(scene, "walker2", time) for time in (0.2, 1.7))
    np.testing.assert_allclose(before, after, rtol=0, atol=1e-9)
    assert np.isfinite(before).all() and before[:, 2].max() > 1.6
    assert np.abs(own_axes(scene, "walker0", 0.2) - own_axes(scene, "walker0", 0.7)).max() > 0.1


def test_the_file_is_turned_about_its_origin_and_then_moved(load, scene):
    turned = load("position = [7.0, 8.0, 0.5]\nyaw_deg = 90.0").scene
    for name in ("flow_3", "walker1"):
        here, there = (one[name].motion.at(1.5) for one in (scene, turned))
        x, y = here[:2, 3] + PLACE
        np.testing.assert_allclose(there[:3, 3], [7.0 - y, 8.0 + x, 0.5], rtol=0, atol=TOLERANCE)
        np.testing.assert_allclose(there[:2, 0], [-here[1, 0], here[0, 0]], rtol=0, atol=ANGLE_TOLERANCE)


def test_some_are_left_out_by_name_by_time_and_by_type(load):
    def names(more: str) -> set:
        return {mesh.name.split("/")[0] for mesh in load(f"{HERE}\n{more}").scene.meshes} - {"ground"}

    assert names('exclude = ["flow/1*", "walker?"]') == {"flow_0", *(f"flow_{number}" for number in range(2, 10))}
    assert names("during = [2.3, 9.0]") == {f"flow_{number}" for number in range(8, 17)}  # others end at 2.25 s
    assert names('actors = {"*_*" = false, "passenger" = false}') == {"flow_4"}


def test_types_become_the_actors_that_are_asked_for_with_their_fronts_in_place(load):
    actors = '"PASS*" = {actor = "van", parameters = {kind = "large"}}\ntruck_heavy = "motorcycle"'
    changed = load(f"{HERE}\n[traffic.actors]\n{actors}")
    points = own_axes(changed.scene, "flow_0", 1.0)
    assert points[:, 2].max() > 2.2  # of a large van
    for time, name, _, x, y, angle in rows():
        if name in ("flow/0", "flow/1") and time > 0.5:
            node = name.replace("/", "_")
            world = np.concatenate([changed.scene.world_vertices(mesh.id, time) for mesh in changed.scene.meshes
                                    if mesh.name.startswith(f"{node}/")])
            ahead = [math.sin(math.radians(angle)), math.cos(math.radians(angle))]
            assert (world[:, :2] @ ahead).max() == pytest.approx(np.subtract((x, y), PLACE) @ ahead, abs=FRONT_TOLERANCE)


def test_the_radar_rides_on_one_of_the_vehicles(load, scene):
    """The mount is 2 m ahead of the middle, 0.3 m to its left and 0.5 m up, and looks to the right by 30 degrees."""
    loaded = load(f'{HERE}\nexclude = ["flow/7"]', 'rides_on = "flow/7"\nposition = [2.0, 0.3, 0.5]\nyaw_deg = -30.0')
    assert "flow_7" not in loaded.scene
    for time in (0.25, 1.1, 2.0):
        pose, car = loaded.radar.world_from_radar(time), scene["flow_7"].motion.at(time)
        np.testing.assert_allclose(pose[:3, 3], car[:3, 3] + car[:3, :3] @ [2.0, 0.3, 0.5], rtol=0, atol=TOLERANCE)
        ahead = math.radians(90.0 - 20.0 * 7 - 30.0)
        np.testing.assert_allclose(pose[:2, 0], [math.cos(ahead), math.sin(ahead)], rtol=0, atol=ANGLE_TOLERANCE)


def test_a_mount_swings_with_the_yaw_of_what_carries_it():
    """On a circle of radius r about the origin, a place a ahead of the middle is on a circle of radius hypot(r, a)."""
    angles = np.linspace(0.0, 3.0, 61)
    circle = ep.Trajectory(20.0 * np.stack([np.cos(angles), np.sin(angles)], axis=-1), times=2.0 * angles, yaw=angles + np.pi / 2)
    mount = circle.motion((3.0, 0.0, 0.7))
    for time in np.linspace(0.5, 5.5, 17):
        at = mount.at(time)
        np.testing.assert_allclose(at[:3, 3], (circle.at(time) @ [3.0, 0.0, 0.7, 1.0])[:3], rtol=0, atol=1e-5)
        assert np.hypot(*at[:2, 3]) == pytest.approx(math.hypot(20.0, 3.0), abs=1e-3)
    steep = ep.Trajectory([(0, 0, 0), (30, 0, 0), (30, 30, 12)], turn_radius=None, speed=5, pitch=True)
    for time in np.linspace(0.5, 9.0, 7):
        place = np.array([1.5, -0.4, 0.9])
        np.testing.assert_allclose(steep.motion(place).at(time)[:3, 3], (steep.at(time) @ [*place, 1.0])[:3], rtol=0, atol=2e-5)


@pytest.mark.parametrize("more", ["", 'actors = {"lorry*" = "truck"}'])
def test_a_radar_that_rides_on_a_truck_stays_before_its_bumper(tmp_path, more):
    """A table without yaws, whose truck turns by a quarter on 12 m."""
    angles = np.linspace(0.0, 0.5 * math.pi, 20)
    way = [(x, 0.0) for x in np.linspace(0.0, 38.0, 20)]
    way += [(40.0 + 12.0 * math.sin(angle), 12.0 - 12.0 * math.cos(angle)) for angle in angles]
    way += [(52.0, y) for y in np.linspace(14.0, 40.0, 14)]
    kind = "lorry_5" if more else "truck_5"
    times = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(way, axis=0).T))]) / 6.0
    (tmp_path / "way.csv").write_text("time,id,type,x,y\n" + "".join(
        f"{time},t,{kind},{x},{y}\n" for time, (x, y) in zip(times, way)))
    (tmp_path / "scene.toml").write_text('[radar]\nrides_on = "t"\nposition = [8.4, 0.0, 0.6]\n' + WAVEFORM + ANTENNAS
                                         + f'[[traffic]]\nfile = "way.csv"\n{more}\n')
    loaded = ep.load_scene(tmp_path / "scene.toml")
    bumper = next(mesh for mesh in loaded.scene.meshes if mesh.name == "t/cab/bumper")
    for time in np.linspace(1.0, times[-1] - 1.0, 12):
        pose = loaded.radar.world_from_radar(time)
        own = (loaded.scene.world_vertices(bumper.id, time) - pose[:3, 3]) @ pose[:3, :3]
        assert own[:, 0].max() == pytest.approx(8.25 - 8.4, abs=0.1) and abs(own[:, 1].mean()) < 1e-3


def test_who_cannot_follow_is_told_with_the_name():
    with pytest.raises(ValueError, match=r"^trajectories\['tom'\]: trajectory: must be one of at most .* for a dog"):
        ep.add_traffic(ep.Scene(), {"tom": ep.Trajectory([(0, 0), (90, 0)], speed=30, kind="dog")})


def test_persons_are_not_there_while_they_ride_in_a_vehicle(tmp_path):
    """Rows of persons in vehicles name the vehicle (sumo.dlr.de, "FCDOutput"): a walk to a stop, a ride, a walk from there."""
    rides = [None] * 3 + ["bus"] * 3 + [None] * 3
    text = "".join(f'<timestep time="{time}"><person id="ann" x="{x}" y="0" angle="90" speed="1"'
                   f'{"" if ride is None else f" vehicle={chr(34)}{ride}{chr(34)}"}/>'
                   f'<person id="rider" x="{x}" y="0" angle="90" speed="1" vehicle="bus"/></timestep>'
                   for time, (x, ride) in enumerate(zip([0, 1, 2, 20, 40, 60, 80, 81, 82], rides)))
    (tmp_path / "fcd.xml").write_text(f"<fcd-export>{text}</fcd-export>")
    found = ep.read_trajectories(tmp_path / "fcd.xml")
    assert {name: one.lifetime for name, one in found.items()} == {"ann": (0, 2), "ann_2": (6, 8)}
    np.testing.assert_allclose(found["ann_2"].position(7.0), [81, 0, 0], rtol=0, atol=1e-9)


@pytest.mark.parametrize("radar, more, words", [
    ("", 'exclude = ["ego"]', r"traffic\[0\]: exclude: must be globs of which each takes one of flow/0, .*, got 'ego'"),
    ("", 'actors = {"*" = "runner"}', r"traffic\[0\]: trajectories\['flow/0'\]: trajectory: must be one of at most"),
    ("", 'exclude = "ego"', r"traffic\[0\].exclude: must be an array, got 'ego'"),
    ("", "during = [3, 2]", r"traffic\[0\].during: must be \[begin, end\] in s"),
    ("", "excluded = []", r"traffic\[0\].excluded: unknown key; did you mean 'exclude'"),
    ("", "vehicle_length = -1", r"traffic\[0\].vehicle_length: must be a finite number from 0 to 100 m, got -1"),
    ("", 'actors = {bus = "buss"}', r"traffic\[0\].actors.bus: unknown actor 'buss'"),
    ("", 'actors = {bus = "tree"}', r"traffic\[0\].actors.bus: must be an actor that takes a trajectory .*, got 'tree'"),
    ("", "actors = {bus = true}",
     r"traffic\[0\].actors.bus: must be the name of an actor, a table of an actor or a model, or false: no object"),
    ("", 'actors = {bus = {actor = "van", parameters = {kin = "large"}}}',
     r"traffic\[0\].actors.bus.parameters.kin: unknown key; did you mean 'kind'"),
    ("", 'actors = {bus = {actor = "van", parameters = {kind = "huge"}}}', r"traffic\[0\].actors.bus.parameters: kind: must be"),
    ("", '[[objects]]\nname = "flow_3"\ngroup = true', r"traffic\[0\]: trajectories: must be of names that the scene does"),
    ('rides_on = "ego"', "", r"line 2: radar.rides_on: must be an id of the .*, which has flow/0, .* got 'ego'"),
    ('rides_on = "flow/0"\nspeed = 3', "", r"radar.rides_on: must not stand beside speed, got 'flow/0'")])
def test_wrong_traffic_is_refused_by_its_key(load, radar, more, words):
    with pytest.raises(ValueError, match=words):
        load(f"{HERE}\n{more}", radar)


def test_a_missing_file_of_traffic_is_told_with_its_key(folder, load):
    (folder / "other.toml").write_text(SCENE.replace("fcd.xml.gz", "gone.xml"))
    with pytest.raises(ep.FileError, match=r"other.toml: line 22: traffic\[0\].file: .*gone.xml: cannot be read"):
        ep.load_scene(folder / "other.toml")


def test_python_takes_actors_by_types_and_leaves_out_names(folder):
    found = ep.read_trajectories(folder / "fcd.xml.gz", position=(-PLACE[0], -PLACE[1], 0.0))
    scene = ep.Scene()
    made = ep.add_traffic(scene, found, actor_of={"truck*": "bicycle", "PASS*": None, "bus*": lambda name, one: ep.actors.cyclist(
        trajectory=one)}, exclude="walker*", during=(0.0, 0.2))
    assert list(made) == ["flow_1", "flow_2", "flow_3"]
    with pytest.warns(RuntimeWarning, match="^actor_of: lorry takes none of the kinds passenger, .* and 4 more"):
        ep.add_traffic(ep.Scene(), found, actor_of={"TRUCK*": "bicycle", "lorry": None}, during=(0.0, 0.2))
    names = {mesh.name for mesh in scene.meshes}
    assert "flow_1/wheel_front/tyre" in names and any(name.startswith("flow_2/rider/") for name in names)


@pytest.mark.parametrize("argument, value", [
    ("exclude", 5), ("exclude", [""]), ("exclude", ["nobody"]), ("during", (2, 1)), ("during", 3), ("actor_of", {"a": 5}),
    ("actor_of", {"a": "tree"})])
def test_wrong_arguments_of_traffic_are_named(argument, value):
    with pytest.raises((TypeError, ValueError), match=rf"^{argument}(\['a'\])?: must be"):
        ep.add_traffic(ep.Scene(), {"a": ep.Trajectory([(0, 0), (9, 0)], speed=1)}, **{argument: value})


def test_what_the_file_has_no_type_for_is_told(load):
    with pytest.warns(RuntimeWarning, match=r"^traffic\[0\].actors: bus takes none of the kinds passenger, truck_heavy"):
        load(HERE + '\nactors = {"bus*" = "van", bus = "van", "PASS*" = false}')
    with pytest.warns(RuntimeWarning, match=r"^traffic\[0\].vehicle_length: truck takes none"):
        load(HERE + "\nvehicle_length = {motorcycle = 2.2, truck = 7.1}")


def test_only_who_is_on_the_way_is_read_and_moves_in_itself(folder, load):
    """Vehicle number i is on its way for 2 s from i // 4 steps on; the first four have come to their ends at 2 s."""
    found = ep.read_trajectories(folder / "fcd.xml.gz", during=(2.1, 2.3))
    assert list(found) == [f"flow/{number}" for number in range(4, 17)]
    whole = ep.read_trajectories(folder / "fcd.xml.gz")
    assert all(one == whole[name] and one.details == (2.1, min(2.3, one.end)) for name, one in found.items())
    scene = load(HERE + "\nduring = [2.1, 2.3]\nexclude = ['flow/0', 'flow/5']").scene
    assert [name for name in scene if name.startswith(("flow", "walker")) and "/" not in name] == [
        f"flow_{number}" for number in range(4, 17) if number != 5]
    tyre = next(mesh.id for mesh in scene.meshes if mesh.name == "flow_6/wheel/front_left/tyre")
    pose = scene["flow_6"].motion
    own = [(scene.world_vertices(tyre, time) - pose.at(time)[:3, 3]) @ pose.at(time)[:3, :3] for time in (1.0, 2.1, 2.3, 2.4)]
    assert np.abs(own[0] - own[1]).max() < 1e-9 < 0.1 < np.abs(own[1] - own[2]).max() and np.abs(own[2] - own[3]).max() < 1e-9
    with pytest.warns(RuntimeWarning, match=r"during: nobody is on the way from 90 to 91 s; trajectories are from 0 to 3 s"):
        assert ep.read_trajectories(folder / "fcd.xml.gz", during=(90, 91)) == {}
    with pytest.raises(ValueError, match=r"^during: must be \(begin, end\) in s"):
        ep.read_trajectories(folder / "fcd.xml.gz", during=(3, 2))
