"""Frames of a radar at rest: what stands still sends the same samples in all of them, whatever moves beside it."""
import numpy as np
import pytest

import echopath as ep

CHIRPS = ep.ChirpSequence(start_frequency=77e9, bandwidth=500e6, num_samples=64, sampling_rate=5e6, num_chirps=4,
                          chirp_interval=50e-6)
RADAR = ep.Radar(CHIRPS, transmitters=[ep.Antenna()], receivers=[ep.Antenna((0, 0.01, 0))], position=(0, 0, 1))
INTERVAL = 0.05  # s
SINGLE = 1e-4  # rays meet triangles in single precision, whose steps hang on the extent of the scene


def room() -> ep.Scene:
    """Smooth and rough things before a wall that mirrors, and a ball that flies where it hides none of them."""
    scene = ep.Scene()
    scene.add(ep.actors.wall(5, 3), name="wall", position=(8, -2.5, 0), yaw=-np.pi / 2,
              material=ep.materials["concrete"].replace(scattering=0.2, mirror=True))
    scene.add(ep.actors.sphere(radius=0.3), name="globe", position=(4, -2, 0.8), material="metal", smooth=True)
    for place in range(3):
        scene.add(ep.actors.box(size=(0.5, 0.5, 0.4)), name=f"box_{place}", position=(3 + place, -1 - place, 0), yaw=0.4 * place,
                  material=ep.materials["wood"].replace(scattering=0.4))
    scene.add(ep.actors.sphere(radius=0.25), name="ball", position=(3, 1.5, 1), speed=1.0, material="metal", smooth=True)
    return scene


def of_what_stands_still(frame, moving: str = "ball*") -> np.ndarray:
    return ep.decompose(frame.paths, RADAR, {"still": ~ep.hits(moving)}, tolerance=1e-12)["still"]


def differences(scene, moving: str = "ball*", **keywords) -> list[float]:
    """Of the samples of what stands still from those of frame 0, relative to the largest of these."""
    sequence = ep.Sequence(scene, RADAR, interval=INTERVAL, noise_seed=None, guard=False, **keywords)
    first, *later = [of_what_stands_still(frame, moving) for frame in sequence]
    return [np.abs(cube - first).max() / np.abs(first).max() for cube in later]


@pytest.mark.parametrize("rays", [
    pytest.param({"num_rays": 2_000}, id="few rays, shared out without a pilot"),
    pytest.param({"num_rays": 20_000}, id="rays that a pilot shares out"),
    pytest.param({"target_error_db": 1.0, "max_rays": 60_000}, id="rays that an error asks for"),
])
def test_the_samples_of_what_stands_still_are_those_of_the_frame_before(rays):
    """Rays shared out for each frame by itself leave -30 to -50 dB."""
    assert max(differences(room(), frames=4, **rays)) < 1e-9


def test_they_are_where_something_comes_and_goes():
    scene = room()
    scene.add(ep.actors.sphere(radius=0.2), name="ball_that_comes", position=(5, 2, 1), material="metal", smooth=True)
    scene["ball_that_comes"].lifetime = (0.9 * INTERVAL, 2.5 * INTERVAL)
    assert max(differences(scene, frames=4, num_rays=20_000)) < 1e-9


def basin() -> ep.Mesh:
    """A floor with a low rim around the radar, in one mesh: no cone of directions holds it, so that the field of view does."""
    corners = 20.0 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    vertices = [(*corner, height) for height in (0.0, 3.0) for corner in corners]
    sides = [(k, (k + 1) % 4, (k + 1) % 4 + 4, k + 4) for k in range(4)]
    squares = [(0, 1, 2, 3), *sides]
    return ep.Mesh(vertices, [triangle for a, b, c, d in squares for triangle in ((a, b, c), (a, c, d))])


def add_ball_that_comes(scene, **keywords):
    scene.add(ep.actors.sphere(radius=0.25), name="ball", material="metal", smooth=True, **keywords)
    scene["ball"].lifetime = (0.9 * INTERVAL, 1.5 * INTERVAL)


FEW_OR_PLANNED = pytest.mark.parametrize("num_rays", [2_000, 20_000])


@FEW_OR_PLANNED
def test_they_are_in_surroundings_that_only_the_field_of_view_holds(num_rays):
    """Once without and once with something that rays are aimed at, above the rim, where it shades nothing."""
    scene = ep.Scene()
    scene.add(basin(), name="basin", material=ep.materials["wood"].replace(scattering=0.4))
    add_ball_that_comes(scene, position=(3, 1.5, 3.5))
    assert max(differences(scene, frames=3, num_rays=num_rays, max_bounces=1)) < 1e-9


