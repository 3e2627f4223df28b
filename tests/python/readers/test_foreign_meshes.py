"""Meshes of trimesh, meshio and pyvista, made by these libraries themselves."""
from types import SimpleNamespace

import meshio
import numpy as np
import pytest
import trimesh

import echopath as ep

CORNERS = np.array([[0, 0, 0], [2, 0, 0], [2, 1, 0], [0, 1, 0], [0, 0, 3], [2, 0, 3], [2, 1, 3], [0, 1, 3]], float)
QUADS = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
AREA = 2 * (2 * 1 + 2 * 3 + 1 * 3)  # m^2, of a box of 2 x 1 x 3 m
ROUNDING = 1e-12


def centroids(mesh):
    return mesh.vertices[mesh.triangles].mean(axis=1)


def test_a_box_of_trimesh_is_that_box():
    box = trimesh.creation.box((2.0, 1.0, 3.0))
    mesh = ep.mesh_from(box)
    assert mesh.is_closed and mesh.area == pytest.approx(box.area, rel=ROUNDING) == pytest.approx(AREA)
    assert np.allclose(sorted(map(tuple, centroids(mesh))), sorted(map(tuple, box.triangles_center)), atol=ROUNDING)
    unsigned = SimpleNamespace(vertices=box.vertices, faces=np.asarray(box.faces, np.uint64))
    assert ep.mesh_from(unsigned) == mesh


def test_quads_of_meshio_are_cut_and_name_their_faces():
    mesh = ep.mesh_from(meshio.Mesh(CORNERS, [("vertex", [[0]]), ("quad", QUADS[:4]), ("line", [[0, 1]]), ("quad", QUADS[4:])]))
    assert mesh.is_closed and mesh.area == pytest.approx(AREA, rel=ROUNDING)
    assert sorted(mesh.original_triangle) == [face for face in range(6) for _ in range(2)]
    for centre, face in zip(centroids(mesh), mesh.original_triangle):
        axis = np.ptp(CORNERS[QUADS[face]], axis=0).argmin()
        assert centre[axis] == pytest.approx(CORNERS[QUADS[face][0]][axis], abs=ROUNDING)


def test_files_of_meshio_and_load_mesh_agree(tmp_path):
    hook = np.array([[0, 0, 0], [3, 0, 0], [3, 3, 0], [2, 3, 0], [2, 1, 0], [0, 1, 0]], float)  # a polygon with a notch
    lines = [f"v {x} {y} {z}" for x, y, z in hook] + ["f 1 2 3 4 5 6"]
    (tmp_path / "hook.obj").write_text("\n".join(lines) + "\n")
    ours = ep.load_mesh(tmp_path / "hook.obj")
    theirs = ep.mesh_from(meshio.Mesh(hook, [("polygon", [[0, 1, 2, 3, 4, 5]])]))
    assert ours.area == pytest.approx(5.0, rel=ROUNDING)
    assert np.array_equal(theirs.vertices, ours.vertices) and np.array_equal(theirs.triangles, ours.triangles)
    assert np.array_equal(theirs.original_triangle, ours.original_triangle)


def test_polydata_of_pyvista_with_faces_of_all_sizes_and_strips():
    pyvista = pytest.importorskip("pyvista")
    assert ep.mesh_from(pyvista.Box((0, 2, 0, 1, 0, 3))).area == pytest.approx(AREA, rel=1e-6)
    faces = [4, 0, 3, 2, 1, 3, 4, 5, 6, 3, 4, 6, 7]
    mesh = ep.mesh_from(pyvista.PolyData(CORNERS, faces))
    assert mesh.area == pytest.approx(4.0, rel=ROUNDING) and list(mesh.original_triangle) == [0, 0, 1, 2]
    strips = pyvista.PolyData(CORNERS, strips=[4, 0, 1, 3, 2])
    assert ep.mesh_from(strips).area == pytest.approx(2.0, rel=ROUNDING)


