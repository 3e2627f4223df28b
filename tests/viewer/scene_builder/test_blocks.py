"""Scenes as blocks of pyvista: named, at a time, with what their materials are."""
import numpy as np
import pytest

import echopath as ep

SPEED, TIME = 3.0, 2.0  # m/s, s


@pytest.fixture(scope="module")
def scene():
    scene = ep.Scene()
    scene.add(None, name="street")
    scene.add(ep.actors.plate(2.0, 1.0), name="wall", parent="street", material="concrete", position=(5, 0, 0))
    scene.add(ep.actors.plate(0.5, 0.5), name="car", material=ep.Material.metal(mirror=True),
              motion=ep.LinearMotion(velocity=(SPEED, 0, 0)))
    return scene


def test_blocks_have_the_full_names_and_the_points_of_the_meshes(scene):
    blocks = scene.to_pyvista(TIME)
    assert blocks.keys() == [mesh.name for mesh in scene.meshes] == ["street/wall", "car"]
    for mesh in scene.meshes:
        block = blocks[mesh.name]
        assert np.array_equal(block.points, scene.world_vertices(mesh.id, TIME)) and block.points.dtype == np.float64
        assert np.array_equal(block.regular_faces, mesh.triangles)
        assert block.area == pytest.approx(mesh.mesh.area, rel=1e-12)
    assert blocks["car"].center[0] == pytest.approx(SPEED * TIME)


def test_materials_are_field_data(scene):
    blocks = scene.to_pyvista()
    concrete = ep.materials["concrete"]
    wall, car = blocks["street/wall"].field_data, blocks["car"].field_data
    assert list(wall["material"]) == ["concrete"] and list(wall["conductor"]) == [0]
    assert list(wall["permittivity"]) == [concrete.permittivity.real, concrete.permittivity.imag]
    assert list(car["conductor"]) == [1] and list(car["mirror"]) == [1] and "permittivity" not in car.keys()
    assert [int(blocks[mesh.name].field_data["mesh_id"][0]) for mesh in scene.meshes] == [0, 1]


def test_blocks_go_back_into_a_scene(scene):
    for mesh in scene.meshes:
        assert ep.mesh_from(scene.to_pyvista()[mesh.name]).area == pytest.approx(mesh.mesh.area, rel=1e-12)


def test_what_is_absent_has_no_block():
    scene = ep.Scene()
    for name in ("guest", "host"):
        scene.add(ep.actors.plate(1.0, 1.0), name=name, material="metal")
    scene["guest"].lifetime = 1.0, 3.0
    assert [scene.to_pyvista(time).keys() for time in (0.0, TIME)] == [["host"], ["guest", "host"]]
    assert list(scene.to_pyvista()["host"].field_data["mesh_id"]) == [0]