@FEW_OR_PLANNED
def test_they_are_where_a_mirror_comes_behind_them(num_rays):
    """It is no target of rays, but has the field of view look for what it scatters."""
    scene = ep.Scene()
    for name, aside in (("left", 2), ("right", -2)):
        scene.add(ep.actors.box(size=(1, 1, 2)), name=name, position=(5, aside, 0),
                  material=ep.materials["wood"].replace(scattering=0.4))
    scene.add(ep.actors.wall(5, 3), name="ball room", position=(8, -3, 0), yaw=-np.pi / 2,
              material=ep.materials["concrete"].replace(scattering=0.2, mirror=True))
    scene["ball room"].lifetime = (0.9 * INTERVAL, 1.5 * INTERVAL)
    assert max(differences(scene, frames=3, num_rays=num_rays)) < SINGLE


@FEW_OR_PLANNED
def test_they_are_in_an_object_of_which_parts_move(num_rays):
    """A gate whose bars lie on its posts and go up, with a wall that mirrors; aimed at as a whole it leaves -33 dB."""
    scene = ep.Scene()
    scene.add(name="gate", position=(5, 0, 0))
    for name, aside in (("left_post", 0.6), ("right_post", -0.6)):
        scene.add(ep.actors.box(size=(0.5, 0.5, 1.3)), name=name, parent="gate", position=(0, aside, 0),
                  material=ep.materials["wood"].replace(scattering=0.4))
    scene.add(ep.actors.wall(3, 1.2), name="wall", parent="gate", position=(2, 0.5, 0), yaw=-np.pi / 2,
              material=ep.materials["concrete"].replace(scattering=0.2, mirror=True))
    for name, height in (("lower", 1.35), ("upper", 1.55)):
        scene.add(ep.actors.box(size=(0.1, 1.5, 0.1)), name=f"{name}_bar", parent="gate", position=(0, 0, height),
                  material="metal", motion=ep.LinearMotion(velocity=(0, 0, 1.0)))
    assert max(differences(scene, "gate/*_bar", frames=3, num_rays=num_rays)) < SINGLE


def test_they_are_in_a_town_of_more_things_than_get_rays_of_their_own():
    """What comes is nearer than all of them, and would take the place of one."""
    scene = ep.Scene()
    scene.add(name="town")
    for k, angle in enumerate(np.linspace(0, 2 * np.pi, 270, endpoint=False)):
        distance = 8 + 20 * (k * 0.618 % 1)
        scene.add(ep.actors.plate(0.3, 0.3), name=f"sign_{k}", parent="town", yaw=angle - np.pi,
                  position=(distance * np.cos(angle), distance * np.sin(angle), 1),
                  material=ep.materials["wood"].replace(scattering=0.4))
    scene.add(ep.actors.sphere(radius=0.25), name="ball", parent="town", position=(3, 0, 4), material="metal", smooth=True)
    scene["town/ball"].lifetime = (0.9 * INTERVAL, 1.5 * INTERVAL)
    assert max(differences(scene, frames=3, num_rays=3_000, max_bounces=1, moving="town/ball")) < 1e-9


def test_they_are_in_a_town_of_which_a_truck_hides_some_things_for_a_time():
    """Of more than 256 things those in sight have rays of their own; signs that the truck hid gave theirs to others: -46 dB."""
    scene = ep.Scene()
    scene.add(name="town")
    for k, angle in enumerate(np.linspace(-np.pi, np.pi, 300, endpoint=False)):
        distance = 8 + 10 * (k * 0.618 % 1)
        scene.add(ep.actors.plate(0.3, 0.3), name=f"{'ahead' if abs(angle) < 1 else 'behind'}_{k}", parent="town",
                  yaw=angle - np.pi, position=(distance * np.cos(angle), distance * np.sin(angle), 1),
                  material=ep.materials["wood"].replace(scattering=0.4))
    scene.add(ep.actors.box(size=(0.4, 3.0, 2.2)), name="truck_ahead", position=(5, -2, 0), material="metal",
              motion=ep.LinearMotion(velocity=(0, 30.0, 0)))
    assert max(differences(scene, frames=3, num_rays=3_000, max_bounces=1, moving="*ahead*")) < 1e-9


