"""Files of foreign scenes: Mitsuba, USD, frames, motion capture, MTL files beside OBJ."""
from __future__ import annotations

import tempfile
from pathlib import Path
from random import Random

import numpy as np

import echopath as ep
from fuzz.folder import memory_folder
from fuzz.foreign_seeds import seeds_by_suffix
from fuzz.mutate import damaged, mistaken

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
    folder, seeds = _folder(), seeds_by_suffix()[suffix]
    path = Path(folder.name) / f"scene{suffix}"
    for seed in seeds:
        path.write_bytes(seed)
        read_and_pose(path)
    texts = [seed.decode("latin-1") for seed in seeds]

    def case(number: int) -> None:
        random = Random(f"{suffix} {number}")
        seed = random.randrange(len(seeds))
        if suffix != ".npz" and random.random() < 0.8:
            path.write_bytes(mistaken(texts[seed], texts, random).encode("utf-8", "surrogatepass"))
        else:
            path.write_bytes(damaged(seeds[seed], random))
        read_and_pose(path, random.random() < 0.5)

    case.folder = folder
    return case


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
