"""Whatever is wrong with an argument of a method, an actor or an attribute of a scene's object, the error names it."""
import inspect

import matplotlib.pyplot as plt
import pytest

import echopath as ep
from support.odd_values import EXPECTED, ODD, is_named, make_radar, make_scene, refusals

SCENE, RADAR = make_scene(), make_radar()
FEWEST_WRONG = 1700
# Arguments that say of others what they lack.
OTHERS = {("add", "mesh_or_actor"): "material: must be given with a mesh", ("pedestrian", "height"): "speed: must be"}
FREE = {("plot", "title"), ("plot", "ax")}  # Matplotlib's own


@pytest.fixture(scope="module")
def calls(tmp_path_factory):
    """{name: (callable, arguments that it takes)}"""
    in_time = ep.Sequence(SCENE, RADAR, frames=1, interval=0.1, num_rays=200, guard=False)
    frame = ep.simulate(SCENE, RADAR, num_rays=300, guard=False)
    families, cells = ep.families(frame.paths), ep.path_cells(frame.paths, frame.spectrum)
    actors = {"pedestrian": {"height": 1.7}, "plate": {"width": 1, "height": 1}, "box": {"size": 1}, "ground": {"size": 1},
              "wall": {"length": 1, "height": 1}, "sphere": {"radius": 1}, "ellipsoid": {"semi_axes": 1},
              "capsule": {"radius": 1, "length": 2}, "trihedral": {"size": 1}, "dihedral": {"size": 1}}
    return {name: (getattr(ep.actors, name), right) for name, right in actors.items()} | {
        "within": (cells.within, {"range_indices": (0, 1), "velocity_indices": (0, 1)}),
        "paths_of": (families.paths_of, {"family": families.families[0]}),
        "range_azimuth_of": (frame.range_azimuth_of, {"spectrum": frame.spectrum}),
        "coplanar_overlaps": (SCENE.coplanar_overlaps, {}), "world_vertices": (SCENE.world_vertices, {"mesh_id": 0}),
        "plot": (frame.plot, {}), "save": (in_time.save, {"folder": tmp_path_factory.mktemp("frames"), "keep": "maps"}),
        "add": (_add, {"mesh_or_actor": ep.actors.plate(1, 1), "name": "x", "material": "metal"})}


def _add(**arguments):
    ep.Scene(SCENE).add(**arguments)


def _closing(function):
    """The function, which leaves no picture open."""
    def called(**arguments):
        try:
            function(**arguments)
        finally:
            plt.close("all")

    return called


def _is_told(name: str, argument: str, value, error: Exception) -> bool:
    return is_named(argument, value, error) or OTHERS.get((name, argument), "\0") in str(error)


def faults(name: str, function, right: dict) -> tuple[list, int]:
    """(argument, odd value, error) of those that do not name the argument; and how many were refused."""
    owner = ep.Scene.add if name == "add" else function
    arguments = [one for one in inspect.signature(owner).parameters if one != "self" and (name, one) not in FREE]
    found = [(not _is_told(name, argument, value, error), (name, argument, odd, repr(error)))
             for argument, odd, value, error in refusals(_closing(function), right, arguments)]
    return [fault for is_fault, fault in found if is_fault], len(found)


@pytest.mark.filterwarnings("ignore")
def test_wrong_arguments_of_methods_and_actors_are_named(calls, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    found, total = [], 0
    for name, (function, right) in calls.items():
        bad, wrong = faults(name, function, right)
        found, total = found + bad, total + wrong
    assert not found, "\n".join(map(str, found))
    assert total > FEWEST_WRONG


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("attribute", ["position", "yaw", "transform", "motion", "material", "visible"])
def test_wrong_attributes_of_objects_are_named(attribute):
    refused = 0
    for make in ODD.values():
        scene, value = ep.Scene(SCENE), make()
        try:
            setattr(scene["plate"], attribute, value)
        except EXPECTED as error:
            assert is_named(attribute, value, error), repr(error)
            refused += 1
    assert refused > 30