def test_their_images_have_rays_while_a_truck_hides_a_part_of_a_wall():
    """Images of the radar in the wall show all houses from 7 m on; those that the truck hid gave their rays to the others."""
    scene, rough = ep.Scene(), ep.Material(permittivity=4.0, scattering=0.7)
    mirror = ep.materials["concrete"].replace(mirror=True, scattering=0.0)
    scene.add(ep.actors.wall(8.0, 8.0), name="wall", material=mirror, position=(6.0, -6.0, 0.0), yaw=np.pi)
    for house in range(8):
        scene.add(ep.actors.box(1.0), name=f"house_{house}", material=rough, position=(4.0 + 3.0 * house, 9.0, 0.5))
    scene.add(ep.actors.box((4.0, 0.3, 9.0)), name="truck", material="metal", position=(4.0, -3.0, 4.01), speed=-10.0)
    rays = [{stratum.name: stratum.num_rays for stratum in frame.paths.frame.strata if "truck" not in stratum.name}
            for frame in ep.Sequence(scene, RADAR, frames=3, interval=INTERVAL, num_rays=2_000, max_bounces=2, guard=False)]
    assert sum(" over wall" in name for name in rays[0]) == 7
    assert rays[0] == rays[1] == rays[2]


@pytest.mark.parametrize("rays", [{"num_rays": 20_000}, {"target_error_db": 1.0, "max_rays": 40_000}])
def test_a_frame_in_which_nothing_moves_has_their_rays_alone(rays):
    scene = ep.Scene()
    scene.add(ep.actors.sphere(radius=0.3), name="globe", position=(4, -2, 0.8), material="metal", smooth=True)
    add_ball_that_comes(scene, position=(3, 1.5, 1))
    assert max(differences(scene, frames=3, **rays)) < SINGLE


@FEW_OR_PLANNED
def test_a_frame_has_the_same_bits_alone_where_a_part_of_an_object_comes_and_goes(num_rays):
    """The object is another one with it than without, and was taken to stand still by the frames without."""
    scene = ep.Scene()
    scene.add(name="yard", position=(6, 0, 0))
    for name, aside in (("shed", -2), ("cart", -1.2)):
        scene.add(ep.actors.box(size=(0.5, 0.5, 1)), name=name, parent="yard", position=(0, aside, 0),
                  material=ep.materials["wood"].replace(scattering=0.4))
    scene["yard/cart"].lifetime = (0.9 * INTERVAL, 1.5 * INTERVAL)
    scene.add(ep.actors.sphere(radius=0.25), name="ball", position=(3, 1.5, 1), speed=1.0, material="metal", smooth=True)
    scene.add(ep.actors.sphere(radius=0.3), name="globe", position=(4, -3, 0.8), material="metal", smooth=True)

    def frames(places) -> list[bytes]:
        sequence = ep.Sequence(scene, RADAR, frames=3, interval=INTERVAL, num_rays=num_rays, noise_seed=None, guard=False)
        return [sequence[place].cube.tobytes() for place in places]

    assert frames([1, 0]) == frames([0, 1])[::-1]
    globe = ep.Sequence(scene, RADAR, frames=3, interval=INTERVAL, num_rays=num_rays, noise_seed=None, guard=False)
    first, *later = [ep.decompose(frame.paths, RADAR, {"globe": "T 'globe' R"}, tolerance=1e-12)["globe"] for frame in globe]
    assert all(np.abs(cube - first).max() < 1e-9 * np.abs(first).max() for cube in later)


def test_a_frame_alone_shares_its_rays_out_likewise():
    sequence = ep.Sequence(room(), RADAR, frames=3, interval=INTERVAL, num_rays=20_000, guard=False)
    alone = ep.simulate(room(), RADAR, start_time=sequence.times[2], num_rays=20_000, scatterers="surface", guard=False)
    assert alone.noisy_cube.tobytes() == sequence[2].noisy_cube.tobytes()


def echo_of_sphere(radius: float, distance: float) -> float:
    """Power in W of a metal sphere: the field at 1 m, radius / (2 d (d + radius)), d from its next point (geometrical optics)."""
    wavelength = 299792458.0 / CHIRPS.start_frequency
    field = wavelength / (4 * np.pi) * radius / (2 * (distance - radius) * distance)
    return RADAR.transmit_power * field**2


def error_db(frame, name: str, expected: float) -> float:
    return abs(10 * np.log10(ep.received_power(frame.paths.select(f"T '{name}' R")).power / expected))


