"""The same surfaces through every format that is read give the same hits: names of meshes, points and powers."""
from __future__ import annotations

import numpy as np
import pytest
from pxr import Sdf, Usd, UsdUtils

import echopath as ep
from support.files.gltf_files import GltfFile
from support.files.mesh_texts import npz, obj, off, ply, stl, stl_text, usd_mesh, usda

POINT = 1e-6  # m, of coordinates that formats keep in single precision
POWER = 1e-6  # of the greatest one of a path
FROM_SCENE = [1, 2, 0]  # axes of a scene that become x, y and z of a glTF file: left, up, ahead

pytestmark = pytest.mark.filterwarnings("ignore::echopath.TessellationWarning")


def body(rings: int = 33, around: int = 32) -> tuple:
    """(vertices [V, 3] m that floats hold, triangles [F, 3]) of a closed body with a bonnet, a cabin and a boot."""
    along, turn = np.meshgrid(np.linspace(0.0, np.pi, rings)[1:-1], 2.0 * np.pi * np.arange(around) / around, indexing="ij")
    rounded = lambda value: np.sign(value) * np.abs(value) ** 0.4  # a superellipsoid: nearly a box
    x = 2.2 * rounded(np.cos(along))
    y = 0.9 * rounded(np.sin(along)) * rounded(np.cos(turn))
    z = rounded(np.sin(along)) * rounded(np.sin(turn))
    z = 0.7 + np.where(z > 0.0, 0.3 + 0.4 * (np.abs(x + 0.3) < 1.1), 0.5) * z
    rows = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    vertices = np.concatenate([rows, [[2.2, 0.0, 0.7], [-2.2, 0.0, 0.7]]]).astype(np.float32).astype(float)
    first, after = np.arange(around), (np.arange(around) + 1) % around
    last, front, back = (rings - 3) * around, len(vertices) - 2, len(vertices) - 1
    sides = [[np.stack([i + first, i + around + first, i + after]), np.stack([i + after, i + around + first, i + around + after])]
             for i in range(0, last, around)]
    ends = [np.stack([0 * first + front, first, after]), np.stack([0 * first + back, last + after, last + first])]
    return vertices, np.concatenate([piece.T for pair in sides for piece in pair] + [end.T for end in ends])


VERTICES, FACES = body()
BOX = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-0.5, 0.5) for z in (-0.25, 0.25)])
BOX_FACES = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6],
                      [0, 6, 4], [1, 5, 7], [1, 7, 3]])
TURN_DEG, PLACE = 30.0, np.array([0.5, -0.25, 1.75])  # of the box on the roof, about z
ROUGH = ep.Material(permittivity=5.0, scattering=0.7)  # every hit has an echo
SCENE_XML = '<scene version="3.0.0">{}</scene>'


def gltf(vertices, faces, name: str, **node) -> GltfFile:
    file = GltfFile(nodes=[{"name": name, "mesh": 0} | node], scenes=[{"nodes": [0]}])
    file.mesh(vertices[:, FROM_SCENE], faces)
    return file


def write_one(folder) -> list:
    """The body alone, in all formats."""
    writers = {"car.obj": obj, "car.ply": ply, "car.stl": stl, "car.off": off, "car.npz": npz}
    for name, write in writers.items():
        (folder / name).write_bytes(write(VERTICES, FACES))
    (folder / "car.usda").write_bytes(usda(VERTICES, FACES, "car"))
    (folder / "car.glb").write_bytes(gltf(VERTICES, FACES, "car").glb())
    (folder / "car.gltf").write_text(gltf(VERTICES, FACES, "car").gltf())
    shape = '<shape type="ply" id="mesh-car"><string name="filename" value="car.ply"/></shape>'
    (folder / "car.xml").write_text(SCENE_XML.format(shape))
    return [*(folder / name for name in (*writers, "car.usda", "car.glb", "car.gltf", "car.xml")), *packed(folder / "car.usda")]


def packed(file) -> list:
    """A stage in the binary format of USD, and in a package, as its library writes them."""
    binary, package = file.with_suffix(".usdc"), file.with_suffix(".usdz")
    assert Usd.Stage.Open(str(file)).Export(str(binary))
    assert UsdUtils.CreateNewUsdzPackage(Sdf.AssetPath(str(binary)), str(package))
    return [binary, package]


def placed(points) -> np.ndarray:
    c, s = np.cos(np.radians(TURN_DEG)), np.sin(np.radians(TURN_DEG))
    return points @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]).T + PLACE


