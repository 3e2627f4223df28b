"""Planes that become mirrors by themselves: by the closed form of the Fresnel zone, and in whole scenes as people mark them."""
from importlib.resources import as_file

import numpy as np
import pytest

import echopath as ep
from echopath.base.storage.data_folder import data_folder
from echopath.bench.live import street

FREQUENCY = 77e9
DISTANCE = 25.0                                                    # m, of a plate ahead
ZONE = 2.0 * np.sqrt(ep.speed_of_light / FREQUENCY * DISTANCE)     # m, of what goes on without end
SHIPPED = ("street", "corners", "ghost_corner", "parking_lot", "tunnel", "roundabout", "guard_rail", "indoor_gestures")


def radar(**place):
    waveform = ep.ChirpSequence(start_frequency=FREQUENCY, num_chirps=1)
    return ep.Radar(waveform, transmitters=[ep.Antenna((0, 0, 0))], receivers=[ep.Antenna((0, 0, 0))], **place)


def plate(side: float, distance: float = DISTANCE, *, hole: float = 0.0) -> ep.Mesh:
    """A square that faces the radar, of eight triangles about a square hole; its corners are `distance` from the origin."""
    ahead = np.sqrt(distance**2 - 0.5 * side**2)
    ring = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    vertices = [(ahead, 0.5 * size * y, 0.5 * size * z) for size in (side, hole or 1e-6) for y, z in ring]
    return ep.Mesh(vertices, [t for k in range(4) for t in ((k, (k + 1) % 4, 4 + k), (4 + k, (k + 1) % 4, 4 + (k + 1) % 4))])


def marked(mesh, *, material="concrete", at=None, **more):
    scene = ep.Scene()
    scene.add(mesh, name="plate", material=material, **more)
    names = ep.mark_mirrors(scene, at or radar())
    assert [name for name in scene if scene[name].material.mirror] == list(names)
    return names


def test_what_counts_is_the_distance_from_the_radar_where_it_stands():
    near = radar(position=(DISTANCE - 1.0, 0.0, 0.0))
    assert marked(plate(ZONE), at=near) == ("plate",) and marked(plate(ZONE)) == ()


def test_a_frame_is_as_wide_as_what_is_about_its_hole():
    """Four times the area over the length of both rims is the difference of the sides."""
    side = 5.0 * ZONE
    assert marked(plate(side, hole=side - 2.02 * ZONE)) == ("plate",)
    assert marked(plate(side, hole=side - 1.98 * ZONE)) == ()


def in_strips(side: float, heights=(0.0, 0.17, 0.6, 1.0)) -> ep.Mesh:
    """The plate cut as walls around windows are: strips of unlike parts, whose corners lie on the sides of the next strip."""
    whole = plate(side).vertices
    low, across, up = whole[0], whole[1] - whole[0], whole[3] - whole[0]
    vertices, triangles = [], []
    for strip, (begin, end) in enumerate(zip(heights[:-1], heights[1:])):
        cuts = np.linspace(0.0, 1.0, 2 + 2 * strip)
        for left, right in zip(cuts[:-1], cuts[1:]):
            first = len(vertices)
            vertices += [low + x * across + z * up for x, z in ((left, begin), (right, begin), (right, end), (left, end))]
            triangles += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
    return ep.Mesh(vertices, triangles)


@pytest.mark.parametrize("cut", [plate, in_strips])
def test_a_plate_is_a_mirror_from_twice_the_zone_on_however_a_file_cuts_it(cut):
    assert marked(cut(2.02 * ZONE)) == ("plate",)
    assert marked(cut(1.98 * ZONE)) == ()


def test_triangles_that_a_file_lists_twice_are_as_wide_as_by_themselves():
    for factor, names in ((2.02, ("plate",)), (1.98, ())):
        once = plate(factor * ZONE)
        twice = np.concatenate([once.triangles, once.triangles[:, ::-1]])
        assert marked(ep.Mesh(once.vertices, twice)) == names


def test_rough_smooth_thin_and_deforming_surfaces_stay():
    side = 3.0 * ZONE
    wavelength = ep.speed_of_light / FREQUENCY
    height = wavelength * np.sqrt(-np.log(0.1)) / (4.0 * np.pi)  # Ament: a tenth keeps its phase
    for factor, names in ((0.99, ("plate",)), (1.01, ())):
        assert marked(plate(side), material=ep.Material(permittivity=5 - 0.3j, roughness_height=factor * height)) == names
    assert marked(plate(side), smooth=True) == ()
    assert marked(plate(side), material=ep.Material(layers=[ep.Layer(0.004, 6 - 0.1j)])) == ()
    shape = plate(side)
    bend = ep.VertexSequence(times=[0.0, 1.0], vertices=[shape.vertices, shape.vertices])
    assert marked(shape, motion=bend) == ()
    assert marked(shape, speed=3.0) == ()


def test_a_mesh_below_another_one_keeps_its_material():
    scene = ep.Scene()
    scene.add(plate(3.0 * ZONE), name="house", material="concrete")
    scene.add(plate(0.1 * ZONE), name="bell", material="metal", parent="house")
    assert ep.mark_mirrors(scene, radar()) == ("house",)
    assert not scene["house/bell"].material.mirror and ep.mark_mirrors(scene, radar()) == ()  # once for all


