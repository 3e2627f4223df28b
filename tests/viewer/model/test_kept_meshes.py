"""A time line reads meshes that its files have alike once; what it shows is what each file by itself shows."""
from __future__ import annotations

import h5py
import numpy as np
import pytest

import echopath as ep
from echopath_viewer.model import from_file
from echopath_viewer.model.frames.time_line import time_line_of
from support import shapes

NUM_FILES = 3


def write_file(path, start_time: float, shift: float = 0.0, cut: int = 40):
    """A ball in two parts that drives past a plate.

    shift: m, of one corner of the plate; cut: triangles of the ball's first part
    """
    ball = shapes.sphere((0.0, 0.0, 0.0), 0.5, 2)
    plate = shapes.plate((6.0, 1.0, 0.0), (-1.0, 0.0, 0.0), 2.0)
    corners = np.array(plate.vertices)
    corners[0, 1] += shift
    scene = ep.Scene()
    scene.add(None, name="ball", position=(4.0, 0.0, 0.0), motion=ep.LinearMotion(velocity=(-3.0, 0.0, 0.0)))
    scene.add(ball.part(np.arange(cut)), name="front", parent="ball", material=shapes.lambert(0.8))
    scene.add(ball.part(np.arange(cut, len(ball.triangles))), name="back", parent="ball", material=shapes.lambert(0.8))
    scene.add(ep.Mesh(corners, plate.triangles), name="plate", material=shapes.lambert(0.5))
    ep.trace(scene, shapes.make_radar((0.0, 0.0, 0.0)), num_rays=500, seed=2, start_time=start_time).save(path)


@pytest.fixture
def files(tmp_path):
    found = [tmp_path / f"{place}.h5" for place in range(NUM_FILES)]
    for place, path in enumerate(found):
        write_file(path, 0.1 * place)
    return found


def content(view_input) -> list:
    """What is seen of it: arrays of its paths, and each mesh at its place."""
    paths, time = view_input.paths, view_input.paths.frame.trace_time
    scene = paths.scene
    return [view_input.cube, paths.amplitude, paths.points(time), paths.mesh_id, paths.triangle_id,
            *(array for mesh in scene.meshes for array in (mesh.triangles, scene.world_vertices(mesh.id, time)))]


def is_same(one: list, other: list) -> bool:
    return len(one) == len(other) and all(map(np.array_equal, one, other))


def shared_meshes(one, other) -> list:
    """For each mesh whether both have it in the same place of the memory."""
    return [np.shares_memory(mine.triangles, theirs.triangles)
            for mine, theirs in zip(one.paths.scene.meshes, other.paths.scene.meshes)]


def test_frames_of_a_film_share_their_meshes_and_show_what_their_files_show(files):
    line = time_line_of(files)
    read = [line.read(place) for place in (0, 1, 2, 1)]
    for place, view_input in zip((0, 1, 2, 1), read):
        assert is_same(content(view_input), content(from_file(files[place])))
        assert shared_meshes(read[0], view_input) == [True, True, True]
    assert not is_same(content(read[0]), content(read[1]))
    assert shared_meshes(read[0], from_file(files[0])) == [False, False, False]


@pytest.mark.parametrize("other", [{"shift": 1e-6}, {"cut": 41}])
def test_a_file_with_other_meshes_has_its_own(files, other):
    write_file(files[1], 0.1, **other)
    line = time_line_of(files)
    for place in range(NUM_FILES):
        assert is_same(content(line.read(place)), content(from_file(files[place])))


def test_meshes_that_are_shared_cannot_be_changed(files):
    line = time_line_of(files)
    mesh = line.read(0).paths.scene.meshes[0]
    with pytest.raises(ValueError, match="read-only"):
        mesh.triangles[0, 0] = 1


@pytest.mark.parametrize("item", ["0/vertices", "1/whole_triangle", "2"])
def test_a_mesh_that_a_later_file_lacks_is_told(files, item):
    with h5py.File(files[1], "a") as file:
        del file["scene/meshes"][item]
    line = time_line_of(files)
    line.read(0)
    with pytest.raises(ep.FileError, match="1.h5: .*scene/meshes"):
        line.read(1)
    assert line.read(2).paths.num_paths > 0
