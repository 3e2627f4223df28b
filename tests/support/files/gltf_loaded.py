"""glTF files as they are loaded."""
import numpy as np

import echopath as ep
from support.files.gltf_files import BOX, GltfFile, box_file

TO_SCENE = [2, 0, 1]


def scene_of(model) -> ep.Scene:
    scene = ep.Scene()
    scene.add(model, name="m")
    return scene


def vertices_at(scene, time: float) -> dict:
    return {mesh.name.removeprefix("m/"): scene.world_vertices(mesh.id, time) for mesh in scene.meshes}


def rotated(q, points):
    x, y, z, w = q / np.linalg.norm(q)
    u = np.array([x, y, z])
    return points + 2 * w * np.cross(u, points) + 2 * np.cross(u, np.cross(u, points))


def morph_file(**mesh) -> GltfFile:
    file = box_file()
    rise, widen = np.tile([0.0, 1.0, 0.0], (8, 1)), BOX * [1.0, 0.0, 0.0]
    file.json["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": file.accessor(rise)}, {},
                                                          {"POSITION": file.accessor(widen)}]
    file.json["meshes"][0] |= mesh
    return file