def test_windows_that_are_set_back_are_cut_from_a_front_and_are_no_mirrors():
    """Each would have images of all that it sees: three houses would have a hundred mirrors."""
    scene, mesh = ep.Scene(), ep.Mesh(*street.house())
    for k in range(3):
        scene.add(mesh, name=f"house_{k}", material="concrete", position=(10.0 + 20.0 * k, 10.0, 0.0))
    scene.add(plate(0.1 * ZONE), name="small_planes", material="metal", parent="house_1")  # a name that is taken
    whole = np.sort(np.concatenate([corners_of(scene, k) for k in range(3)]), axis=None)
    assert ep.mark_mirrors(scene, radar()) == ("house_0", "house_1", "house_2")
    parts = ["house_0/small_planes", "house_1/small_planes_2", "house_2/small_planes"]
    assert [name for name in scene if "/small_planes" in name] == ["house_1/small_planes", *parts]
    assert not any(scene[name].material.mirror for name in parts)
    cut = np.concatenate([corners_of(scene, mesh_id) for mesh_id in range(len(scene.meshes)) if mesh_id != 3])
    assert np.array_equal(np.sort(cut, axis=None), whole)
    depths = [{float(y) for y in np.round(scene.world_vertices(scene[name].meshes[0].id)[:, 1], 9)} for name in parts]
    assert depths == [{10.0, 10.0 + street.WINDOW_DEPTH}] * 3  # panes and reveals, no wall and no roof
    for houses in ([f"house_{k}" for k in range(3)], parts):
        near, far, farther = [scene[name]._node.mesh for name in houses]
        assert far is farther and near is not far  # cut alike, they share their meshes; some near panes are wide
    assert ep.mark_mirrors(scene, radar()) == ()


def street_of_a_house() -> ep.Scene:
    """A house with windows that are set back, on the left of the radar, and a car ahead of it."""
    vertices, triangles = street.house()
    scene = ep.Scene()
    scene.add(ep.Mesh(vertices, triangles, np.arange(len(triangles)) + 1000), name="house",
              material=ep.Material(permittivity=5 - 0.3j), position=(10.0, 10.0, 0.0))
    scene.add(ep.actors.car(), name="car", position=(20.0, 0.0, 0.0))
    return scene


def test_windows_that_were_cut_are_the_houses_not_objects_for_labels():
    """The house had been an object of its windows and a mirror of the same name: ghosts of "house" over "house"."""
    scene = street_of_a_house()
    at = radar(position=(0.0, 0.0, 1.5))
    assert set(ep.find_objects(scene, at)) == {"house", "car"}
    assert ep.mark_mirrors(scene, at) == ("house",)
    assert ep.find_objects(scene, at) == {"car": "car"}
    paths = ep.trace(scene, at, num_rays=3000, max_bounces=2)
    found = ep.families(paths)
    assert found.objects == ("car",)
    assert len({str(family) for family in found.families}) == len(found.families)
    of_windows = paths.select("T .* 'house/small_planes' .* R").num_paths
    assert 0 < of_windows <= paths.select("T .* 'house' .* R").num_paths


