"""Which objects a radar can see, against geometry."""
import gc

import numpy as np
import pytest

import echopath as ep
from echopath.paths.visibility import _KEPT, FRAME_PLACES, appearing_in_frame, visibility_in_trace
from echopath.tracing.traces import keep_geometry
from support.radars import build_radar

SHARE_ERROR = 1e-3  # of 4096 directions: 24 plates behind screens at random had 4e-4 rms, 9e-4 at most
EXTENT = 1e-6  # m: rays in single precision meet a plane


def radar_at(position, **antenna):
    antennas = [ep.Antenna(position, **antenna)]
    return build_radar(antennas, antennas, num_samples=16, sampling_rate=1e6, num_chirps=2)


def person_and_car(gap):
    """A person whose middle is `gap` m aside of the middle of a box as large as a van, 2 m wide, before it."""
    scene = ep.Scene()
    scene.add(ep.actors.ground((60.0, 40.0)), name="ground", material="asphalt")
    scene.add(ep.actors.box((4.0, 2.0, 2.4)), name="car", material="metal", position=(8.0, 0.0, 1.2))
    scene.add(ep.actors.pedestrian(height=1.7), name="person", position=(12.0, gap, 0.0))
    return scene


def test_a_person_behind_a_car_is_hidden_by_it():
    seen = {sight.name: sight for sight in ep.visibility(person_and_car(gap=0.0), radar_at((0, 0, 0.6)))}
    assert list(seen) == ["car", "person"]
    assert seen["person"].visible_share == 0.0 and seen["person"].occluders == {"car": 1.0}
    assert seen["person"].in_view and 11.0 < seen["person"].distance < 12.0
    assert seen["car"].visible_share == 1.0 and seen["car"].distance == pytest.approx(6.0, abs=EXTENT)
    assert repr(seen["person"]).startswith("<ObjectVisibility person: 0.0% visible, 100.0% behind car, 11.")


def test_beside_the_car_the_person_is_seen():
    person = ep.visibility(person_and_car(gap=4.0), radar_at((0, 0, 0.6)))[1]
    assert person.visible_share == 1.0 and person.occluders == {}
    assert person.transmitter == person.receiver


def test_a_low_wall_hides_half_of_a_door():
    """Named parts may be objects; a part may hide another one, but an object not itself."""
    scene = ep.Scene()
    scene.add(ep.actors.plate(4.0, 1.0), name="low wall", material="concrete", position=(6.0, 0.0, 0.5))
    scene.add(ep.actors.plate(1.0, 2.0), name="door", material="metal", position=(6.001, 0.0, 1.0))
    radar = radar_at((0, 0, 1.0))
    door, = ep.visibility(scene, radar, ["door"], num_directions=20_000)
    assert door.visible_share == pytest.approx(0.5, abs=SHARE_ERROR)
    assert door.occluders == {"low wall": pytest.approx(0.5, abs=SHARE_ERROR)}
    both, = ep.visibility(scene, radar, {"all": ["door", "low wall"]})
    assert both.name == "all" and both.visible_share == 1.0


def test_antennas_that_look_away_have_it_out_of_view():
    scene = ep.Scene()
    scene.add(ep.actors.plate(1.0, 1.0), name="plate", material="metal", position=(-8.0, 0.0, 1.0))
    sight, = ep.visibility(scene, radar_at((0, 0, 1), pattern=ep.CosinePower(exponent=2.0)))
    assert not sight.in_view and sight.visible_share == 1.0 and "out of view" in repr(sight)


def test_time_moves_what_hides():
    scene = ep.Scene()
    scene.add(ep.actors.plate(1.0, 1.0), name="plate", material="metal", position=(10.0, 0.0, 0.0))
    scene.add(ep.actors.plate(2.0, 2.0), name="screen", material="metal", position=(5.0, 0.0, 0.0),
              motion=ep.LinearMotion(velocity=(0.0, 10.0, 0.0)))
    shares = [ep.visibility(scene, radar_at((0, 0, 0)), ["plate"], time=time)[0].visible_share for time in (0.0, 0.1, 0.2)]
    # The screen's near edge is at y = 10 t - 1; the plate's shadow at 5 m reaches from -0.25 m to 0.25 m.
    assert shares == [0.0, pytest.approx(0.5, abs=SHARE_ERROR), 1.0]


def test_bad_objects_are_named():
    with pytest.raises(ValueError, match="nearest names: car"):
        ep.visibility(person_and_car(0.0), radar_at((0, 0, 0.6)), ["cart"])
    with pytest.raises(ValueError, match="num_directions: must be a whole number from 1 to 16777216, got 0"):
        ep.visibility(person_and_car(0.0), radar_at((0, 0, 0.6)), num_directions=0)


