"""Scenes that change: a street of twenty objects after each change is, to the last bit, the street built so from the start."""
from __future__ import annotations

import gc
import itertools
import threading
from unittest import mock

import numpy as np
import pytest

import echopath as ep
from echopath import _core
from echopath.tracing import tessellation
from support.radars import build_radar
from support.scenes.one_target import RADAR_FILE, scene_with
from support.street import ARRAYS, assert_same_bits, box_mesh, built, radar, traced


def record_bytes(paths) -> bytes:
    return b"".join(np.ascontiguousarray(getattr(paths, name)).tobytes() for name in ARRAYS)


# Each changes the scene, and the table as it would have been written from the start.
def set_position(scene, table):
    scene["box5"].position = table["box5"]["position"] = (21.0, 2.0, 0.25)


def set_yaw(scene, table):
    scene["box3"].yaw = table["box3"]["yaw"] = -1.25


def set_transform(scene, table):
    place = np.array([[1.0, 0, 0, 19], [0, 0, -1, 1], [0, 1, 0, 0.5], [0, 0, 0, 1]])
    scene["box2"].transform = place
    del table["box2"]["position"], table["box2"]["yaw"]
    table["box2"]["transform"] = place


def set_motion(scene, table):
    scene["box1"].motion = table["box1"]["motion"] = ep.LinearMotion(velocity=(3, -1, 0))


def stop_motion(scene, table):
    scene["box4"].motion = table["box4"]["motion"] = None


def stop_everything(scene, table):
    for name in ("bus", "box0", "box4", "box8", "box12"):
        scene[name].motion = table[name]["motion"] = None


def set_material(scene, table):
    scene["box6"].material = table["box6"]["material"] = ep.Material(permittivity=4 - 0.5j)


def set_material_of_group(scene, table):
    scene["bus"].material = table["bus"]["material"] = "wood"


def hide(scene, table):
    scene["bus"].visible = table["bus"]["visible"] = False


def hide_one_and_show_it(scene, table):
    scene["box7"].visible = False
    traced(scene)
    scene["box7"].visible = True


def hide_one_and_show_another(scene, table):
    scene["box7"].visible = table["box7"]["visible"] = False
    scene["box8"].visible = False
    traced(scene)
    scene["box8"].visible = True


def remove_one(scene, table):
    scene.remove("box9")
    del table["box9"]


def remove_group(scene, table):
    scene.remove("bus")
    del table["bus"]


def remove_and_add(scene, table):
    scene.remove("box9")
    table["new"] = table.pop("box9")
    keywords = dict(table["new"])
    scene.add(keywords.pop("content"), name="new", **keywords)


CHANGES = [set_position, set_yaw, set_transform, set_motion, stop_motion, stop_everything, set_material,
           set_material_of_group, hide, hide_one_and_show_it, hide_one_and_show_another, remove_one, remove_group,
           remove_and_add]


@pytest.mark.parametrize("change", CHANGES, ids=lambda change: change.__name__)
def test_a_changed_scene_is_traced_as_if_built_so(table, change):
    scene = built(table)
    assert len([name for name in scene if "/" not in name]) == 20
    for _ in range(2):  # the second trace keeps its geometry for the third
        before = traced(scene)
    change(scene, table)
    after, anew = traced(scene), traced(built(table))
    assert_same_bits(after, anew)
    assert np.array_equal(ep.synthesize(after, radar()), ep.synthesize(anew, radar()))
    if change is not hide_one_and_show_it:
        assert not all(np.array_equal(getattr(after, name), getattr(before, name)) for name in ARRAYS)


