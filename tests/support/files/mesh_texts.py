"""One mesh as the bytes of files of many formats."""
from __future__ import annotations

import struct

import numpy as np

from fuzz.feeds.foreign_seeds import archive


def obj(vertices, faces, name: str = "") -> bytes:
    """Also for several meshes in one file, where `faces` count from 0 in the vertices of all before."""
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()] + ([f"g {name}"] if name else [])
    return "\n".join(lines + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces.tolist()]).encode()


def obj_boxes(boxes: dict) -> str:
    """Boxes {name: (sides, middle)} in m, each an object of an OBJ file."""
    return "".join(_obj_box(name, *box, 8 * number) for number, (name, box) in enumerate(boxes.items()))


def ply(vertices, faces) -> bytes:
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\nproperty float x\nproperty float y\n"
            f"property float z\nelement face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n")
    return head.encode() + vertices.astype("<f4").tobytes() + b"".join(struct.pack("<B3i", 3, *face) for face in faces.tolist())


def stl(vertices, faces) -> bytes:
    facets = (struct.pack("<12fH", 0, 0, 0, *vertices[face].ravel(), 0) for face in faces)
    return b" " * 80 + struct.pack("<I", len(faces)) + b"".join(facets)


def stl_text(vertices, faces, name: str = "") -> bytes:
    corner = "vertex {!r} {!r} {!r}\n"
    facets = ("facet normal 0 0 0\nouter loop\n" + "".join(corner.format(*point) for point in vertices[face].tolist()) +
              "endloop\nendfacet\n" for face in faces)
    return f"solid {name}\n{''.join(facets)}endsolid {name}\n".encode()


def off(vertices, faces) -> bytes:
    lines = ["OFF", f"{len(vertices)} {len(faces)} 0"] + [f"{x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
    return "\n".join(lines + [f"3 {a} {b} {c}" for a, b, c in faces.tolist()]).encode()


def usd_mesh(vertices, faces, name: str) -> str:
    points = ", ".join(f"({x!r}, {y!r}, {z!r})" for x, y, z in vertices.tolist())
    return f"""def Mesh "{name}"
{{
    int[] faceVertexCounts = [{', '.join(['3'] * len(faces))}]
    int[] faceVertexIndices = [{', '.join(map(str, faces.ravel().tolist()))}]
    point3f[] points = [{points}]
}}
"""


def usda(vertices, faces, name: str = "ball") -> bytes:
    return f'#usda 1.0\n(\n    metersPerUnit = 1\n    upAxis = "Z"\n)\n{usd_mesh(vertices, faces, name)}'.encode()


def npz(vertices, faces) -> bytes:
    return archive(vertices=vertices[None], triangles=np.asarray(faces))


def _obj_box(name: str, sides, middle, first: int) -> str:
    """A box in an OBJ file; first: number of vertices before it."""
    corners = "".join(f"v {middle[0] + x * sides[0]} {middle[1] + y * sides[1]} {middle[2] + z * sides[2]}\n"
                      for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5))
    quads = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)]
    return f"o {name}\n{corners}" + "".join(f"f {' '.join(str(first + k) for k in quad)}\n" for quad in quads)
