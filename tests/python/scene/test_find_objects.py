"""What labels of a scene tell apart where a town was read as one object."""
import time

import numpy as np
import pytest

import echopath as ep
from echopath.actors import shapes
from support.files.mesh_texts import obj_boxes
from support.files.scene_text import SMALL_RADAR
from support.labelled import make_radar

ROUGH = ep.Material(reflectivity=0.3, scattering=1.0)


def _add(scene, parent, name, sides, position):
    scene.add(shapes.box(sides), name=name, material=ROUGH, position=position, parent=parent)


@pytest.fixture
def town():
    """A ground and a house whose windows touch it, a group of parked cars one metre apart, and a pole; all below one node that
    has but one below it, as files of modellers have."""
    scene = ep.Scene()
    block = scene.add(None, name="block", parent=scene.add(None, name="town"))
    scene.add(shapes.ground((200.0, 200.0), z=-1.0), name="ground", material=ROUGH, parent=block)
    house = scene.add(None, name="house", parent=block)
    _add(scene, house, "walls", (10.0, 10.0, 6.0), (30.0, 20.0, 2.0))
    for number in range(5):
        _add(scene, house, f"window_{number}", (0.1, 1.0, 1.0), (25.0, 16.0 + 2.0 * number, 2.0))
    cars = scene.add(None, name="cars", parent=block)
    for number in range(4):
        _add(scene, cars, f"car_{number}", (4.5, 1.8, 1.5), (8.0 + 5.5 * number, -6.0, -0.2))
    _add(scene, block, "pole", (0.2, 0.2, 8.0), (12.0, 6.0, 3.0))
    return scene


def _usual(scene):
    return [seen.name for seen in ep.visibility(scene, make_radar())]


CARS = {f"car_{number}": f"town/block/cars/car_{number}" for number in range(4)}


def test_things_of_a_town_are_found_and_parts_of_a_house_are_not(town):
    assert ep.find_objects(town, make_radar()) == {"pole": "town/block/pole"} | CARS


def test_usual_objects_keep_their_names_and_go_before_things(town):
    scene = town
    scene.add(shapes.box((0.5, 0.6, 1.8)), name="pole", material=ROUGH, position=(9.0, 1.0, 0.0))
    _add(scene, "town/block", "box [1]", (1.0, 1.0, 1.0), (14.0, 2.0, 0.0))  # letters like any others to a glob
    found = ep.find_objects(scene, make_radar())
    assert found == {"pole": "pole", "town/block/pole": "town/block/pole", "box [1]": "town/block/box [1]"} | CARS
    paths = ep.trace(scene, make_radar(), num_rays=500, max_bounces=1)
    boxes = [mesh.id for mesh in scene.meshes if mesh.name == found["box [1]"]]
    families = ep.families(paths, {"box": found["box [1]"]})
    assert np.array_equal(families.object_of_path == 0, np.isin(paths.mesh_id[paths.offsets], boxes))
    assert np.any(families.object_of_path == 0)


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


def test_things_in_groups_that_reach_through_each_other_are_found():
    """Bins along both sides of a street and trams between them, each kind below a node of its own, as in files of towns."""
    scene = ep.Scene()
    town = scene.add(None, name="town")
    bins, trams = (scene.add(None, name=name, parent=town) for name in ("bins", "trams"))
    for number in range(10):
        _add(scene, bins, f"bin_{number}", (0.6, 0.6, 1.1), (8.0 + 3.0 * number, 4.0 if number % 2 else -4.0, 0.5))
    for number in range(2):
        _add(scene, trams, f"tram_{number}", (10.0, 2.0, 3.0), (14.0 + 14.0 * number, 0.0, 1.5))
    found = {name: f"town/{name[:-2]}s/{name}" for name in (*(f"bin_{n}" for n in range(10)), "tram_0", "tram_1")}
    assert ep.find_objects(scene, make_radar()) == found


