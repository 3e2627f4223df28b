"""glTF files written by hand: a document and the arrays that it points to."""
from __future__ import annotations

import base64
import json
import struct

import numpy as np

import echopath as ep

COMPONENTS = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}
TYPES = {(): "SCALAR", (2,): "VEC2", (3,): "VEC3", (4,): "VEC4", (16,): "MAT4"}


class GltfFile:
    """A glTF document that grows: `accessor(array)` returns its index, the rest is in `json`.

    other_buffers: what it says of buffers besides its own
    """

    def __init__(self, **json_parts):
        self.json = {"asset": {"version": "2.0"}, "accessors": [], "bufferViews": [], "buffers": [{}]} | json_parts
        self.bytes = b""
        self.other_buffers: list[dict] = []

    def accessor(self, values, dtype: str = "f4", *, normalized: bool = False, stride: int = 0, **more) -> int:
        """Adds an array [N] or [N, columns], its rows `stride` bytes apart."""
        values = np.ascontiguousarray(values, np.dtype(dtype).newbyteorder("<"))
        entry = {"bufferView": self.view(values, stride), "componentType": COMPONENTS[dtype], "count": len(values),
                 "type": TYPES[values.shape[1:]]}
        self.json["accessors"].append(entry | ({"normalized": True} if normalized else {}) | more)
        return len(self.json["accessors"]) - 1

    def view(self, values: np.ndarray, stride: int = 0) -> int:
        """Adds a buffer view with the bytes of an array."""
        rows = values.reshape(len(values), -1)
        content = rows.tobytes()
        if stride:
            content = b"".join(row.tobytes().ljust(stride, b"\xaa") for row in rows)
        self.bytes += b"\0" * (-len(self.bytes) % 4)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(content)}
                                        | ({"byteStride": stride} if stride else {}))
        self.bytes += content
        return len(self.json["bufferViews"]) - 1

    def mesh(self, vertices, triangles=None, **primitive) -> int:
        """Adds a mesh of one primitive. primitive: its other keys; those in capitals are accessors of its attributes."""
        attributes = {"POSITION": vertices if isinstance(vertices, int) else self.accessor(vertices)}
        attributes |= {name: primitive.pop(name) for name in list(primitive) if name.isupper() or name[-1].isdigit()}
        entry = {"attributes": attributes} | primitive
        if triangles is not None:
            entry["indices"] = self.accessor(np.ravel(triangles), "u2")
        self.json.setdefault("meshes", []).append({"primitives": [entry]})
        return len(self.json["meshes"]) - 1

    def animation(self, *channels, name: str | None = None) -> None:
        """Adds an animation of channels (node, path, times, values, interpolation)."""
        entry: dict = {"channels": [], "samplers": []} | ({"name": name} if name else {})
        for node, path, times, values, interpolation in channels:
            output = values if isinstance(values, int) else self.accessor(values)
            entry["samplers"].append({"input": self.accessor(times), "output": output, "interpolation": interpolation})
            entry["channels"].append({"sampler": len(entry["samplers"]) - 1, "target": {"node": node, "path": path}})
        self.json.setdefault("animations", []).append(entry)

    def glb(self) -> bytes:
        """As one binary file."""
        content = self.bytes + b"\0" * (-len(self.bytes) % 4)
        text = json.dumps(self.json | {"buffers": [{"byteLength": max(1, len(content))}, *self.other_buffers]}).encode()
        text += b" " * (-len(text) % 4)
        body = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(content), b"BIN\0") + content
        return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body

    def gltf(self, uri: str | None = None) -> str:
        """As text with its bytes in it, or in a file beside it."""
        inside = "data:application/octet-stream;base64," + base64.b64encode(self.bytes).decode()
        buffers = [{"byteLength": max(1, len(self.bytes)), "uri": uri or inside}, *self.other_buffers]
        return json.dumps(self.json | {"buffers": buffers}, indent=1)


BOX = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-1.0, 1.0) for z in (-2.0, 2.0)])
BOX_SIDES = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6],
                      [0, 6, 4], [1, 5, 7], [1, 7, 3]])


def box_file(**node) -> GltfFile:
    """A box of 1 m x 2 m x 4 m along x, y and z of the file, as the only node."""
    file = GltfFile()
    mesh = file.mesh(BOX, BOX_SIDES)
    file.json |= {"nodes": [{"name": "box", "mesh": mesh} | node], "scenes": [{"nodes": [0]}], "scene": 0}
    return file


def tube(rings: int = 9, around: int = 12, radius: float = 0.1, height: float = 2.0) -> tuple:
    """(vertices [V, 3], triangles [F, 3]) of a tube along y."""
    angles = 2 * np.pi * np.arange(around) / around
    heights = np.linspace(0.0, height, rings)
    vertices = np.array([[radius * np.cos(a), y, radius * np.sin(a)] for y in heights for a in angles])
    triangles = []
    for ring in range(rings - 1):
        for i in range(around):
            a, b = ring * around + i, ring * around + (i + 1) % around
            triangles += [[a, a + around, b], [b, a + around, b + around]]
    return vertices, np.array(triangles)


def rig_file(times=(0.0, 1.0, 2.0), interpolation: str = "LINEAR", quantised: str = "") -> GltfFile:
    """A tube along y with two bones, of which the upper one turns about z at y = 1 by 0, 90 and 0 degrees.

    quantised: type of the weights, "u1" or "u2"; "": float
    """
    vertices, triangles = tube()
    upper = np.clip(vertices[:, 1] - 0.5, 0.0, 1.0)
    file = GltfFile()
    shares = np.stack([1 - upper, upper, 0 * upper, 0 * upper], axis=1)
    most = {"u1": 255, "u2": 65535}.get(quantised, 1)
    weights = file.accessor(np.round(shares * most) if quantised else shares, quantised or "f4", normalized=bool(quantised))
    joints = file.accessor(np.tile([0, 1, 0, 0], (len(vertices), 1)), "u1")
    binds = np.tile(np.eye(4), (2, 1, 1))
    binds[1, 3, 1] = -1.0                               # column-major: the place of the elbow, taken back
    file.mesh(vertices, triangles, JOINTS_0=joints, WEIGHTS_0=weights)
    half = np.sqrt(0.5)
    turns = [[0, 0, 0, 1], [0, 0, half, half], [0, 0, 0, 1]]
    file.json |= {"skins": [{"joints": [1, 2], "inverseBindMatrices": file.accessor(binds.reshape(2, 16))}],
                  "nodes": [{"name": "tube", "mesh": 0, "skin": 0, "translation": [5, 5, 5]},
                            {"name": "lower", "children": [2]}, {"name": "upper", "translation": [0, 1, 0]}],
                  "scenes": [{"nodes": [0, 1]}]}
    file.animation((2, "rotation", times, turns, interpolation), name="bend")
    return file


def loaded(tmp_path, file: GltfFile, **options):
    path = tmp_path / "model.glb"
    path.write_bytes(file.glb())
    return ep.load_model(path, **options)
