"""Ways of places on objects: beside vertices of the core, trajectories and closed forms, and radars that go them."""
import numpy as np
import pytest

import echopath as ep

NEAR = 3e-6  # m, of curves to 2e-6 m and directions to 1e-6 of points within a metre
BEND = ep.Trajectory([(0, 0), (40, 0), (40, 40)], turn_radius=15, speed=8)
BOX = ep.actors.box((0.4, 0.4, 0.4))


def farthest(scene, name: str, place, during, count: int = 301) -> float:
    """m, by which the mesh of an object, moved by the way of a place on it, is off where the scene has its vertices."""
    motion, node = scene[name].carried(place, during=during), scene[name]
    mesh_id, vertices = node.meshes[0].id, np.asarray(node.mesh.vertices) - place
    off = 0.0
    for time in np.linspace(*during, count):
        pose = motion.at(time)
        off = max(off, np.abs(vertices @ pose[:3, :3].T + pose[:3, 3] - scene.world_vertices(mesh_id, time)).max())
    return off


def test_a_place_on_a_trailer_swings_behind_its_hitch():
    scene = ep.Scene()
    scene.add(ep.actors.truck(trajectory=BEND), name="truck", position=(3.0, 2.0, 0.0), yaw=0.3)
    assert farthest(scene, "truck/trailer/doors", (-8.3, 0.0, 2.5), (0.0, 8.0)) < NEAR


def test_a_place_on_a_wheel_rolls():
    scene = ep.Scene()
    scene.add(ep.actors.car(trajectory=BEND), name="car")
    rim = next(name for name in scene if name.endswith("rim"))
    assert farthest(scene, rim, (0.1, 0.0, 0.2), (1.0, 1.5)) < NEAR


def test_a_place_before_a_car_goes_as_its_trajectory_says():
    scene = ep.Scene()
    scene.add(BOX, name="car", material="metal", motion=BEND)
    place = (2.2, 0.5, 0.6)
    found, told = scene["car"].carried(place, during=(0.0, 8.0)), BEND.motion(place)
    for time in np.linspace(0.0, 8.0, 101):
        np.testing.assert_allclose(found.at(time), told.at(time), atol=2 * NEAR)


def test_what_turns_evenly_on_what_drives_goes_as_the_closed_form():
    """An arm of 0.5 m that turns at 4 rad/s on a robot that stands turned by 0.7 rad and drives ahead at 2 m/s."""
    scene = ep.Scene()
    scene.add(BOX, name="robot", material="metal", position=(1.0, 2.0, 0.0), yaw=0.7, speed=2.0)
    scene.add(BOX, name="arm", parent="robot", material="metal", position=(0.3, 0.0, 0.5),
              motion=ep.LinearMotion(angular_velocity=(0.0, 0.0, 4.0)))
    motion = scene["robot/arm"].carried((0.5, 0.0, 0.0), during=(0.0, 3.0))
    ahead, left = np.array([np.cos(0.7), np.sin(0.7), 0.0]), np.array([-np.sin(0.7), np.cos(0.7), 0.0])
    for time in np.linspace(0.0, 3.0, 77):
        turned = ahead * np.cos(4.0 * time) + left * np.sin(4.0 * time)
        pose = motion.at(time)
        np.testing.assert_allclose(pose[:3, 3], [1.0, 2.0, 0.5] + ahead * (0.3 + 2.0 * time) + 0.5 * turned, atol=NEAR)
        np.testing.assert_allclose(pose[:3, 0], turned, atol=NEAR)


@pytest.mark.parametrize("interpolation", ["linear", "step"])
def test_loops_begin_anew_in_what_they_carry(interpolation):
    heights = ep.Curve([0.0, 0.4, 1.0], [[0, 0, 0], [0, 0, 0.8], [0, 0, 0]], interpolation)
    scene = ep.Scene()
    scene.add(BOX, name="lift", material="metal", motion=ep.CurveMotion(heights, period=1.0, offset=0.3))
    motion = scene["lift"].carried(during=(-2.0, 2.05))
    for time in np.linspace(-1.99, 2.04, 101):  # none of them a time at which a step is made
        phase = (time + 0.3) % 1.0
        height = np.interp(phase, [0.0, 0.4, 1.0], [0.0, 0.8, 0.0]) if interpolation == "linear" else 0.8 * (phase >= 0.4)
        assert motion.at(time)[2, 3] == pytest.approx(height, abs=NEAR)


def test_what_jumps_stays_where_it_is_until_it_does():
    """Up to a microsecond before, on what turns evenly by 3 rad/s, and jumps by half a turn and 0.5 m."""
    jump, rate, size = 0.7, 3.0, 0.3
    scene = ep.Scene()
    scene.add(BOX, name="table", material="metal", motion=ep.LinearMotion(angular_velocity=(0.0, 0.0, rate)))
    steps = ep.CurveMotion(ep.Curve([0.0, jump], [[0, 0, 0], [0.5, 0, 0]], "step"),
                           ep.Curve([0.0, jump], [[1, 0, 0, 0], [0, 0, 0, 1]], "step"))
    scene.add(BOX, name="top", parent="table", material="metal", motion=steps)
    motion = scene["table/top"].carried((size, 0.0, 0.0), during=(0.0, 1.5))
    apart = np.geomspace(1e-6, 0.1, 40)
    for time in np.concatenate([jump - apart, jump + apart]):
        place, sign = (0.0, 1.0) if time < jump else (0.5, -1.0)
        ahead = np.array([np.cos(rate * time), np.sin(rate * time), 0.0])
        np.testing.assert_allclose(motion.at(time)[:3, 3], (place + sign * size) * ahead, atol=NEAR)
        np.testing.assert_allclose(motion.at(time)[:3, 0], sign * ahead, atol=NEAR)


