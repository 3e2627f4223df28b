"""glTF files whose surfaces are packed by Draco or meshoptimizer."""
from __future__ import annotations

import DracoPy
import meshoptimizer
import numpy as np

from support.files.gltf_files import GltfFile, tube

DRACO, MESHOPT = "KHR_draco_mesh_compression", "EXT_meshopt_compression"
VERTICES, TRIANGLES = tube(rings=30, around=24)


def view_of(file: GltfFile, content: bytes) -> int:
    return file.view(np.frombuffer(content, np.uint8))


def pack_by_draco(file: GltfFile, vertices, triangles, numbers: dict, **options) -> None:
    """Takes the bytes of the only primitive out of a file and puts a Draco mesh in their place.

    numbers: {attribute: rows [V, columns]} besides positions
    """
    primitive = file.json["meshes"][0]["primitives"][0]
    ids = {name: number for number, name in enumerate(numbers)}
    content = DracoPy.encode(vertices.astype(np.float32), triangles.astype(np.uint32), preserve_order=True,
                             generic_attributes={ids[name]: rows for name, rows in numbers.items()}, **options)
    position = next(one["unique_id"] for one in DracoPy.decode(content).attributes if one["attribute_type"] == 0)
    for accessor in [*primitive["attributes"].values(), primitive["indices"]]:
        del file.json["accessors"][accessor]["bufferView"]
    primitive["extensions"] = {DRACO: {"bufferView": view_of(file, content), "attributes": {"POSITION": position} | ids}}
    file.json["extensionsRequired"] = [DRACO]


def draco_tube(**options) -> GltfFile:
    file = GltfFile(nodes=[{"name": "tube", "mesh": 0}])
    file.mesh(VERTICES, TRIANGLES)
    pack_by_draco(file, VERTICES, TRIANGLES, {}, **options)
    return file


def pack_view(file: GltfFile, accessor: int, rows: np.ndarray, **how) -> None:
    """Packs the buffer view of an accessor; rows: as the encoder takes them."""
    mode = how.setdefault("mode", "ATTRIBUTES")
    encode = {"ATTRIBUTES": meshoptimizer.encode_vertex_buffer, "TRIANGLES": meshoptimizer.encode_index_buffer,
              "INDICES": meshoptimizer.encode_index_sequence}[mode]
    packed = encode(rows)
    view = file.json["bufferViews"][view_of(file, packed)]
    stride = how.pop("byteStride", rows.itemsize * (rows.shape[1] if rows.ndim > 1 else 1))
    entry = {"buffer": 0, "byteOffset": view["byteOffset"], "byteLength": len(packed), "byteStride": stride, "count": len(rows)}
    place = file.json["accessors"][accessor]["bufferView"]
    own = {"byteStride": stride} if mode == "ATTRIBUTES" else {}
    file.json["bufferViews"][place] = own | {"buffer": 1, "byteLength": stride * len(rows), "extensions": {MESHOPT: entry | how}}
    file.other_buffers = [{"byteLength": 10**6, "extensions": {MESHOPT: {"fallback": True}}}]  # which nobody gives


def meshopt_tube(**how) -> GltfFile:
    """Positions as floats, corners of 16 bits; the buffer that they would be in has no bytes, as the extension allows."""
    file = GltfFile(nodes=[{"name": "tube", "mesh": 0}], extensionsRequired=[MESHOPT])
    file.mesh(VERTICES, TRIANGLES)
    pack_view(file, 0, VERTICES.astype(np.float32))
    pack_view(file, 1, TRIANGLES.astype(np.uint32).ravel(), byteStride=2, mode="TRIANGLES", **how)
    return file