def test_what_appears_within_a_frame_leaves_the_next_trace_as_it_is():
    """A screen drives aside and bares one plate, but not the one behind a wall; geometry is kept from trace to trace."""
    scene = ep.Scene()
    scene.add(ep.actors.plate(2.0, 2.0), name="screen", material="metal", position=(6.0, 0.0, 1.0),
              motion=ep.LinearMotion(velocity=(0.0, 400.0, 0.0)))
    scene.add(ep.actors.plate(4.0, 2.0), name="wall", material="concrete", position=(8.0, 4.5, 1.0))
    for name, aside in (("bared", 0.0), ("hidden", 6.0)):
        scene.add(ep.actors.plate(0.5, 0.5), name=name, material="metal", position=(10.0, aside, 1.0))
    antennas = [ep.Antenna((0.0, 0.0, 1.0))]
    radar = build_radar(antennas, antennas, num_samples=16, sampling_rate=1e6, num_chirps=256)
    middle = 0.5 * radar.frame_duration
    keep_geometry(scene)
    paths = ep.trace(scene, radar, num_rays=500, start_time=-middle)  # at the middle the screen is before the radar
    hidden = {one.name for one in visibility_in_trace(paths, radar) if one.visible_share == 0.0}
    assert hidden == {"bared", "hidden"}
    assert 400.0 * middle > 1.5  # beyond what hides the plate
    assert appearing_in_frame(paths, radar, hidden) == {"bared"}
    named = ep.LabelSettings(objects={"plate": "bar*", "screen": "screen"}).objects  # whose name is no glob of its meshes
    assert appearing_in_frame(paths, radar, {"plate"}, named) == {"plate"}
    again = ep.trace(scene, radar, num_rays=500, start_time=-middle)
    assert again.num_paths == paths.num_paths > 0
    for one, other in ((paths.mesh_id, again.mesh_id), (paths.u, again.u), (paths.v, again.v)):
        np.testing.assert_array_equal(one, other)
    np.testing.assert_array_equal(again.weight, paths.weight)


@pytest.mark.parametrize("width, appears", [(0.05, True), (0.01, False)])
@pytest.mark.parametrize("share", FRAME_PLACES)
def test_what_a_gap_shows_at_one_place_of_the_frame_appears(share, width, appears):
    """A gap that passes at 400 m/s shows 1/6 of a plate at one place that is looked at, and nothing at others; of a narrow one
    3 % are no sight. Its shadow at the plate's distance is 10/6 as wide."""
    radar = build_radar(num_samples=16, sampling_rate=1e6, num_chirps=256)
    middle, scene = -400.0 * share * radar.frame_duration, ep.Scene()
    for name, (begin, end) in {"left": (-30.0, middle - 0.5 * width), "right": (middle + 0.5 * width, 30.0)}.items():
        scene.add(ep.actors.plate(end - begin, 2.0), name=name, material="metal", position=(6.0, 0.5 * (begin + end), 0.0),
                  motion=ep.LinearMotion(velocity=(0.0, 400.0, 0.0)))
    scene.add(ep.actors.plate(0.5, 0.5), name="plate", material="metal", position=(10.0, 0.0, 0.0))
    (seen,) = ep.visibility(scene, radar, {"plate": "plate"}, time=share * radar.frame_duration)
    assert seen.visible_share == pytest.approx(width * (10.0 / 6.0) / 0.5, abs=0.004)
    paths = ep.trace(scene, radar, num_rays=100)
    assert appearing_in_frame(paths, radar, {"plate"}) == ({"plate"} if appears else set())


@pytest.mark.parametrize("turn", [0.0, 0.001, -0.004, 0.05, 0.5])
def test_each_end_sees_a_plate_at_its_own_slant(turn):
    """A plate in the line of sight of one end: the other one, 5 cm aside, sees its front, or its back."""
    side, middle = 0.7, np.array([10.0, 0.0, 1.0])
    scene = ep.Scene()
    scene.add(ep.actors.plate(side, side), name="sign", material="metal", position=middle, yaw=np.pi / 2 + turn)
    normal = np.array([-np.sin(turn), np.cos(turn), 0.0])
    ends = (0.0, 0.0, 1.0), (0.0, 0.05, 1.0)
    for places in (ends, ends[::-1]):
        transmitter, receiver = places
        radar = ep.Radar(radar_at(transmitter).waveform, transmitters=[ep.Antenna(transmitter)], receivers=[ep.Antenna(receiver)])
        seen = ep.visibility(scene, radar)[0]
        for end, place in ((seen.transmitter, transmitter), (seen.receiver, receiver)):
            away = middle - place
            angle = side ** 2 * abs(normal @ away) / np.linalg.norm(away) ** 3  # of a small plate
            assert end.solid_angle == pytest.approx(angle, rel=0.03, abs=1e-9)
            assert end.visible_share == (1.0 if angle > 1e-9 else 0.0)