def test_what_lies_about_many_things_hides_no_others():
    """Trees on a lawn are more than the cars beside them: each stands apart, in a group that does."""
    scene = ep.Scene()
    town = scene.add(None, name="town")
    for number in range(3):
        _add(scene, town, f"car_{number}", (4.5, 1.8, 1.5), (10.0, 12.0 * number - 15.0, 0.75))
    trees = scene.add(None, name="trees", parent=town)
    for number in range(12):
        _add(scene, trees, f"tree_{number}", (1.0, 1.0, 6.0), (25.0 + 5.0 * (number % 4), 5.0 * (number // 4) - 10.0, 3.0))
    _add(scene, town, "lawn", (30.0, 40.0, 0.05), (35.0, 0.0, 0.025))
    found = {f"car_{n}": f"town/car_{n}" for n in range(3)} | {f"tree_{n}": f"town/trees/tree_{n}" for n in range(12)}
    assert ep.find_objects(scene, make_radar()) == found | {"lawn": "town/lawn"}


def test_the_vehicle_that_carries_the_radar_has_no_things():
    scene = ep.Scene()
    own = scene.add(None, name="own")
    _add(scene, own, "body", (4.5, 1.8, 0.3), (0.0, 0.0, 0.5))
    _add(scene, own, "roof", (2.0, 1.6, 0.1), (0.0, 0.0, 1.6))
    _add(scene, None, "ahead", (1.0, 1.0, 1.0), (9.0, 0.0, 1.0))
    assert ep.find_objects(scene, make_radar()) == {"ahead": "ahead"}


def test_mirrors_and_large_planes_are_no_objects(town):
    wall = ep.Mesh([[40, -3, -1], [40, 3, -1], [40, 3, 3], [40, -3, 3]], [[0, 3, 2], [0, 2, 1]])
    town.add(wall, name="wall", material=ep.Material.metal(), parent="town/block")
    town.add(shapes.plate(0.5, 0.5), name="sign", material=ep.Material.metal(mirror=True), position=(15, 3, 1), yaw=np.pi,
             parent="town/block")
    assert set(ep.find_objects(town, make_radar())) == {"pole", *CARS}


def test_labels_of_a_town_tell_its_things_apart(town):
    radar = make_radar(num_rx=2)
    frame = ep.simulate(town, radar, num_rays=20_000, labels={"objects": ep.find_objects(town, radar)}, guard=False)
    statuses = {label.name: label.status for label in frame.labels["parts"].objects}
    assert set(statuses) == {"pole", *CARS} and statuses["pole"] == statuses["car_0"] == "seen"
    assert [label.name for label in ep.annotate(frame.paths).objects] == []  # the town alone, which surrounds the radar


def test_a_scene_file_asks_for_what_is_found(tmp_path):
    """The file names a town of another file, and a person who was added to it."""
    boxes = {"ground": ((100, 100, 0.1), (0, 0, -1)), "van": ((5, 2, 2), (12, 3, 0)), "bin": ((1, 1, 1), (8, -4, 0))}
    (tmp_path / "town.obj").write_text(obj_boxes(boxes))
    (tmp_path / "scene.toml").write_text(SMALL_RADAR + """
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


def test_what_stands_in_a_room_is_found_before_and_after_its_walls_are_marked():
    """In a room of 6 m by 5 m, read as one, all furniture together is no larger than a lorry."""
    scene = ep.Scene()
    scene.add(None, name="room")
    for name, side, position, yaw in (("left", 6.0, (3.0, 2.5, 0.0), 0.0), ("right", 6.0, (3.0, -2.5, 0.0), np.pi),
                                      ("back", 5.0, (6.0, 0.0, 0.0), -0.5 * np.pi)):
        scene.add(ep.actors.wall(side, 2.6), name=name, material="concrete", position=position, yaw=yaw, parent="room")
    _add(scene, "room", "cupboard", (1.0, 0.8, 1.9), (5.4, -2.0, 1.0))
    _add(scene, "room", "table", (1.4, 0.8, 0.04), (2.9, 1.3, 0.72))
    _add(scene, "room", "sofa", (1.6, 1.0, 0.4), (5.0, 1.7, 0.3))
    found = {name: f"room/{name}" for name in ("cupboard", "table", "sofa")}
    radar = make_radar().replace(position=(0.1, 0.0, 1.4))
    assert ep.find_objects(scene, radar) == found
    assert len(ep.mark_mirrors(scene, radar)) == 3
    assert ep.find_objects(scene, radar) == found


def test_groups_that_are_nested_deeply_are_looked_through_at_once():
    """Names are compared whole, not at each of their levels for each level. The last seven are as long as a vehicle."""
    scene, group, depth = ep.Scene(), None, 250
    for level in range(depth):
        group = scene.add(None, name="g", parent=group)
        _add(scene, group, "bin", (1.0, 1.0, 1.0), (3.0 * level, 0.0, 0.0))
    begin = time.process_time()
    found = ep.find_objects(scene, make_radar().replace(position=(100.0, 50.0, 0.0)))
    assert time.process_time() - begin < 1.0
    assert len(found) == depth - 6 and sum(glob.endswith("/bin") for glob in found.values()) == depth - 7