def test_what_turns_back_at_once_carries_for_a_long_time():
    scene = ep.Scene()
    scene.add(BOX, name="shuttle", material="metal", motion=ep.Trajectory([(0, 0), (20, 0), (2, 0)], speed=5))
    motion = scene["shuttle"].carried((0.3, 0.0, 0.0), during=(0.0, 7.0))
    for time, x, ahead in ((1.0, 5.3, 1.0), (3.9, 19.8, 1.0), (4.1, 19.2, -1.0), (7.0, 4.7, -1.0)):
        np.testing.assert_allclose(motion.at(time)[0, [0, 3]], [ahead, x], atol=0.03)  # m, of the moment in which it stands


def test_places_are_in_the_axes_of_objects_that_are_scaled():
    scene = ep.Scene()
    turned = np.array([[0.0, -2.0, 0.0, 1.0], [2.0, 0.0, 0.0, 0.0], [0.0, 0.0, 2.0, 0.0], [0.0, 0.0, 0.0, 1.0]])
    scene.add(BOX, name="box", material="metal", transform=turned)
    pose = scene["box"].carried((0.5, 0.0, 0.1), during=(0.0, 1.0)).at(0.5)
    np.testing.assert_allclose(pose, [[0, -1, 0, 1], [1, 0, 0, 1], [0, 0, 1, 0.2], [0, 0, 0, 1]], atol=1e-12)


def test_a_radar_on_a_trailer_sees_what_follows_where_it_is():
    """A sphere behind, whose range and radial velocity are those between the places that the scene tells."""
    scene = ep.Scene()
    scene.add(ep.actors.truck(trajectory=BEND), name="truck")
    behind = ep.Trajectory([(-30, 0), (40, 0), (40, 40)], turn_radius=15, speed=8)
    scene.add(ep.actors.sphere(0.5), name="ball", material="metal", motion=behind.motion((0.0, 0.0, 1.0)), smooth=True)
    chirps = ep.ChirpSequence(start_frequency=77e9, bandwidth=0.5e9, num_samples=256, sampling_rate=10e6, num_chirps=64,
                              chirp_interval=60e-6)
    radar = ep.Radar(chirps, transmitters=[ep.Antenna()], receivers=[ep.Antenna()], yaw=np.pi, transmit_power=100.0,
                     motion=scene["truck/trailer/doors"].carried((-8.6, 0.0, 1.0), during=(0.0, 7.0)))
    for start in (1.0, 5.0):
        frame = ep.simulate(scene, radar, start_time=start, num_rays=3000, detections=True, truth=True, guard=False)
        middle, found = radar.middle_of_frame(start), frame.detections
        points = [np.linalg.norm(behind.motion((0.0, 0.0, 1.0)).at(time)[:3, 3] - radar.world_from_radar(time)[:3, 3])
                  for time in (middle - 1e-3, middle, middle + 1e-3)]
        ball = int(np.abs(found.range - (points[1] - 0.5)).argmin())
        assert found.range[ball] == pytest.approx(points[1] - 0.5, abs=0.03)  # m, a tenth of a cell
        assert found.velocity[ball] == pytest.approx((points[2] - points[0]) / 2e-3, abs=0.05)


@pytest.mark.parametrize("keywords, told", [
    ({"during": (1.0, 0.0)}, "^during: must be a begin and an end in s, ascending"),
    ({"during": (0.0, np.inf)}, "^during: must be finite"), ({"during": (0.0, 1.0), "place": (np.nan, 0, 0)}, "^place: "),
    ({"during": (0.0, 3.0)}, "^during: must be within 0 to 2 s, in which 'box' has a motion")])
def test_wrong_arguments_are_refused_by_name(keywords, told):
    scene = ep.Scene()
    scene.add(BOX, name="box", material="metal", motion=ep.KeyframeMotion([0.0, 2.0], [[0, 0, 0], [1, 0, 0]]))
    with pytest.raises(ValueError, match=told):
        scene["box"].carried(**keywords)


def test_what_deforms_or_is_mirrored_carries_nothing():
    scene = ep.Scene()
    vertices = np.asarray(BOX.vertices)
    scene.add(BOX, name="soft", material="metal", motion=ep.VertexSequence([0.0, 1.0], [vertices, 2.0 * vertices]))
    scene.add(BOX, name="mirrored", material="metal", transform=np.diag([1.0, -1.0, 1.0, 1.0]))
    with pytest.raises(ValueError, match="^scene: 'soft' must not deform to carry something, has a VertexSequence"):
        scene["soft"].carried(during=(0.0, 1.0))
    with pytest.raises(ValueError, match="^scene: 'mirrored' must not be mirrored"):
        scene["mirrored"].carried(during=(0.0, 1.0))
