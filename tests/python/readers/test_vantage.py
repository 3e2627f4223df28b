"""Where `echopath scene` puts the radar: it looks at what is there."""
from __future__ import annotations

import numpy as np
import pytest

import echopath as ep
from echopath.cli import report
from echopath.scene.found_objects import things_of
from echopath.scene_file.sight import best_sight
from echopath.scene_file.vantage import vantage


@pytest.mark.parametrize("bodies", [[(12.0, 2.0), (8.0, -2.0)], [(70.0, -15.0)], [(41.0, 19.0)]])
def test_on_an_open_field_it_looks_at_what_stands_there(bodies):
    scene = ep.Scene()
    scene.add(ep.actors.ground((80.0, 40.0)), name="field", material="asphalt", position=(40.0, 0.0, 0.0))
    for number, place in enumerate(bodies):
        scene.add(ep.actors.sphere(1.0), name=f"ball_{number}", material="metal", position=(*place, 1.0))
    found = vantage(scene)
    ways = np.array(bodies) - found.position[:2]
    bearings = np.degrees(np.arctan2(ways[:, 1], ways[:, 0])) - found.yaw
    assert found.is_within and np.abs((bearings + 180.0) % 360.0 - 180.0).min() < 15.0


def test_land_on_which_nothing_stands_is_looked_at_from_its_middle_without_a_warning(recwarn):
    scene = ep.Scene()
    scene.add(ep.actors.ground((80.0, 40.0)), name="field", material="asphalt", position=(40.0, 0.0, 0.0))
    found = vantage(scene)
    assert not recwarn.list and found.is_within and found.yaw == 0.0
    assert found.position == pytest.approx([40.0, 0.0, 1.5], abs=1.0)  # within two cells


def test_a_scene_without_meshes_is_refused():
    with pytest.raises(ValueError, match="scene: must be a Scene with meshes to look at, got Scene"):
        vantage(ep.Scene())


def test_between_walls_it_looks_along_the_street_at_what_stands_in_it():
    scene = ep.Scene()
    scene.add(ep.actors.ground((130.0, 60.0)), name="field", material="asphalt")
    for name, side in (("left", 8.0), ("right", -8.0)):
        scene.add(ep.actors.box((80.0, 0.3, 5.0)), name=name, material="concrete", position=(0.0, side, 2.5))
    bins = {f"bin_{number}": (-20.0 + 8.0 * number, 5.0 if number % 2 else -5.0) for number in range(6)}
    for name, place in bins.items():
        scene.add(ep.actors.box((0.8, 0.8, 1.1)), name=name, material="metal", position=(*place, 0.6))
    things = things_of(scene)
    assert set(things) == set(bins)
    found = vantage(scene, things)
    x, y, z = found.position
    assert abs(x) < 40.0 and abs(y) < 8.0 and z == pytest.approx(1.5)
    ways = np.array(list(bins.values())) - (x, y)
    off_axis = (np.degrees(np.arctan2(ways[:, 1], ways[:, 0])) - found.yaw + 180.0) % 360.0 - 180.0
    assert np.count_nonzero(np.abs(off_axis) < 50.0) >= 4


def test_what_stands_behind_a_wall_is_not_in_sight():
    blocked = np.zeros((60, 40), bool)
    blocked[:, 20] = True            # a wall along the rows
    blocked[29:31, 30:32] = True     # one thing on its far side
    thing = np.array([[[29.0, 30.0], [31.0, 32.0]]])
    free = np.argwhere(~blocked)
    found = best_sight(blocked, free, 1.0, thing)
    assert found.column > 20
    assert best_sight(blocked, free[free[:, 1] < 20], 1.0, thing) is None


def test_a_radar_that_looks_away_is_told_that_no_path_has_power():
    pattern = ep.CosinePower(2.0)
    waveform = ep.ChirpSequence(start_frequency=77e9, num_samples=32, num_chirps=4)
    radar = ep.Radar(waveform, transmitters=[ep.Antenna((0.0, 0.0, 1.0), pattern=pattern)],
                     receivers=[ep.Antenna((0.0, 0.01, 1.0), pattern=pattern)])
    for ahead, told in ((-8.0, "no path has any power: the antennas look away"), (8.0, "resolved to 0.3 dB")):
        scene = ep.Scene()
        scene.add(ep.actors.plate(2.0, 2.0), name="plate", material="concrete", position=(ahead, 0.0, 1.0))
        paths = ep.trace(scene, radar, num_rays=20_000)
        assert report.unresolved(ep.unresolved(paths), paths)[0].startswith(told)


def room_of(is_one_mesh, *, furniture=True, side=5.0):
    """A room of side x 4 x 2.5 m about the z axis: a box, or walls with a thickness, and a cupboard and a table in it."""
    scene = ep.Scene()
    if is_one_mesh:
        scene.add(ep.actors.box((side, 4.0, 2.5)), name="room", material="concrete", position=(0.0, 0.0, 1.25))
    else:
        for name, size, place in (("floor", (side, 4.0, 0.1), (0.0, 0.0, -0.05)), ("ceiling", (side, 4.0, 0.1), (0.0, 0.0, 2.55)),
                                  ("left", (side, 0.1, 2.5), (0.0, 2.05, 1.25)), ("right", (side, 0.1, 2.5), (0.0, -2.05, 1.25)),
                                  ("far", (0.1, 4.2, 2.5), (side / 2 + 0.05, 0.0, 1.25)),
                                  ("near", (0.1, 4.2, 2.5), (-side / 2 - 0.05, 0.0, 1.25))):
            scene.add(ep.actors.box(size), name=name, material="concrete", position=place)
    if furniture:
        scene.add(ep.actors.box((0.6, 0.8, 1.8)), name="cupboard", material="wood", position=(0.3 * side, -1.4, 0.91))
        scene.add(ep.actors.box((1.2, 0.8, 0.04)), name="table", material="wood", position=(0.1 * side, 0.9, 0.75))
    return scene


@pytest.mark.parametrize("is_one_mesh", [True, False])
def test_in_a_room_it_stands_within_and_looks_at_what_stands_there(is_one_mesh):
    found = vantage(room_of(is_one_mesh))
    x, y, z = found.position
    assert found.is_within and abs(x) < 2.4 and abs(y) < 1.9 and 1.0 < z < 2.0 and found.reach > np.hypot(5.0, 4.0)
    ways = np.array([(1.5, -1.4), (0.5, 0.9)]) - (x, y)
    off_axis = (np.degrees(np.arctan2(ways[:, 1], ways[:, 0])) - found.yaw + 180.0) % 360.0 - 180.0
    assert np.abs(off_axis).min() < 50.0


@pytest.mark.parametrize("scene", [
    room_of(True, furniture=False),                                   # a block, for all that is seen of it
    room_of(True, side=1.8)], ids=["nothing in it", "no wider than a car"])
def test_what_is_closed_but_no_room_is_looked_at_from_outside(scene):
    found = vantage(scene)
    assert not found.is_within and found.position[0] < -3.0


@pytest.mark.parametrize("actor", [ep.actors.truck, ep.actors.van, ep.actors.car], ids=["truck", "van", "car"])
def test_vehicles_are_no_rooms(actor):
    scene = ep.Scene()
    scene.add(actor(), name="vehicle")
    assert not vantage(scene).is_within


def test_what_has_a_gap_in_its_wall_is_looked_at_from_outside():
    scene = room_of(False)
    scene.remove("near")
    assert not vantage(scene).is_within