def test_paths_of_before_a_change_stay_what_they_are(table):
    scene = built(table)
    paths = traced(scene)
    cube, arrays = ep.synthesize(paths, radar()), {name: np.array(getattr(paths, name)) for name in ARRAYS}
    names = [mesh.name for mesh in paths.scene.meshes]
    effects = [(effect.name, effect.reason) for effect in paths.effects]
    for change in (set_position, set_yaw, set_motion, set_material, hide, remove_one):
        change(scene, table)
    traced(scene)
    assert np.array_equal(ep.synthesize(paths, radar()), cube)
    assert [mesh.name for mesh in paths.scene.meshes] == names
    assert [(effect.name, effect.reason) for effect in paths.effects] == effects
    for name, values in arrays.items():
        assert np.array_equal(getattr(paths, name), values)


def test_a_trace_beside_changes_of_its_scene_sees_one_state_of_it(table):
    """The record is that of the one place or of the other, to the last bit, however often the object moves meanwhile."""
    scene, places, records = built(table), ((24.0, 2.0, 0.0), (12.0, -2.0, 0.0)), []
    for place in places:
        scene["bus"].position = place
        records.append(record_bytes(traced(scene)))
    assert records[0] != records[1]
    changes, is_over = itertools.count(), threading.Event()

    def move():
        while not is_over.is_set():
            scene["bus"].position = places[next(changes) % 2]

    mover = threading.Thread(target=move)
    mover.start()
    try:
        found = [record_bytes(traced(scene)) for _ in range(8)]
    finally:
        is_over.set()
        mover.join()
    assert set(found) <= set(records) and next(changes) > len(found)


def test_paths_of_before_a_change_save_their_scene(table, tmp_path):
    scene = built(table)
    paths = traced(scene)
    scene.remove("ground")
    paths.save(tmp_path / "frame.h5")
    assert_same_bits(ep.Paths.load(tmp_path / "frame.h5"), paths)


def test_a_mesh_is_measured_once_and_forgotten_with_its_scene():
    gc.collect()
    before = len(tessellation._known)
    scene = scene_with(ep.actors.sphere(radius=1.0, subdivisions=3), position=(9, 0, 0), material="metal")
    with mock.patch.object(tessellation, "_tessellation_of", wraps=tessellation._tessellation_of) as measure:
        for _ in range(3):
            with pytest.warns(ep.TessellationWarning):
                ep.trace(scene, build_radar(), num_rays=256)
            gc.collect()
    assert measure.call_count == 1
    assert len(tessellation._known) == before + 1
    del scene, measure
    gc.collect()
    assert len(tessellation._known) == before


def test_a_table_of_meshes_forgets_those_that_are_gone():
    table, meshes = _core.MeshTable(), [box_mesh(1, 1, 1) for _ in range(200)]
    for number, mesh in enumerate(meshes):
        table.set(mesh, number)
    assert len(table) == 200 and table.get(meshes[150], None) == 150
    del meshes[:], mesh
    assert len(table) == 0
    assert table.get(box_mesh(1, 1, 1), "none") == "none"


def test_the_keywords_of_an_actor_are_looked_up_once(tmp_path):
    from echopath.scene_file import actors

    actors._parameter_table.cache_clear()
    path = tmp_path / "scene.toml"
    path.write_text(RADAR_FILE + "".join(
        f'[[objects]]\nname = "box{number}"\nactor = "box"\nparameters = {{size = [1, 1, 1]}}\nmaterial = "metal"\n'
        for number in range(30)))
    with mock.patch.object(actors, "create_model", wraps=actors.create_model) as made:
        assert len(ep.load_scene(path).scene) == 30
    assert made.call_count == 1


def test_objects_of_one_mesh_file_share_its_meshes(tmp_path):
    (tmp_path / "quad.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    path = tmp_path / "scene.toml"
    path.write_text(RADAR_FILE + "".join(
        f'[[objects]]\nname = "quad{number}"\nmesh = "quad.obj"\nunit = {unit}\nmaterial = "metal"\n'
        for number, unit in enumerate((1.0, 2.0, 1.0))))
    meshes = [mesh.mesh for mesh in ep.load_scene(path).scene.meshes]
    assert meshes[0] is meshes[2] and [mesh.area for mesh in meshes] == pytest.approx([0.5, 2.0, 0.5])