def test_windows_in_a_row_are_no_thing_of_a_scene():
    """Those of a hall are together no larger than a vehicle, and had been a thing called "small_planes"."""
    sizes = [(20.0, 9.0, 10.0), *[(0.5, 0.5, 10.2)] * 9]  # m: along x, upwards and from the radar, of the front and its windows
    middles = [0.0, *np.linspace(-8.0, 8.0, 9)]
    vertices = [(x + 0.5 * size * side, y, 0.5 * height * up) for x, (size, height, y) in zip(middles, sizes)
                for side, up in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    triangles = [(k, k + i, k + i + 1) for k in range(0, len(vertices), 4) for i in (1, 2)]
    scene = ep.Scene()
    scene.add(ep.Mesh(vertices, triangles), name="hall", material="concrete", position=(10.0, 0.0, 0.0))
    assert ep.mark_mirrors(scene, radar()) == ("hall",) and "hall/small_planes" in scene
    assert ep.find_objects(scene, radar()) == {}


def test_what_is_cut_keeps_the_faces_and_the_material_of_its_file():
    scene = street_of_a_house()
    scene["house"]._change(material_name="Brick")
    ep.mark_mirrors(scene, radar(position=(0.0, 0.0, 1.5)))
    meshes = [scene[name].mesh for name in ("house", "house/small_planes")]
    faces = np.concatenate([mesh.original_triangle for mesh in meshes])
    assert np.array_equal(np.sort(faces), np.arange(len(faces)) + 1000)
    assert [node.material_name for node in scene.nodes if node.name.startswith("house")] == ["Brick", "Brick"]


def test_a_thing_beside_a_mirror_of_the_same_mesh_stays_an_object():
    """A part of a mesh is a mirror, a part beside it a thing of its own: only what is below a mirror is the mirror's."""
    whole = two_plates()
    scene = ep.Scene()
    scene.add(whole.part([0, 1]), name="wall", material=ep.Material(permittivity=5, mirror=True))
    scene.add(whole.part([2, 3]), name="table", material="wood")
    assert ep.families(ep.trace(scene, radar(), num_rays=500, max_bounces=1)).objects == ("table",)


def two_plates() -> ep.Mesh:
    """One mesh of two squares across +x, 10 m and 15 m ahead."""
    vertices = [(x, y, z) for x in (10.0, 15.0) for y, z in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return ep.Mesh(vertices, [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]])


def corners_of(scene, mesh_id: int) -> np.ndarray:
    """Corners of all triangles of a mesh in the world, [3 F, 3] in m, to 1e-9 m."""
    return np.round(scene.world_vertices(mesh_id)[scene.meshes[mesh_id].triangles].reshape(-1, 3), 9)


def box(*sides) -> ep.Mesh:
    """A closed box of these sides in m about the origin."""
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]) * sides
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return ep.Mesh(corners, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


@pytest.mark.parametrize("sides, names", [
    ((40.0, 0.3, 5.0), ("plate",)),   # walls, whose ends and tops are narrow
    ((40.0, 0.5, 5.0), ("plate",)),
    ((9.0, 8.0, 6.0), ("plate",)),    # a house
    ((2.0, 1.8, 1.5), ()),            # a crate, which is an object
    ((3.0, 0.05, 2.5), ("plate",)),   # a wall of a room
    ((3.0, 0.5, 2.5), ()),            # a wardrobe
    ((4.5, 1.9, 2.0), ()),            # a van
    ((13.6, 2.6, 2.7), ()),           # a trailer
    ((12.0, 3.5, 3.0), ("plate",)),   # a row of garages
    ((40.0, 0.5, 0.8), ())])          # a kerb, of which half is narrow
def test_walls_have_a_thickness_and_bodies_are_no_walls(sides, names):
    assert marked(box(*sides), position=(15.0, 4.15, 0.0)) == names
    c, s = np.cos(0.2), np.sin(0.2)
    turned = ep.Mesh(box(*sides).vertices @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]), box(*sides).triangles)
    assert marked(turned, position=(15.0, 4.15, 0.0)) == names  # whichever way it stands


@pytest.mark.parametrize("sides", [(6.0, 5.0, 2.5), (3.5, 3.0, 2.4), (12.0, 2.4, 2.6)])  # rooms and a container
def test_what_would_be_a_body_from_outside_is_a_room_around_the_radar(sides):
    room = box(*sides)
    assert marked(room, position=(0.1 * sides[0], 0.2, 0.1), yaw=0.3) == ("plate",)
    assert marked(room, position=(0.5 * sides[0] + 0.3, 0.0, 0.0)) == ()  # right before it
    assert marked(room, position=(0.45 * sides[0], 0.5 * sides[1] + 0.3, 0.0), yaw=0.5) == ()  # in a box along the axes
    open_room = ep.Mesh(room.vertices, room.triangles[2:])  # without the wall at its back
    assert marked(open_room, position=(0.1 * sides[0], 0.2, 0.1)) == ("plate",)


def test_a_body_with_the_radar_in_its_box_is_no_room():
    """Before a side of a prism, of which less than half of all directions see something: front and back together are more."""
    corners = [(0.0, -1.0), (0.0, 1.0), (1.5, 0.0)]
    sides = [t for i, j in ((0, 1), (1, 2), (2, 0)) for t in ((i, 3 + j, j), (i, 3 + i, 3 + j))]
    prism = ep.Mesh([(x, y, z) for z in (-1.0, 1.0) for x, y in corners], [(0, 1, 2), (3, 5, 4), *sides])
    outward = np.array([2.0, 3.0, 0.0]) / np.sqrt(13.0)
    assert marked(prism, position=-(np.array([0.75, 0.5, 0.0]) + 0.2 * outward)) == ()


@pytest.mark.parametrize("name", SHIPPED)
def test_in_scenes_of_this_repository_it_marks_what_people_marked(name):
    with as_file(data_folder("scenes") / f"{name}.toml") as path:
        file = ep.load_scene(path)
    scene = file.scene
    by_hand = [mesh.name for mesh in scene.meshes if mesh.material.mirror]
    for mesh_name in by_hand:
        scene[mesh_name].material = scene[mesh_name].material.replace(mirror=False)
    assert list(ep.mark_mirrors(scene, file.radar)) == by_hand


def test_a_scene_file_asks_for_it(tmp_path):
    with as_file(data_folder("scenes") / "street.toml") as street:
        text = street.read_text(encoding="utf-8").replace("mirror = true", "mirror = false")
    for asked in (True, False):
        path = tmp_path / "scene.toml"
        path.write_text(f"mark_mirrors = {str(asked).lower()}\n{text}", encoding="utf-8")
        assert ep.load_scene(path).scene["wall_left"].material.mirror is asked


def test_wrong_arguments_are_named():
    with pytest.raises(TypeError, match="radar"):
        ep.mark_mirrors(ep.Scene(), None)
    with pytest.raises(TypeError, match="scene"):
        ep.mark_mirrors(None, radar())