def test_what_moves_gets_the_rays_that_its_echo_needs():
    for frame in ep.Sequence(room(), RADAR, frames=3, interval=INTERVAL, num_rays=20_000, noise_seed=None, guard=False):
        to_centre = np.hypot(3.0 + frame.paths.frame.trace_time, 1.5)
        assert error_db(frame, "ball", echo_of_sphere(0.25, to_centre)) < 0.2


def test_a_part_that_stands_still_of_an_object_that_moves_is_found():
    scene = room()
    scene.add(name="carousel", position=(5, 1, 1))
    scene.add(ep.actors.sphere(radius=0.3), name="post", parent="carousel", material="metal", smooth=True)
    scene.add(ep.actors.sphere(radius=0.1), name="horse", parent="carousel", position=(0, 1.0, 0), speed=2.0, material="metal",
              smooth=True)
    for frame in ep.Sequence(scene, RADAR, frames=2, interval=INTERVAL, num_rays=20_000, noise_seed=None, guard=False):
        assert error_db(frame, "carousel/post", echo_of_sphere(0.3, np.hypot(5, 1))) < 0.2


def test_the_error_of_a_frame_is_that_of_echoes_above_its_floor():
    """The pebble sends 70 dB less than the balloon, which has as many rays with it as where all rays are shared out at once."""
    scene = ep.Scene()
    scene.add(ep.actors.sphere(radius=0.05), name="pebble", position=(60, 20, 1), smooth=True,
              material=ep.materials["wood"].replace(scattering=0.4))
    scene.add(ep.actors.sphere(radius=1.0), name="balloon", position=(6, -2, 1), speed=1.0, material="metal", smooth=True)
    together, apart = (ep.trace(scene, RADAR, target_error_db=0.3, max_rays=40_000, scatterers=scatterers).frame
                       for scatterers in ("rays", "surface"))
    assert 0.0 < apart.error_db < 1.05 * together.error_db


def test_what_has_a_motion_at_rest_stands_still():
    """Cars that are parked have ways in traffic, too, and the speed of a radar in a loop may be 0."""
    parked, places = room(), ep.KeyframeMotion([-1.0, 0.5, 2.0], np.zeros((3, 3)))
    for name, motion in {"box_0": ep.LinearMotion(), "box_1": places, "globe": ep.LinearMotion()}.items():
        parked[name].motion = motion
    at_rest = RADAR.replace(speed=0.0)
    assert not at_rest.is_moving and RADAR.replace(speed=0.1).is_moving
    alone = ep.Sequence(room(), RADAR, frames=2, interval=INTERVAL, num_rays=2_000, noise_seed=None)[1].cube
    beside = ep.Sequence(parked, at_rest, frames=2, interval=INTERVAL, num_rays=2_000, noise_seed=None)[1].cube
    np.testing.assert_array_equal(beside, alone)


def test_a_frame_has_the_same_bits_alone_where_keyframes_rest():
    """Sums of equal keys had differed in their last bits from frame to frame, and with them the rays that the first one set."""
    scene, turned = room(), np.array([0.3, 0.5, -0.2, 0.7])
    scene["globe"].motion = ep.KeyframeMotion([-1.0, 0.03, 0.17, 2.0], np.tile((1 / 30, -1 / 35, 0.01), (4, 1)),
                                              np.tile(turned / np.linalg.norm(turned), (4, 1)))

    def frames(places) -> list[bytes]:
        sequence = ep.Sequence(scene, RADAR, frames=3, interval=INTERVAL, num_rays=20_000, noise_seed=None, guard=False)
        return [sequence[place].cube.tobytes() for place in places]

    assert frames([2, 1, 0]) == frames([0, 1, 2])[::-1]


def test_keyframes_that_trace_anew_find_the_scatterers_of_the_record():
    """Rays of images over a mirror that moves had counted as those of what stands still, which then had other scatterers."""
    scene = room()
    scene["wall"].motion = ep.LinearMotion(velocity=(0.5, 0, 0))
    boxes = [ep.simulate(scene, RADAR, num_rays=num_rays, scatterers="surface", noise_seed=None, guard=False, tolerance=1e-12,
                         retrace=retrace, parts={"boxes": "T 'box*' R"}).parts["parts"]["boxes"]
             for num_rays in (2_000, 20_000) for retrace in ("never", "always")]
    for once, anew in (boxes[:2], boxes[2:]):
        assert np.abs(anew - once).max() < 1e-9 * np.abs(once).max()
