"""Trajectories that scenes take: traffic of many objects, and those of scene files."""
import math
import pickle

import numpy as np
import pytest

import echopath as ep
from echopath.scene.traffic import usual_actor
from support.files.floating_car_data import FCD
from support.files.scene_text import ANTENNAS, WAVEFORM


def write(folder, name, text):
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def box_of(name, trajectory):
    return ep.Actor([ep.Part("body", ep.actors.box((1, 1, 1)), "metal")])


@pytest.mark.filterwarnings("ignore:.*single position")
def test_traffic_is_in_the_scene_while_it_is_on_its_way(tmp_path):
    scene = ep.Scene()
    traffic = ep.add_traffic(scene, ep.read_trajectories(write(tmp_path, "fcd.xml", FCD)), actor_of=box_of, time=0.5)
    assert list(traffic) == ["flow_0", "walker", "south"] == [node.name for node in scene.nodes if node.parent < 0]
    assert not scene["south"].visible and scene["walker"].visible
    assert traffic.show(1.4, 1.6) == ["flow_0", "south"] and not scene["walker"].visible
    mesh = scene["south"].meshes[0].id
    np.testing.assert_allclose(scene.world_vertices(mesh, 1.5).mean(axis=0)[:2], traffic["south"].position(1.5)[:2], atol=1e-5)
    assert traffic.present(0.0, 9.0) == list(traffic) and traffic.present(-1.0) == []
    more = ep.add_traffic(scene, {"a/b": traffic["walker"], "a_b": traffic["walker"], "walker": traffic["walker"]},
                          actor_of=lambda name, one: None if name == "walker" else box_of(name, one))
    assert list(more) == ["a_b", "a_b_2"]


def test_traffic_that_is_there_is_not_added_twice():
    scene, found = ep.Scene(), {name: ep.Trajectory([(0, 0), (9, 0)], speed=3.0) for name in ("car", "a/b")}
    ep.add_traffic(scene, found, actor_of=box_of)
    before = [node.name for node in scene.nodes]
    told = r"^trajectories: must be of names that the scene does not have yet \(scene.remove .*\), got 'car, a/b'$"
    with pytest.raises(ValueError, match=told):
        ep.add_traffic(scene, found | {"new": found["car"]}, actor_of=box_of)
    assert [node.name for node in scene.nodes] == before
    scene.add(name="west")
    assert list(ep.add_traffic(scene, found, actor_of=box_of, parent="west")) == ["west/car", "west/a_b"]
    with pytest.raises(ValueError, match="^trajectories: must be of names that 'west' does not have yet"):
        ep.add_traffic(scene, found, actor_of=box_of, parent="west")
    for name in ("car", "a_b"):
        scene.remove(name)
    assert list(ep.add_traffic(scene, found, actor_of=box_of)) == ["car", "a_b"]


def test_a_span_in_which_nobody_is_on_the_way_is_told():
    ways = {"a": ep.Trajectory([(0, 0), (10, 0)], times=[1, 3]), "b": ep.Trajectory([(0, 5), (10, 5)], times=[2, 4.5])}
    scene = ep.Scene()
    with pytest.warns(RuntimeWarning, match="^during: nobody is on the way from 600 to 700 s; trajectories are from 1 to 4.5 s"):
        assert not ep.add_traffic(scene, ways, during=(600, 700))
    assert list(ep.add_traffic(scene, ways, during=(4.5, 700))) == ["b"]


@pytest.mark.filterwarnings("ignore:.*single position")
def test_kinds_become_actors(tmp_path):
    found = ep.read_trajectories(write(tmp_path, "fcd.xml", FCD))
    parts = {name: {part.name for part in usual_actor(name, one).parts} for name, one in found.items()}
    assert "trailer/doors" in parts["south"] and "wheel/front_left/tyre" in parts["flow/0"] and "leg_left/foot" in parts["walker"]


