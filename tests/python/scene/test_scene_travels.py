"""Scenes travel: copies, pickles and scenes in other processes are traced to the same bits."""
from __future__ import annotations

import copy
import multiprocessing
import pickle

import numpy as np
import pytest

import echopath as ep
from support.street import ARRAYS, assert_same_bits, box_mesh, built, street_table, traced


def changed_street() -> ep.Scene:
    """With every kind of content: groups, a walker, a skin, vertices that move, something hidden."""
    table = street_table()
    scene = built(table)
    scene.add(ep.actors.pedestrian(speed=1.4, duration=2.0), name="walker", position=(12, 1, -1), yaw=3.0)
    jelly = box_mesh(1, 1, 1)
    shaken = [np.asarray(jelly.vertices), 1.1 * np.asarray(jelly.vertices)]
    scene.add(jelly, name="jelly", position=(14, -2, 0), material="skin",
              motion=ep.VertexSequence(times=[-1.0, 1.0], vertices=shaken))
    scene["box3"].visible = False
    scene.remove("box4")
    return scene


@pytest.mark.parametrize("copied", [ep.Scene.copy, copy.copy, copy.deepcopy, ep.Scene,
                                    lambda scene: pickle.loads(pickle.dumps(scene))],
                         ids=["copy()", "copy.copy", "copy.deepcopy", "Scene()", "pickle"])
def test_copies_are_the_same_and_independent(copied):
    scene = changed_street()
    traced(scene)
    other = copied(scene)
    assert type(other) is ep.Scene and list(other) == list(scene)
    assert [mesh.name for mesh in other.meshes] == [mesh.name for mesh in scene.meshes]
    assert_same_bits(traced(other), traced(scene))
    other.remove("bus")
    other["box5"].position = (1, 2, 3)
    assert "bus" in scene and scene["box5"].position[0] == 8 + 2.5 * 5


class Street(ep.Scene):
    """A scene of a package that builds on ours, whose constructor wants something else."""

    def __init__(self, city: str):
        super().__init__(weather=ep.Weather(rain_mm_per_hour=3.0))
        self.city, self.shops = city, ["baker"]
        self.itself = self


@pytest.mark.parametrize("copied, shares", [(copy.copy, True), (copy.deepcopy, False),
                                            (lambda scene: pickle.loads(pickle.dumps(scene)), False)],
                         ids=["copy.copy", "copy.deepcopy", "pickle"])
def test_derived_scenes_are_copied_with_what_is_their_own(copied, shares):
    street = Street("Ulm")
    street.add(box_mesh(1, 1, 1), name="box", material="metal", position=(5, 0, 0))
    traces = [traced(street) for _ in range(3)]  # which remember the geometry with the scene
    other = copied(street)
    assert_same_bits(traced(other), traces[0])
    assert (type(other), other.city, other.shops) == (Street, "Ulm", ["baker"])
    assert (other.shops is street.shops) == shares
    assert other.itself is (street if shares else other)  # as Python's copies of any object
    assert other.weather == street.weather and other["box"].mesh == street["box"].mesh
    other.remove("box")
    assert "box" in street


def test_a_pickled_scene_shares_what_it_shared():
    mesh, motion = box_mesh(1, 1, 1), ep.LinearMotion(velocity=(1, 0, 0))
    scene = ep.Scene()
    for number in range(3):
        scene.add(mesh, name=f"box{number}", position=(5 + number, 0, 0), material="metal", motion=motion)
    read = pickle.loads(pickle.dumps(scene))
    assert len({id(node.mesh) for node in read.nodes}) == 1 and len({id(node.motion) for node in read.nodes}) == 1


def test_the_scene_of_paths_travels_too():
    paths = traced(changed_street())
    read = ep.Scene(pickle.loads(pickle.dumps(paths.scene)))
    assert not read["box3"].visible
    assert_same_bits(traced(read), paths)


def record_of(scene) -> dict:
    """What a worker sends back."""
    paths = traced(scene)
    return {name: np.array(getattr(paths, name)) for name in ARRAYS}


def test_a_scene_traces_in_a_spawned_process_to_the_same_bits():
    scene = changed_street()
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        there = pool.apply(record_of, (scene,))
    for name, values in record_of(scene).items():
        assert np.array_equal(values, there[name]), name


def test_a_state_of_another_kind_is_refused():
    with pytest.raises((TypeError, ValueError)):
        ep.Scene.__new__(ep.Scene).__setstate__((5,))
    node = pickle.dumps(built(street_table()).nodes[0])
    assert pickle.loads(node).name == "ground"
