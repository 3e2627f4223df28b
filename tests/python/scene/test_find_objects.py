"""What labels of a scene tell apart where a town was read as one object."""
import numpy as np
import pytest

import echopath as ep
from echopath.actors import shapes
from support.labelled import make_radar

ROUGH = ep.Material(reflectivity=0.3, scattering=1.0)


def _add(scene, parent, name, sides, position):
    scene.add(shapes.box(sides), name=name, material=ROUGH, position=position, parent=parent)


@pytest.fixture
def town():
    """A ground and a house whose windows touch it, a group of parked cars one metre apart, and a pole; all below one node that
    has but one below it, as files of modellers have."""
    scene = ep.Scene()
    root = scene.add(None, name="root", parent=scene.add(None, name="town"))
    scene.add(shapes.ground((200.0, 200.0), z=-1.0), name="ground", material=ROUGH, parent=root)
    house = scene.add(None, name="house", parent=root)
    _add(scene, house, "walls", (10.0, 10.0, 6.0), (30.0, 20.0, 2.0))
    for number in range(5):
        _add(scene, house, f"window_{number}", (0.1, 1.0, 1.0), (25.0, 16.0 + 2.0 * number, 2.0))
    cars = scene.add(None, name="cars", parent=root)
    for number in range(4):
        _add(scene, cars, f"car_{number}", (4.5, 1.8, 1.5), (8.0 + 5.5 * number, -6.0, -0.2))
    _add(scene, root, "pole", (0.2, 0.2, 8.0), (12.0, 6.0, 3.0))
    return scene


def _usual(scene):
    return [seen.name for seen in ep.visibility(scene, make_radar())]


CARS = {f"car_{number}": f"town/root/cars/car_{number}" for number in range(4)}


def test_things_of_a_town_are_found_and_parts_of_a_house_are_not(town):
    assert ep.find_objects(town, make_radar()) == {"pole": "town/root/pole"} | CARS


def test_usual_objects_keep_their_names_and_go_before_things(town):
    scene = town
    scene.add(shapes.box((0.5, 0.6, 1.8)), name="pole", material=ROUGH, position=(9.0, 1.0, 0.0))
    _add(scene, "town/root", "what[ever]", (1.0, 1.0, 1.0), (14.0, 2.0, 0.0))
    found = ep.find_objects(scene, make_radar())
    assert found == {"pole": "pole", "town/root/pole": "town/root/pole"} | CARS


def test_a_group_of_the_scene_whose_parts_stand_apart_gives_way_to_them():
    """A parked row, and a tree whose crown is larger than any vehicle, but sits on its trunk."""
    scene = ep.Scene()
    for number in range(4):
        _add(scene, scene.add(None, name="row") if number == 0 else "row", f"car_{number}", (4.5, 1.8, 1.5),
             (8.0 + 5.5 * number, -6.0, 0.8))
    tree = scene.add(None, name="tree")
    _add(scene, tree, "trunk", (0.4, 0.4, 3.0), (12.0, 9.0, 1.5))
    _add(scene, tree, "crown", (7.0, 7.0, 5.0), (12.0, 9.0, 5.5))
    assert _usual(scene) == ["row", "tree"]
    assert ep.find_objects(scene, make_radar()) == {f"car_{n}": f"row/car_{n}" for n in range(4)} | {"tree": "tree"}


def test_the_vehicle_that_carries_the_radar_has_no_things():
    scene = ep.Scene()
    own = scene.add(None, name="own")
    _add(scene, own, "body", (4.5, 1.8, 0.3), (0.0, 0.0, 0.5))
    _add(scene, own, "roof", (2.0, 1.6, 0.1), (0.0, 0.0, 1.6))
    _add(scene, None, "ahead", (1.0, 1.0, 1.0), (9.0, 0.0, 1.0))
    assert ep.find_objects(scene, make_radar()) == {"ahead": "ahead"}


def test_mirrors_and_large_planes_are_no_objects(town):
    wall = ep.Mesh([[40, -3, -1], [40, 3, -1], [40, 3, 3], [40, -3, 3]], [[0, 3, 2], [0, 2, 1]])
    town.add(wall, name="wall", material=ep.Material.metal(), parent="town/root")
    town.add(shapes.plate(0.5, 0.5), name="sign", material=ep.Material.metal(mirror=True), position=(15, 3, 1), yaw=np.pi,
             parent="town/root")
    assert set(ep.find_objects(town, make_radar())) == {"pole", *CARS}


def test_labels_of_a_town_tell_its_things_apart(town):
    radar = make_radar(num_rx=2)
    frame = ep.simulate(town, radar, num_rays=20_000, labels={"objects": ep.find_objects(town, radar)}, guard=False)
    statuses = {label.name: label.status for label in frame.labels["parts"].objects}
    assert set(statuses) == {"pole", *CARS} and statuses["pole"] == statuses["car_0"] == "seen"
    assert [label.name for label in ep.annotate(frame.paths).objects] == []  # the town alone, which surrounds the radar


def test_a_scene_file_asks_for_what_is_found(town, tmp_path):
    """The file names a town that was written as glTF would have it, and a box that was added to it."""
    text = "".join(f"o {name}\n" + _obj_box(sides, middle, 8 * number) for number, (name, sides, middle) in enumerate([
        ("ground", (100, 100, 0.1), (0, 0, -1)), ("van", (5, 2, 2), (12, 3, 0)), ("bin", (1, 1, 1), (8, -4, 0))]))
    (tmp_path / "town.obj").write_text(text)
    (tmp_path / "scene.toml").write_text("""
[radar]
[radar.waveform]
start_frequency = 77e9
bandwidth = 1e9
num_samples = 64
sampling_rate = 10e6
num_chirps = 8
chirp_interval = 50e-6
[[radar.transmitters]]
position = [0, 0, 0]
[[radar.receivers]]
position = [0, 0, 0]
[[objects]]
name = "town"
model = "town.obj"
up = "z"
[[objects]]
name = "visitor"
actor = "standing_person"
position = [6.0, 0.0, 0.0]
[trace]
num_rays = 1000
[labels]
objects = "found"
[truth]
objects = "found"
""")
    found = ep.load_scene(tmp_path / "scene.toml")
    named = (("visitor", ("visitor",)), ("van", ("town/van",)), ("bin", ("town/bin",)))
    assert set(found.labels.objects) == set(named) and found.truth.objects == {name: globs[0] for name, globs in named}


def _obj_box(sides, middle, before: int) -> str:
    corners = [[m + 0.5 * k * s for m, k, s in zip(middle, signs, sides)] for signs in np.ndindex(2, 2, 2)
               for signs in [[2 * one - 1 for one in signs]]]
    quads = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)]
    return "".join(f"v {x} {y} {z}\n" for x, y, z in corners) + "".join(
        f"f {' '.join(str(before + one) for one in quad)}\n" for quad in quads)
