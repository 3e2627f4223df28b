"""Files of foreign scenes: Mitsuba and its meshes, USD, frames, folders of frames, motion capture, MTL files beside OBJ."""
from __future__ import annotations

import struct
import tempfile
import zlib
from functools import partial
from pathlib import Path
from random import Random

import numpy as np

import echopath as ep
from fuzz.feeds.foreign_seeds import frame_text, seeds_of
from fuzz.folder import memory_folder
from fuzz.mutate import damaged, mistaken
from fuzz.usd_trials import fork_trials

BINARY = (".npz", ".usdc", ".usdz")
SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


def _folder() -> tempfile.TemporaryDirectory:
    folder = memory_folder()
    base = Path(folder.name)
    (base / "wall.obj").write_text(SQUARE + "usemtl brick\nf 1 2 3\nusemtl glass\nf 1 3 4\n")
    (base / "wall.ply").write_text("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                                   "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                                   "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    (base / "more.xml").write_text('<scene version="3.0.0"><shape type="rectangle" id="more"/></scene>')
    return folder


def feed_foreign(suffix: str):
    """Cases of one kind of file: a model that a scene takes, or an error that names the file."""
    if suffix.startswith(".usd"):
        fork_trials()
    folder, seeds = _folder(), seeds_of(suffix)
    path = Path(folder.name) / f"scene{suffix}"
    for seed in seeds:
        path.write_bytes(seed)
        read_and_pose(path)

    def case(number: int) -> None:
        random = Random(f"{suffix} {number}")
        path.write_bytes(_changed(seeds, random, is_text=suffix not in BINARY))
        read_and_pose(path, random.random() < 0.5)

    case.folder, case.seeds, case.file, case.read = folder, seeds, path, partial(read_and_pose, path)
    return case


def feed_frames_folder():
    """Cases in which one of three frames of a folder has mistakes, or the file that says their rate."""
    folder = memory_folder()
    walk = Path(folder.name) / "walk"
    walk.mkdir()
    files = [*(walk / f"f{number}.obj" for number in (1, 2, 3)), walk / "frame_rate.txt"]
    seeds = [frame_text(0.1 * number) for number in range(3)]
    contents = [*seeds, b"25\n"]

    def case(number: int) -> None:
        random = Random(f"frames_folder {number}")
        for file, content in zip(files, contents):
            file.write_bytes(content)
        random.choice(files).write_bytes(_changed(seeds, random))
        read_and_pose(walk, random.random() < 0.5)

    for file, content in zip(files, contents):
        file.write_bytes(content)
    case.folder, case.seeds, case.file, case.read = folder, seeds, files[1], partial(read_and_pose, walk)
    return case


def feed_mtl():
    """Cases in which an MTL file, or the line that names it, has mistakes."""
    folder = memory_folder()
    mesh, library = Path(folder.name) / "scene.obj", Path(folder.name) / "scene.mtl"
    text = ("mtllib scene.mtl\n" + SQUARE + "usemtl brick wall\nf 1 2 3\nusemtl glass\nf 1 3 4\n").encode()
    seeds = [b"newmtl brick wall\nKd 1 0 0\nmap_Kd brick.png\n\nnewmtl glass\nd 0.5\n", b"# none\nnewmtl\n"]

    def case(number: int) -> None:
        random = Random(f"mtl {number}")
        mesh.write_bytes(_changed([text], random) if random.random() < 0.3 else text)
        library.write_bytes(_changed(seeds, random))
        read_and_pose(mesh)

    mesh.write_bytes(text)
    case.folder, case.seeds, case.file, case.read = folder, seeds, library, partial(read_and_pose, mesh)
    return case


def feed_serialized():
    """Cases in which a mesh file of Mitsuba is damaged, or the stream that it has compressed."""
    folder = memory_folder()
    scene, mesh = Path(folder.name) / "scene.xml", Path(folder.name) / "some.serialized"
    scene.write_text('<scene version="0.6.0"><shape type="serialized"><string name="filename" value="some.serialized"/>'
                     "</shape></scene>")
    corners, numbers = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float), struct.pack("<QQ", 4, 4)
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], "<u4").tobytes()
    streams = {4: struct.pack("<I", 0x1001) + b"tip\0" + numbers + 2 * corners.astype("<f4").tobytes() + faces,
               3: struct.pack("<I", 0x2000) + numbers + corners.tobytes() + faces}

    def packed(version: int, stream: bytes) -> bytes:
        ends = struct.pack("<QI" if version == 4 else "<II", 0, 1)
        return struct.pack("<HH", 0x041C, version) + zlib.compress(stream) + ends

    def case(number: int) -> None:
        random = Random(f"serialized {number}")
        version, stream = random.choice(list(streams.items()))
        within = random.random() < 0.7
        content = packed(version, damaged(stream, random) if within else stream)
        mesh.write_bytes(content if within else damaged(content, random))
        read_and_pose(scene)

    seeds = [packed(*one) for one in streams.items()]
    for seed in seeds:
        mesh.write_bytes(seed)
        assert ep.load_model(scene).num_triangles == 4
    case.folder, case.seeds, case.file, case.read = folder, seeds, mesh, partial(read_and_pose, scene)
    return case


def _changed(seeds: list[bytes], random: Random, is_text: bool = True) -> bytes:
    """One of the seeds with mistakes, or damaged."""
    seed = random.choice(seeds)
    if is_text and random.random() < 0.8:
        texts = [one.decode("latin-1") for one in seeds]
        return mistaken(seed.decode("latin-1"), texts, random).encode("utf-8", "surrogatepass")
    return damaged(seed, random)


def read_and_pose(path: Path, loop: bool = False) -> None:
    """Reads a file and poses what it holds, unless it is refused by name; a loop goes on for ever."""
    try:
        model = ep.load_model(path, loop=loop)
    except ep.FileError as error:
        assert str(path.parent) in str(error), f"names no file: {error}"
        return
    scene = ep.Scene()
    scene.add(model, name="model")
    if model.num_triangles < 1_000_000 and len(model.nodes) < 10_000:
        for mesh in scene.meshes:
            for time in (0.0, 1234.5) if loop and path.suffix != ".bvh" else (0.0,):
                assert np.isfinite(scene.world_vertices(mesh.id, time)).all(), "vertices are finite"
