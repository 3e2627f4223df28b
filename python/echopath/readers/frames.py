"""Meshes that change from frame to frame: a folder of OBJ files of one topology, or vertices over time in a .npz file."""
from __future__ import annotations

import re
import struct
import tokenize
import zipfile
import zlib
from pathlib import Path

import numpy as np

from .. import _core
from .axes import Axes
from .mesh_files import Groups, MovedPart, parts_of_frames
from .model import Model
from .normals import as_smooth
from .options import ReadOptions
from .sampled import Clock, chosen_animation, repeated
from .tree import Tree

FRAME_RATE = 30.0            # 1/s, of a folder that does not say it
MOST_BYTES = 8 * 2**30       # of all arrays of a file
NAME = "frames"              # of the one animation
RATE_FILE = "frame_rate.txt"


def read(path: Path, options: ReadOptions) -> Model:
    """A Model whose meshes are VertexSequence, cubic between the frames; the first frame is at 0 s, or where `times` has it.

    path: of a folder of .obj files, which are frames in the order of the numbers in their names, and may have a file
    frame_rate.txt with a number in 1/s; or of a .npz file with vertices [T, V, 3], triangles [F, 3], and times [T] in s or
    frame_rate in 1/s, and normals [V, 3] where it stands for a curved surface. Faces and normals are those of the first frame.
    The sequence ends with its last frame, unless it is repeated, and then goes on without end.
    """
    axes, tree = Axes(options), Tree(options)
    if path.is_dir():
        times, parts = _of_folder(path, axes, tree)
    else:
        times, parts = _of_file(path, axes, tree)
    names = (NAME,) if len(times) > 1 else ()
    animation = chosen_animation(options, names)
    clock = Clock(options, float(times[0]), float(times[-1]))
    if options.smooth is None and not any(part.smooth for part in parts):
        tree.note("no normals say that its meshes stand for curved surfaces: their facets are flat, unless smooth=True")
    if any(part.mesh.num_removed_triangles for part in parts):
        tree.note("triangles without area in the first frame are left out of all frames")
    groups = Groups(tree, parts)
    for part in parts:
        deformation = _sequence(path, times, part.vertices, clock) if animation else None
        parent, name = groups.place_of(part, part.name or (path.name if path.is_dir() else path.stem))
        tree.add(name, parent, mesh=part.mesh, deformation=deformation, foreign_material=part.material, smooth=part.smooth)
    return tree.model(format="OBJ frames" if path.is_dir() else "NPZ frames", unit=axes.unit, up=axes.up, animations=names,
                      animation=animation, duration=float(times[-1] - times[0]) if animation else 0.0)


def _mesh(path: Path, vertices, triangles) -> _core.Mesh:
    try:
        return _core.Mesh(vertices, triangles)
    except (ValueError, TypeError) as error:
        raise _core.FileError(f"{path}: {error}") from None


def _sequence(path: Path, times, vertices, clock: Clock) -> _core.VertexSequence:
    try:
        return repeated(times, vertices, clock)
    except (ValueError, TypeError) as error:
        raise _core.FileError(f"{path}: {error}") from None


# --- folders ---

def _of_folder(path: Path, axes: Axes, tree: Tree):
    """(times [T], [MovedPart]) of a folder."""
    files = sorted((file for file in path.iterdir() if file.suffix.lower() == ".obj" and file.is_file()), key=_by_number)
    if not files:
        raise _core.FileError(f"{path}: is a folder without .obj files")
    parts = parts_of_frames(files, axes)
    return np.arange(len(files)) / _frame_rate(path, len(files), tree), parts


def _by_number(file: Path) -> list:
    """A name by its words and numbers: "walk2" comes before "walk10"."""
    return [(0, int(word), "") if word.isdecimal() and len(word) < 20 else (1, 0, word)
            for word in re.split(r"([0-9]+)", file.name)]


def _frame_rate(path: Path, count: int, tree: Tree) -> float:
    file = path / RATE_FILE
    if not file.is_file():
        if count > 1:
            tree.note(f"the folder has no {RATE_FILE}: {FRAME_RATE:g} frames a second are taken")
        return FRAME_RATE
    try:
        rate = float(file.read_text(encoding="utf-8")[:100])
    except ValueError:
        rate = 0.0
    return _checked_rate(file, rate)


def _checked_rate(path: Path, rate: float) -> float:
    if not 1e-3 <= rate <= 1e6:
        raise _core.FileError(f"{path}: the frame rate must be from 0.001 to 1e6 per second, got {rate:g}")
    return rate


# --- arrays ---

