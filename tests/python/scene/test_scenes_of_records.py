"""Scenes of records, which do not change, are looked at as those that were traced."""
import numpy as np
import pytest

import echopath as ep
from support.shapes import METAL, rectangle, scene_of


def make_radar():
    chirps = ep.ChirpSequence(start_frequency=24e9, bandwidth=250e6, num_samples=32, sampling_rate=5e6, num_chirps=2)
    return ep.Radar(chirps, transmitters=[ep.Antenna((0, 0, 1))], receivers=[ep.Antenna((0, 0.01, 1))])


@pytest.fixture(scope="module")
def hidden_plate():
    """A scene with a plate behind a screen, and that of its record."""
    scene = ep.Scene()
    scene.add(ep.actors.plate(1.0, 1.0), name="screen", material="metal", position=(4, 0, 1), yaw=np.pi)
    scene.add(ep.actors.plate(0.3, 0.3), name="plate", material="metal", position=(6, 0, 1), yaw=np.pi)
    return scene, ep.trace(scene, make_radar(), num_rays=500).scene


@pytest.mark.parametrize("look", [
    ep.find_objects, lambda scene, radar: ep.around_corners(scene, radar, num_rays=200),
    lambda scene, radar: ep.synthesize_around_corners(scene, radar, num_rays=200).tolist()],
    ids=["find_objects", "around_corners", "synthesize_around_corners"])
def test_what_looks_at_scenes_takes_those_of_records(hidden_plate, look):
    scene, record = hidden_plate
    found = look(record, make_radar())
    assert found and found == look(scene, make_radar())


def test_cavities_are_found_in_scenes_of_records():
    half, depth = 0.025, np.array([-0.03, 0, 0])
    corners = [np.array([0, y, z]) for y, z in ((-half, -half), (half, -half), (half, half), (-half, half))]
    walls = {f"duct_{k}": (rectangle(one, other - one, depth), METAL)
             for k, (one, other) in enumerate(zip(corners, corners[1:] + corners[:1]))}
    scene = scene_of(rear=(rectangle(corners[0] + depth, corners[1] - corners[0], corners[3] - corners[0]), METAL), **walls)
    cavity = ep.Cavity((*walls, "rear"), corners)
    record = ep.trace(scene, make_radar(), num_rays=500).scene
    settings = dict(frequency=6e9, incidence=(1, 0.2, 0.1), num_rays=500, cavities=cavity)
    assert ep.rcs(record, **settings) == ep.rcs(scene, **settings) > 0.0


def test_what_changes_scenes_says_how_one_of_a_record_is_copied(hidden_plate):
    for change in (ep.adapt_materials, ep.mark_mirrors):
        with pytest.raises(TypeError, match=r"scene: must be a Scene that can be changed \(ep.Scene\(scene\) copies"):
            change(hidden_plate[1], make_radar())
    assert ep.mark_mirrors(ep.Scene(hidden_plate[1]), make_radar()) == ("screen",)