def write_two(folder) -> list:
    """The body and a box on its roof, which is placed by a transform where the format has one."""
    moved = placed(BOX)
    parts = obj(VERTICES, FACES, "car") + b"\n" + obj(moved, BOX_FACES + len(VERTICES), "box")
    (folder / "two.obj").write_bytes(parts)
    (folder / "two.stl").write_bytes(stl_text(VERTICES, FACES, "car") + stl_text(moved, BOX_FACES, "box"))
    file = gltf(VERTICES, FACES, "car")
    half = np.radians(TURN_DEG) / 2
    file.json["nodes"].append({"name": "box", "mesh": file.mesh(BOX[:, FROM_SCENE], BOX_FACES),
                               "translation": PLACE[FROM_SCENE].tolist(), "rotation": [0, np.sin(half), 0, np.cos(half)]})
    file.json["scenes"] = [{"nodes": [0, 1]}]
    (folder / "two.glb").write_bytes(file.glb())
    (folder / "two.gltf").write_text(file.gltf())
    place = ", ".join(map(str, PLACE))
    box = usd_mesh(BOX, BOX_FACES, "box").replace("{\n", f"""{{
    double3 xformOp:translate = ({place})
    double xformOp:rotateZ = {TURN_DEG}
    uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateZ"]
""", 1)
    (folder / "two.usda").write_bytes(usda(VERTICES, FACES, "car") + box.encode())
    (folder / "car.ply").write_bytes(ply(VERTICES, FACES))
    (folder / "box.ply").write_bytes(ply(BOX, BOX_FACES))
    shapes = ('<shape type="ply" id="mesh-car"><string name="filename" value="car.ply"/></shape><shape type="ply" id="mesh-box">'
              f'<string name="filename" value="box.ply"/><transform name="to_world"><rotate z="1" angle="{TURN_DEG}"/>'
              f'<translate value="{place}"/></transform></shape>')
    (folder / "two.xml").write_text(SCENE_XML.format(shapes))
    return [*(folder / f"two.{suffix}" for suffix in ("obj", "stl", "glb", "gltf", "usda", "xml")), *packed(folder / "two.usda")]


def echoes(model) -> tuple:
    """(names of the meshes that paths hit [H], points [H, 3] m, powers [P]) of one trace."""
    scene = ep.Scene()
    scene.add(model, name="m", position=(9.0, 1.0, 0.0), yaw=0.4)
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=1e9, num_samples=64, sampling_rate=5e6, num_chirps=4,
                                chirp_interval=1e-4)
    radar = ep.Radar(waveform, transmitters=[ep.Antenna((0, 0, 1))], receivers=[ep.Antenna((0, 0, 1.1))])
    paths = ep.trace(scene, radar, num_rays=3000, seed=5)
    names = np.array([mesh.name for mesh in scene.meshes])
    return names[paths.mesh_id], paths.points(0.0), np.abs(paths.amplitude) ** 2


def wanted(*meshes) -> tuple:
    nodes = tuple(ep.ModelNode(name, mesh=ep.Mesh(vertices, faces), material=ROUGH) for name, vertices, faces in meshes)
    return echoes(ep.Model(nodes))


def assert_same(path, found: tuple, expected: tuple) -> None:
    for ours, theirs in zip(found, expected):
        assert ours.shape == theirs.shape, path.name
    assert np.array_equal(found[0], expected[0]), path.name
    assert np.abs(found[1] - expected[1]).max() < POINT, path.name
    assert np.abs(found[2] - expected[2]).max() < POWER * expected[2].max(), path.name


def test_one_mesh_of_two_thousand_triangles_gives_the_same_hits_through_every_format(tmp_path):
    assert len(FACES) == 1984 and ep.Mesh(VERTICES, FACES).is_closed
    expected = wanted(("car", VERTICES, FACES))
    assert len(expected[2]) > 500 and len(set(expected[0])) == 1
    for path in write_one(tmp_path):
        assert_same(path, echoes(ep.load_model(path, materials={"*": ROUGH})), expected)


def test_two_meshes_and_a_transform_give_the_same_hits_through_every_format(tmp_path):
    expected = wanted(("car", VERTICES, FACES), ("box", placed(BOX), BOX_FACES))
    assert set(expected[0]) == {"m/car", "m/box"}
    for path in write_two(tmp_path):
        assert_same(path, echoes(ep.load_model(path, materials={"*": ROUGH})), expected)