def _of_file(path: Path, axes: Axes, tree: Tree):
    arrays = _arrays(path)
    vertices = _array(path, arrays, ("vertices", "verts"), 3, "f")
    triangles = _array(path, arrays, ("triangles", "faces"), 2, "iu")
    if vertices.shape[2] != 3 or not len(vertices):
        raise _core.FileError(f"{path}: vertices must be [T, V, 3], got {list(vertices.shape)}")
    if triangles.shape[1] != 3:
        raise _core.FileError(f"{path}: triangles must be [F, 3], got {list(triangles.shape)}")
    if not np.isfinite(vertices).all():
        raise _core.FileError(f"{path}: vertices must be finite")
    smooth = False
    if "normals" in arrays:
        normals = _array(path, arrays, ("normals",), 2, "f")
        if normals.shape != vertices.shape[1:]:
            raise _core.FileError(f"{path}: normals must be {list(vertices.shape[1:])}, one for each vertex, "
                                  f"got {list(normals.shape)}")
        smooth = _in_range(triangles, len(normals)) and as_smooth(vertices[0], triangles, normals[triangles])
    vertices = axes.points(vertices)
    part = MovedPart("", "", "", vertices, _mesh(path, vertices[0], triangles), smooth)
    return _times(path, arrays, len(vertices), tree), [part]


def _in_range(triangles, num_vertices: int) -> bool:
    """Whether all corners are vertices; Mesh says which is not."""
    return bool(triangles.size and triangles.min() >= 0 and triangles.max() < num_vertices)


def _times(path: Path, arrays: dict, count: int, tree: Tree) -> np.ndarray:
    if "times" in arrays:
        times = _array(path, arrays, ("times",), 1, "fiu").astype(float)
        if len(times) != count or not np.isfinite(times).all() or not (np.diff(times) > 0.0).all():
            raise _core.FileError(f"{path}: times must be {count} ascending numbers, one for each frame")
        return times
    if "frame_rate" not in arrays:
        if count > 1:
            tree.note(f"the file has neither times nor frame_rate: {FRAME_RATE:g} frames a second are taken")
        return np.arange(count) / FRAME_RATE
    rate = arrays["frame_rate"]
    if rate.size != 1 or rate.dtype.kind not in "fiu":
        raise _core.FileError(f"{path}: frame_rate must be one number in 1/s, got an array {list(rate.shape)} of {rate.dtype}")
    return np.arange(count) / _checked_rate(path, float(rate.ravel()[0]))


def _array(path: Path, arrays: dict, names: tuple, dimensions: int, kinds: str) -> np.ndarray:
    """The array of the first of some names. Raises FileError where there is none, or one of another kind."""
    found = next((arrays[name] for name in names if name in arrays), None)
    if found is None:
        raise _core.FileError(f"{path}: has no array '{names[0]}'; it has {', '.join(arrays) or 'none'}")
    if found.ndim != dimensions or found.dtype.kind not in kinds:
        raise _core.FileError(f"{path}: {names[0]} must have {dimensions} dimensions, got {list(found.shape)} of {found.dtype}")
    return found


def _arrays(path: Path) -> dict[str, np.ndarray]:
    """The arrays of a .npz file by their names. Raises FileError for anything but plain numbers."""
    try:
        with zipfile.ZipFile(path) as archive:
            members = [member for member in archive.infolist() if member.filename.endswith(".npy")]
            if sum(member.file_size for member in members) > MOST_BYTES:
                raise _core.FileError(f"{path}: has arrays of more than {MOST_BYTES} bytes")
            return {member.filename.removesuffix(".npy")[:60]: _member(path, archive, member) for member in members}
    except (OSError, EOFError, ValueError, KeyError, IndexError, TypeError, RuntimeError, NotImplementedError, SyntaxError,
            MemoryError, zipfile.BadZipFile, zlib.error, struct.error, tokenize.TokenError) as error:
        if isinstance(error, _core.FileError):
            raise
        raise _core.FileError(f"{path}: is no .npz file of plain arrays ({str(error)[:120] or type(error).__name__})") from None


def _member(path: Path, archive: zipfile.ZipFile, member) -> np.ndarray:
    with archive.open(member) as stream:
        version = np.lib.format.read_magic(stream)
        if version not in ((1, 0), (2, 0)):
            raise ValueError(f"version {version} of the format")
        read_head = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
        shape, by_column, kind = read_head(stream)
        if kind.kind not in "fiub" or any(size < 0 for size in shape):
            raise ValueError(f"'{member.filename[:60]}' holds no numbers")
        size = int(np.prod([int(one) for one in shape], dtype=object)) * kind.itemsize
        content = stream.read(size + 1) if size <= member.file_size else b""
    if len(content) != size:
        raise _core.FileError(f"{path}: the array '{member.filename[:60]}' ends too early")
    return np.frombuffer(content, kind).reshape(shape, order="F" if by_column else "C")
