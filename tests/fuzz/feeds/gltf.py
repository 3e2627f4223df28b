"""glTF files: damaged bytes, and documents in which somebody changes values."""
from __future__ import annotations

import copy
import json
import pickle
import warnings
from functools import partial
from pathlib import Path
from random import Random

import numpy as np

import echopath as ep
from fuzz.folder import memory_folder
from fuzz.mutate import damaged
from support.files.gltf_files import BOX, GltfFile, box_file, rig_file
from support.files.packed_gltf import draco_tube, meshopt_tube

ODD = [0, -1, 1, 2, 7, 255, 256, 65535, 2**31 - 1, 2**31, 2**53, 2**63, -2**63, 10**400, 0.5, -0.1, 1e-320, 1e30, 1e300, 1e308,
       True, False, None, "", "x", "/", "a/b*", "\ud83d", "\x00", "VEC3", "SCALAR", "MAT4", "STEP", "CUBICSPLINE", "weights",
       "scale", "rotation", "data:,", "data:;base64,AAAA", "../x.bin", "x.bin", ".", 5120, 5121, 5122, 5123, 5125, 5126, [], {},
       [0], [0, 0, 0], [1, 1, 0], [0, 0, 0, 1], [0, 0, 0, 0], [1e300, 0, 0], [0] * 16, [1e200] * 16, [[0]], {"mesh": 0},
       ["KHR_draco_mesh_compression"]]
TIMES = (0.0, 0.3, 1.0, 77.7)


def seeds() -> list[GltfFile]:
    """Small files that have everything that is read: nodes, matrices, skins, morph targets, all kinds of animation."""
    rig = rig_file(quantised="u2")
    rig.animation((2, "scale", [0, 1], [[1, 1, 1], [2, 1, 0]], "LINEAR"), (1, "translation", [0, 1], [[0, 0, 0], [1, 0, 0]],
                                                                            "STEP"), name="grow")
    rig.json["nodes"][1]["matrix"] = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
    morph = box_file(weights=[0.5], rotation=[0, 0, 0, 1])
    primitive = morph.json["meshes"][0]["primitives"][0]
    indices = {"bufferView": morph.view(np.array([1, 6], "<u2")), "componentType": 5123}
    values = {"bufferView": morph.view(np.ones((2, 3), "<f4"))}
    primitive["targets"] = [{"POSITION": morph.accessor(0 * BOX, sparse={"count": 2, "indices": indices, "values": values})}]
    primitive["attributes"]["NORMAL"] = morph.accessor(np.round(127 * BOX / 3), "i1", normalized=True, stride=4)
    morph.json |= {"materials": [{"name": "steel"}], "extensionsUsed": ["KHR_mesh_quantization"]}
    primitive["material"] = 0
    morph.json["nodes"].append({"name": "carrier", "children": [0], "scale": [1, -1, 1]})
    morph.json["scenes"] = [{"nodes": [1]}]
    rows = np.array([0, 0, 0, 0, 1, 0.0])
    morph.animation((0, "weights", [0, 1], rows, "CUBICSPLINE"), (1, "rotation", [0, 1, 2], np.eye(4)[[3, 2, 1]], "LINEAR"))
    fan = GltfFile(nodes=[{"mesh": 0}], scene=0, scenes=[{"nodes": [0]}])
    fan.mesh([[0, 0, 0], [0, 0, 1], [1, 0, 1], [2, 0, 0]], mode=6)
    copies = box_file()
    places = copies.accessor([[0, 0, 0], [0, 3, 0]])
    turns = copies.accessor([[0, 0, 0, 127]] * 2, "i1", normalized=True)
    attributes = {"TRANSLATION": places, "SCALE": places, "ROTATION": turns}
    copies.json["nodes"][0]["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": attributes}}
    return [box_file(), rig, morph, fan, copies, draco_tube(), meshopt_tube()]


def _check(path: Path, random: Random) -> None:
    """Holds a file to the promise: it is refused by an error that names it, or it is a model that a scene takes."""
    options = {"loop": random.random() < 0.5, "offset": random.choice((0.0, 0.1, -3.0))}
    options |= {"animation": ""} if random.random() < 0.2 else {}
    try:
        model = ep.load_model(path, **options)
    except ep.FileError as error:
        assert str(error).startswith(f"{path}: ") and len(str(error)) > len(str(path)) + 8, f"says little: {error}"
        return
    scene = ep.Scene()
    scene.add(model, name="model")
    for mesh in scene.meshes:
        for time in TIMES:
            assert scene.world_vertices(mesh.id, time).shape[1] == 3
    scene.breakpoints  # noqa: B018 (it is computed)


def _places(value, found: list) -> list:
    """(container, key) of all values of a document."""
    for key in value if isinstance(value, dict) else range(len(value)):
        found.append((value, key))
        if isinstance(value[key], (dict, list)):
            _places(value[key], found)
    return found


def _changed(document: bytes, random: Random) -> dict:
    """A pickled document (which is copied ten times as fast as one that is not) with some values changed."""
    document = pickle.loads(document)
    for _ in range(random.choice((1, 1, 1, 2, 3))):
        places = _places(document, [])
        if not places:
            return document
        holder, key = random.choice(places)
        kind = random.randrange(8)
        if kind <= 3:
            holder[key] = copy.deepcopy(random.choice(ODD))
        elif kind == 4 and isinstance(holder, dict):
            del holder[key]
        elif kind == 5:
            other, place = random.choice(places)
            holder[key] = copy.deepcopy(other[place])
        elif kind == 6 and isinstance(holder[key], list) and holder[key]:
            holder[key] = copy.deepcopy(holder[key]) * random.choice((0, 2, 50))
        elif isinstance(holder[key], int):
            holder[key] += random.choice((-1, 1, 4, 1000))
    return document


def feed_gltf_bytes():
    """Cases in which bytes of a .glb file are damaged."""
    folder = memory_folder()
    contents = [seed.glb() for seed in seeds()]
    path = Path(folder.name) / "model.glb"

    def case(number: int) -> None:
        random = Random(f"gltf_bytes {number}")
        path.write_bytes(damaged(random.choice(contents), random))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            _check(path, random)

    case.folder, case.seeds, case.file, case.read = folder, contents, path, partial(_check, path, Random(0))
    return case


def feed_gltf_bin():
    """Cases in which the file of bytes beside a .gltf file is damaged."""
    folder = memory_folder()
    path = Path(folder.name) / "model.gltf"
    contents = [(seed.gltf("model.bin"), seed.bytes) for seed in seeds()]

    def case(number: int) -> None:
        random = Random(f"gltf_bin {number}")
        text, content = random.choice(contents)
        path.write_text(text)
        (path.parent / "model.bin").write_bytes(damaged(content, random))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            _check(path, random)

    case.folder = folder
    return case


def feed_gltf_json():
    """Cases in which values of the document of a .gltf file are others."""
    folder = memory_folder()
    documents = [pickle.dumps(json.loads(seed.gltf())) for seed in seeds()]
    path = Path(folder.name) / "model.gltf"

    def case(number: int) -> None:
        random = Random(f"gltf_json {number}")
        path.write_text(json.dumps(_changed(random.choice(documents), random)))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            _check(path, random)

    texts = [seed.gltf().encode() for seed in seeds()]
    case.folder, case.seeds, case.file, case.read = folder, texts, path, partial(_check, path, Random(0))
    return case