def test_what_is_looked_at_again_is_the_same_and_frees_its_geometry():
    """A trace that kept no geometry; the second look goes by what the first one built."""
    radar, scene = radar_at((0, 0, 0.6)), person_and_car(gap=2.0)
    paths = ep.trace(scene, radar, num_rays=500)
    once, again = (visibility_in_trace(paths, radar) for _ in range(2))
    assert once == again and 0.0 < once[1].visible_share < 1.0
    assert list(_KEPT) == [paths]
    assert not ep._core.remember_geometry(paths, ep._core.KeptGeometry())  # there is one
    other = ep.trace(person_and_car(gap=0.0), radar, num_rays=500)
    visibility_in_trace(other, radar)
    assert list(_KEPT) == [other]
    del other
    gc.collect()
    assert not list(_KEPT)


def distance_to_triangles(point, corners):
    """m, from a point to the nearest of triangles, corners [F, 3, 3]: by Fermat's condition, on a face, an edge or a corner."""
    lines = corners - point
    least = np.linalg.norm(lines, axis=2).min()
    for a, b in ((0, 1), (1, 2), (2, 0)):
        along = lines[:, b] - lines[:, a]
        at = -np.sum(lines[:, a] * along, axis=1) / np.sum(along * along, axis=1)
        feet = lines[:, a] + at[:, None] * along
        least = min([least, *np.linalg.norm(feet[(at > 0) & (at < 1)], axis=1)])
    for a, b, c in lines:
        weights = np.linalg.lstsq(np.stack([b - a, c - a], axis=1), -a, rcond=None)[0]
        if weights.min() > 0 and weights.sum() < 1:
            least = min(least, np.linalg.norm(a + weights[0] * (b - a) + weights[1] * (c - a)))
    return least


@pytest.mark.parametrize("seed", range(6))
def test_distances_are_those_of_the_nearest_triangles(seed):
    """Triangles of all sizes in any order, stretched and turned, near one end and away from the other."""
    rng = np.random.default_rng(seed)
    sizes = 10.0 ** rng.uniform(-2.0, 0.3, size=(300, 1, 1))
    corners = rng.uniform(-3.0, 3.0, size=(300, 1, 3)) + sizes * rng.normal(size=(300, 3, 3))
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    linear = turn * np.sign(np.linalg.det(turn)) @ np.diag(rng.uniform(0.3, 3.0, size=3))
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = linear, (15.0, -4.0, 1.0)
    scene = ep.Scene()
    scene.add(ep.Mesh(corners.reshape(-1, 3), np.arange(900).reshape(300, 3)), name="rubble", material="metal", transform=pose)
    ends = [(0.0, 0.0, 1.0), rng.uniform(-6.0, 6.0, size=3)]
    radar = build_radar([ep.Antenna(ends[0])], [ep.Antenna(ends[1])], num_samples=16, sampling_rate=1e6, num_chirps=2)
    seen, = ep.visibility(scene, radar, num_directions=64)
    placed = corners @ linear.T + pose[:3, 3]
    expected = [distance_to_triangles(np.asarray(end), placed) for end in ends]
    assert [seen.transmitter.distance, seen.receiver.distance] == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("hidden_end", ["transmitters", "receivers"])
def test_an_object_is_seen_as_well_as_by_the_end_that_sees_less(hidden_end):
    """A screen stands between one of both ends and a small plate."""
    places = {"transmitters": (0.0, 0.0, 0.0), "receivers": (0.0, 4.0, 0.0)}
    scene = ep.Scene()
    scene.add(ep.actors.plate(0.2, 0.2), name="plate", material="metal", position=(10, 0, 0), yaw=np.pi)
    scene.add(ep.actors.plate(1.0, 1.0), name="screen", material="metal", yaw=np.pi,
              position=0.7 * np.array([10.0, 0.0, 0.0]) + 0.3 * np.array(places[hidden_end]))
    radar = ep.Radar(ep.ChirpSequence(), **{end: [ep.Antenna(place)] for end, place in places.items()})
    (seen,) = ep.visibility(scene, radar, ["plate"])
    assert seen.visible_share == 0.0 and set(seen.occluders) == {"screen"}
    assert max(seen.transmitter.visible_share, seen.receiver.visible_share) == 1.0
    assert seen.distance == pytest.approx(0.5 * (10.0 + np.hypot(10.0, 3.9)))
