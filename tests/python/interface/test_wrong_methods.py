"""Whatever is wrong with an argument of a method, an actor or an attribute of a scene's object, the error names it."""
import inspect

import matplotlib.pyplot as plt
import pytest

import echopath as ep
from support.odd_values import EXPECTED, ODD, is_named, make_radar, make_scene, refusals

SCENE, RADAR = make_scene(), make_radar()
FEWEST_WRONG = 7000
# Arguments that say of others what they lack.
OTHERS = {("add", "mesh_or_actor"): "material: must be given with a mesh", ("pedestrian", "height"): "edge: must be",
          ("runner", "height"): "edge: must be", ("standing_person", "height"): "edge: must be",
          ("of_object", "name"): "name: must be"}
FREE = {("plot", "title"), ("plot", "ax"), ("plot_labels", "title"), ("plot_detections", "title")}  # Matplotlib's own
COARSE = 0.05  # m, of the triangles of bodies
BY_NAME = {"height": 1.7, "width": 1.0, "length": 2.0, "size": 1.0, "radius": 1.0, "semi_axes": 1.0}


@pytest.fixture(scope="module")
def calls(tmp_path_factory):
    """{name: (callable, arguments that it takes)}"""
    in_time = ep.Sequence(SCENE, RADAR, frames=1, interval=0.1, num_rays=200, guard=False)
    frame = ep.simulate(SCENE, RADAR, num_rays=300, guard=False)
    families, cells = ep.families(frame.paths), ep.path_cells(frame.paths, frame.spectrum)
    folder = tmp_path_factory.mktemp("files")
    in_time.save(folder / "kept", keep="maps")
    labelled = ep.simulate(SCENE, RADAR, num_rays=300, parts={"plate": "T 'plate' R"}, labels=True, guard=False,
                           detections={"false_alarm_rate": 1e-3})
    labels, parts = labelled.labels["parts"], labelled.parts["parts"]
    return _actors() | {
        "Actor": (ep.Actor, {}), "Interferer": (ep.Interferer, {"radar": RADAR}), "Weather": (ep.Weather, {}),
        "Trajectory": (ep.Trajectory, {"points": [[0, 0], [10, 0]], "speed": 5.0}), "Scene": (ep.Scene, {}),
        "Lane": (ep.Lane, {"points": [[0, 0], [10, 0]]}), "Live": (ep.Live, {"scene": SCENE, "radar": RADAR, "num_rays": 300}),
        "Parts": (ep.Parts, {"cubes": parts, "selections": parts.selections}),
        "StoredSequence": (ep.StoredSequence, {"path": folder / "kept"}),
        "select": (frame.paths.select, {"selection": "T . R"}), "partition": (frame.paths.partition, {"parts": {"a": "T . R"}}),
        "plot_labels": (labels.plot, {}), "plot_detections": (labelled.detections.plot, {}),
        "detections_to_csv": (labelled.detections.to_csv, {"path": folder / "detections.csv"}),
        "detections_to_pcd": (labelled.detections.to_pcd, {"path": folder / "detections.pcd"}),
        "truth_to_csv": (ep.truth(frame).to_csv, {"path": folder / "truth.csv"}),
        "of_frame": (ep.truth(frame).of_frame, {"frame": 0}), "detection_paths": (labelled.detections.paths, {"i": 0}),
        "density": (ep.PhaseNoise(offsets=[1e3], levels=[-90.0]).density, {"offset": 1e3}),
        "Part": (_part, {"name": "part", "mesh": ep.actors.plate(1, 1)}),
        "draw_range_doppler": (_drawn(ep.plots.draw_range_doppler), {"spectrum": frame.spectrum}),
        "draw_labels": (_drawn(ep.plots.draw_labels), {"labels": labels}),
        "extent": (ep.spectrogram(frame).extent, {}),
        "within": (cells.within, {"range_indices": (0, 1), "velocity_indices": (0, 1)}),
        "paths_of": (families.paths_of, {"family": families.families[0]}),
        "range_azimuth_of": (frame.range_azimuth_of, {"spectrum": frame.spectrum}),
        "coplanar_overlaps": (SCENE.coplanar_overlaps, {}), "world_vertices": (SCENE.world_vertices, {"mesh_id": 0}),
        "plot": (frame.plot, {}), "save": (in_time.save, {"path": tmp_path_factory.mktemp("frames"), "keep": "maps"}),
        "add": (_add, {"mesh_or_actor": ep.actors.plate(1, 1), "name": "x", "material": "metal"})}


def _actors() -> dict:
    """Every actor but the one that reads a file."""
    made = {}
    for name in ep.actors.__all__:
        make = getattr(ep.actors, name)
        if not inspect.isclass(make) and name != "captured_pedestrian":
            taken = inspect.signature(make).parameters.values()
            right = {one.name: BY_NAME[one.name] for one in taken if one.default is one.empty}
            made[name] = (make, right | ({"edge": COARSE} if any(one.name == "edge" and one.default for one in taken) else {}))
    return made


def _part(name, mesh):
    return ep.Part(name, mesh, "metal")


def _drawn(draw):
    """The function of what it draws alone, by the same name."""
    argument = next(iter(inspect.signature(draw).parameters.values()))

    def called(**right):
        return draw(**right)

    called.__signature__ = inspect.Signature([argument.replace(kind=argument.KEYWORD_ONLY)])
    return called


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