def test_units_are_metres_per_unit():
    in_millimetres = trimesh.creation.box((2000.0, 1000.0, 3000.0))
    assert ep.mesh_from(in_millimetres, unit=1e-3).area == pytest.approx(AREA, rel=ROUNDING)


def test_a_mesh_of_another_library_is_traced_as_our_own():
    ball = trimesh.creation.icosphere(subdivisions=3, radius=0.3)
    radar = ep.Radar(ep.ChirpSequence(start_frequency=10e9, bandwidth=1e9, num_samples=64, sampling_rate=5e6, num_chirps=4,
                                      chirp_interval=1e-4), transmitters=[ep.Antenna()], receivers=[ep.Antenna()])
    weights = []
    for mesh in (ep.mesh_from(ball), ep.Mesh(ball.vertices, ball.faces)):
        scene = ep.Scene()
        scene.add(mesh, name="ball", material="metal", position=(5, 0, 0))
        weights.append(ep.trace(scene, radar, num_rays=500).weight.tobytes())
    assert weights[0] == weights[1]


def soup(**changes):
    return SimpleNamespace(**{"vertices": CORNERS, "faces": np.array(QUADS)} | changes)


@pytest.mark.parametrize("source, error", [
    (soup(vertices=np.where(CORNERS == 3.0, np.nan, CORNERS)), r"vertices must be finite, got \[0.0, 0.0, nan\] at vertex 4"),
    (soup(vertices=CORNERS[:, :2]), r"vertices must be \[V, 3\], got \[8, 2\]"),
    (soup(faces=np.array([[0, 1, 8]])), "corners must be 0 to 7, the vertices, got 8"),
    (soup(faces=np.array([[0, 1, -1]])), "corners must be 0 to 7, the vertices, got -1"),
    (soup(faces=np.array([[0, 1]])), "faces must have 3 corners or more, got one of 2"),
    (soup(faces=np.array([[0.0, 1.0, 2.0]])), "faces must be integers"),
    (soup(faces=np.zeros((0, 3), int)), "must have faces, got none"),
    (meshio.Mesh(CORNERS, [("tetra", [[0, 1, 2, 4]])]), "cells must be triangles, quads or polygons, got 'tetra'"),
])
def test_bad_meshes_are_refused_by_name(source, error):
    with pytest.raises(ValueError, match=f"source: {error}"):
        ep.mesh_from(source)


def polydata(faces):
    return SimpleNamespace(points=CORNERS, faces=faces)


@pytest.mark.parametrize("faces, error", [
    ([3, 0, 1, 2, -1, 3, 0, 1, 2], "faces must begin with their number of corners, got -1 at 4"),
    ([3, 0, 1, 2, -3, 0, 1, 2], "faces must begin with their number of corners, got -3 at 4"),
    ([3, 0, 1, 2, 4, 0, 1], "faces must have as many corners as they say, the last lacks 2"),
    ([3.0, 0.0, 1.0, 2.0], r"faces must be integers \[N\], counts and corners, got float64 \[4\]"),
    ([[3, 0, 1, 2]], r"faces must be integers \[N\], counts and corners, got int64 \[1, 4\]"),
    ([0], "faces must have 3 corners or more, got one of 0"),
    ([], "must have faces, got none"),
])
def test_tables_of_faces_that_lead_nowhere_are_refused_at_once(faces, error):
    with pytest.raises(ValueError, match=f"source: {error}"):
        ep.mesh_from(polydata(faces))


def test_other_objects_and_units_are_refused_by_name():
    with pytest.raises(TypeError, match="source: must be a mesh of trimesh, meshio or pyvista .* got str"):
        ep.mesh_from("car.obj")
    with pytest.raises(ValueError, match="unit: must be a finite number from 1e-12 to 1000000000 m, got 0"):
        ep.mesh_from(soup(), unit=0)