@pytest.mark.filterwarnings("ignore:.*single position")
def test_persons_of_any_type_are_no_vehicles(tmp_path):
    text = FCD.replace('<person id="walker"', '<person id="walker" type="bus_rider"')
    found = ep.read_trajectories(write(tmp_path, "fcd.xml", text))
    copies = [found["walker"], found["walker"].shifted(5.0), pickle.loads(pickle.dumps(found["walker"]))]
    scene = ep.Scene()
    ep.add_traffic(scene, {str(number): one for number, one in enumerate(copies)})
    assert all(one.kind == "bus_rider" and one.is_person for one in copies)
    assert {"0/leg_left/foot", "1/leg_left/foot", "2/leg_left/foot"} <= set(scene)


@pytest.mark.parametrize("argument, value", [("actor_of", 5), ("actor_of", ep.Actor), ("trajectories", [1]), ("parent", 5),
                                             ("trajectories", {"a": 1}), ("scene", None), ("time", math.nan)])
def test_wrong_arguments_of_traffic_are_named(argument, value):
    right = {"scene": ep.Scene(), "trajectories": {}}
    with pytest.raises((TypeError, ValueError), match=f"^{argument}: must be"):
        ep.add_traffic(**right | {argument: value})


SCENE = "[radar]\ntrajectory = {points = [[0, 0, 1], [30, 0, 1]], speed = 5}" + WAVEFORM + ANTENNAS + """
[[objects]]
name = "box"
actor = "box"
parameters = {size = [1, 1, 1]}
material = "metal"
trajectory = {points = [[20, 0], [30, 0], [30, 10]], turn_radius = 4, speed = 2, stops = [[5, 1.0], [inf, 0]]}
[[objects]]
name = "bicycle"
actor = "bicycle"
trajectory = "drive.csv"
id = "b"
"""


@pytest.fixture
def scene_file(tmp_path):
    write(tmp_path, "drive.csv", "t,id,x,y\n0,a,0,5\n9,a,9,5\n0,b,0,7\n9,b,18,7\n")
    return lambda text: ep.load_scene(write(tmp_path, "scene.toml", text))


def test_scene_files_take_trajectories(scene_file):
    loaded = scene_file(SCENE)
    np.testing.assert_allclose(loaded.radar.world_from_radar(2.0)[:3, 3], [10, 0, 1], atol=1e-5)
    box = loaded.scene["box"].motion
    assert box == ep.Trajectory([(20, 0), (30, 0), (30, 10)], turn_radius=4, speed=2, stops=[(5, 1), (math.inf, 0)])
    np.testing.assert_allclose(loaded.scene["bicycle"].motion.at(4.5)[:3, 3], [9, 7, 0], atol=1e-5)
    wheel = loaded.scene["bicycle/wheel_front/tyre"].motion.at(1.0)
    np.testing.assert_allclose(wheel[:3, 0], [math.cos(2 / 0.343), 0, -math.sin(2 / 0.343)], atol=1e-4)


@pytest.mark.parametrize("right, wrong, words", [
    ('id = "b"', 'id = "c"', r"objects\[1\].id: there is no 'c'; the file has a, b"),
    ('id = "b"', "", r"objects\[1\].id: is missing"),
    ('"drive.csv"', '{speed = 2}', r"objects\[1\].trajectory.points: is missing"),
    ("speed = 2,", "speed = -2,", "trajectory: speed: "),
    ("speed = 2,", "sped = 2,", "did you mean 'speed'"), ('id = "b"', 'id = "b"\nspeed = 3', "must not stand beside speed"),
    ("turn_radius = 4", "turn_radius = 40", r"objects\[0\].trajectory: turn_radius: must fit"),
    ('name = "box"', 'name = "box"\nid = "b"', r"objects\[0\].id: needs a trajectory that is a file")])
def test_wrong_trajectories_of_scene_files_are_named(scene_file, right, wrong, words):
    with pytest.raises(ValueError, match=words):
        scene_file(SCENE.replace(right, wrong))
