"""Models in traffic: a foreign file stands for a type, whatever its axes and its origin, with its front where the rows say."""
import math

import numpy as np
import pytest

import echopath as ep
from support.files.scene_text import ANTENNAS, WAVEFORM

STEP = 0.5  # s
SPEED = 8.0  # m/s
TOLERANCE = 1e-5  # m: rows have six digits behind the point
# A box of 4.4 m that looks along the +y of its file, with its origin 1 m behind its middle, on the ground.
BOX = np.array([(x, y, z) for x in (-0.9, 0.9) for y in (-1.2, 3.2) for z in (0.0, 1.5)])
FACES = "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n"
HEADINGS = {"north": ("taxi_a", 0.0), "east": ("Taxi_b", 90.0), "slant": ("taxi_c", 215.0), "other": ("passenger", 90.0)}
AT = {name: (40.0 * number, 10.0) for number, name in enumerate(HEADINGS)}  # m, of the front at time 0


def ahead(name: str) -> np.ndarray:
    angle = math.radians(HEADINGS[name][1])  # from north, clockwise
    return np.array([math.sin(angle), math.cos(angle)])


def front(name: str, time: float) -> np.ndarray:
    return AT[name] + SPEED * time * ahead(name)


def fcd() -> str:
    def rows(time: float) -> str:
        return "".join(f'<vehicle id="{name}" type="{kind}" x="{front(name, time)[0]:.6f}" y="{front(name, time)[1]:.6f}" '
                       f'angle="{angle}"/>' for name, (kind, angle) in HEADINGS.items())
    return "".join(f'<timestep time="{time}">{rows(time)}</timestep>' for time in STEP * np.arange(5))


SCENE = WAVEFORM + ANTENNAS + """
[[traffic]]
file = "fcd.xml"
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("models")
    (path / "fcd.xml").write_text(f"<fcd-export>{fcd()}</fcd-export>")
    (path / "taxi.obj").write_text("".join(f"v {x} {y} {z}\n" for x, y, z in BOX) + FACES)
    return path


@pytest.fixture(scope="module")
def load(folder):
    def loaded(value: str, more: str = "") -> ep.SceneFile:
        (folder / "scene.toml").write_text(f'{SCENE}{more}\n[traffic.actors]\n"taxi*" = {value}')
        return ep.load_scene(folder / "scene.toml")
    return loaded


def vertices(scene, name: str, time: float) -> np.ndarray:
    return np.concatenate([scene.world_vertices(mesh.id, time) for mesh in scene.meshes if mesh.name.startswith(f"{name}/")])


def test_models_look_ahead_with_their_fronts_where_the_rows_say(load):
    scene = load('{model = "taxi.obj", yaw_deg = -90.0, position = [-1.0, 0.0, 0.2], materials = {"*" = "metal"}}').scene
    for name in ("north", "east", "slant"):
        for time in (0.0, 0.7, 2.0):
            middle, left = front(name, time) - 2.2 * ahead(name), np.array([-ahead(name)[1], ahead(name)[0]])
            corners = np.array([(*(middle + x * 2.2 * ahead(name) + y * 0.9 * left), z)
                                for x in (-1, 1) for y in (-1, 1) for z in (0.2, 1.7)])
            apart = np.linalg.norm(vertices(scene, name, time)[:, None] - corners, axis=2)
            assert apart.min(axis=0).max() < TOLERANCE and apart.min(axis=1).max() < TOLERANCE
    assert vertices(scene, "other", 1.0)[:, 2].max() < 1.6  # a car of the usual kind
    meshes = [node.mesh for node in scene.nodes if node.mesh is not None][:3]
    assert meshes[0] is meshes[1] is meshes[2]


def test_the_length_of_the_file_of_traffic_counts_before_that_of_the_model(load):
    scene = load('{model = "taxi.obj", yaw_deg = -90.0}', "vehicle_length = 4.0").scene
    assert vertices(scene, "east", 1.0)[:, 0].max() == pytest.approx(front("east", 1.0)[0] - 2.0 + 3.2, abs=TOLERANCE)


def test_models_stand_for_types_in_python(folder):
    model = ep.load_model(folder / "taxi.obj").placed(yaw=-math.pi / 2)
    trajectories = ep.read_trajectories(folder / "fcd.xml", vehicle_length={"taxi*": 6.4})
    scene = ep.Scene()
    ep.add_traffic(scene, trajectories, actor_of={"taxi*": model, "*": None})
    assert {name for name in scene if "/" not in name} == {"north", "east", "slant"}
    for name in ("north", "slant"):
        reach = vertices(scene, name, 1.5)[:, :2] @ ahead(name)
        assert reach.max() == pytest.approx(front(name, 1.5) @ ahead(name), abs=TOLERANCE)
        assert np.ptp(reach) == pytest.approx(4.4, abs=TOLERANCE)


def test_meshes_have_the_same_names_in_scene_files_and_in_python(load, folder):
    scene = ep.Scene()
    model = ep.load_model(folder / "taxi.obj")
    ep.add_traffic(scene, ep.read_trajectories(folder / "fcd.xml"), actor_of={"taxi*": model})
    assert list(load('{model = "taxi.obj"}').scene) == list(scene)


def test_a_model_is_turned_before_it_is_moved(folder):
    scene = ep.Scene()
    scene.add(ep.load_model(folder / "taxi.obj").placed(position=(1.0, 2.0, 3.0), yaw=math.radians(30.0)), name="taxi")
    c, s = math.cos(math.radians(30.0)), math.sin(math.radians(30.0))
    wanted = {tuple(np.round((c * x - s * y + 1.0, s * x + c * y + 2.0, z + 3.0), 6)) for x, y, z in BOX}
    assert {tuple(np.round(one, 6)) for one in vertices(scene, "taxi", 0.0)} == wanted
    with pytest.raises(ValueError, match=r"^position: must be"):
        ep.load_model(folder / "taxi.obj").placed(position=(1.0, 2.0))


@pytest.mark.parametrize("value, words", [
    ('{model = "none.obj"}', r"traffic\[0\].actors.taxi\*.model: .*none.obj"),
    ('{model = "taxi.obj", yaw = 3}', r"traffic\[0\].actors.taxi\*.yaw: unknown key; did you mean 'yaw_deg'"),
    ('{model = "taxi.obj", actor = "car"}', r"traffic\[0\].actors.taxi\*.actor: unknown key"),
    ('{model = "taxi.obj", materials = {"*" = "gold plate"}}', r"traffic\[0\].actors.taxi\*.materials.\*: .*gold plate"),
    ('{model = "taxi.obj", way = "auto"}', r"traffic\[0\].actors.taxi\*.way: "),
    ('{model = "taxi.obj", unit = 0}', r"traffic\[0\].actors.taxi\*.unit: must be greater than 0, got 0")])
def test_wrong_models_are_refused_by_their_keys(load, value, words):
    with pytest.raises((ValueError, ep.FileError), match=words):
        load(value)
