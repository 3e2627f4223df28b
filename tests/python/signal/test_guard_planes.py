"""Single rays over planes that nobody flagged as mirrors: said where they stand out of the noise, once, and not elsewhere."""
import warnings

import numpy as np
import pytest

import echopath as ep
from echopath.guard import check_planes
from support.radars import build_radar

ROUGH = ep.Material(reflectivity=0.5, scattering=1.0)
NAME = "single rays over planes that are no mirrors"
RAYS = 4000
SAME_DB = 1e-6


def make_radar():
    return build_radar([(0, 0, 0.6)], [(0, 0.002, 0.6)], num_chirps=64, num_samples=128, bandwidth=600e6, transmit_power=0.1)


def make_scene(road="asphalt", block=ROUGH):
    scene = ep.Scene()
    scene.add(ep.actors.ground((120, 40)), name="road", material=road)
    scene.add(ep.actors.box((0.3, 0.3, 1.6)), name="person", material=block, position=(10, 1, 0.8))
    return scene


def slow_levels(paths):
    """{path: W} of those that meet the road without being scattered there and the person with, one by one."""
    power, found = np.abs(paths.amplitude) ** 2, {}
    names = [mesh.name for mesh in paths.scene.meshes]
    for path in range(paths.num_paths):
        first, count, rough = int(paths.offsets[path]), int(paths.num_bounces[path]), int(paths.diffuse[path])
        hits = [(names[paths.mesh_id[first + k]], bool(rough >> k & 1)) for k in range(count)]
        if ("road", False) in hits and any(is_rough for _, is_rough in hits):
            found[path] = power[path]
    return found


def plane_checks(scene, seed=1, **settings):
    """The checks of this kind, and what the guard says of them."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        frame = ep.simulate(scene, make_radar(), num_rays=RAYS, seed=seed, **settings)
    texts = [str(one.message) for one in said if "'road'" in str(one.message)]
    return [check for check in frame.checks if check.name == NAME], texts


@pytest.fixture(scope="module")
def alone():
    """Paths of the first seed whose strongest over the road stands for all of them."""
    for seed in range(1, 20):
        paths = ep.trace(make_scene(), make_radar(), num_rays=RAYS, seed=seed)
        levels = slow_levels(paths)
        strongest = max(levels.values())
        if 2.0 * strongest > 0.9 * sum(levels.values()) and strongest > 20.0 * ep.noise_power(make_radar()):
            return paths
    raise AssertionError("no such seed")


def test_the_level_of_the_strongest_is_that_of_a_slow_search(alone):
    levels = slow_levels(alone)
    check, = check_planes(alone, "hann")
    assert check.name == NAME and not check.agrees and check.count == len(levels)
    wanted = 10.0 * np.log10(max(levels.values()) / ep.noise_power(make_radar()))
    assert abs(check.error - wanted) < SAME_DB


def test_the_guard_names_object_plane_and_remedy(alone):
    (check,), (text,) = plane_checks(make_scene(), seed=alone.frame.seed)
    assert check.advice == text
    for word in ("'person'", "'road'", "mirror=True", "ep.mark_mirrors(scene, radar)", "mark_mirrors = true"):
        assert word in text


def test_the_remedy_is_one(alone):
    scene = make_scene()
    assert ep.mark_mirrors(scene, make_radar()) == ("road",)
    assert plane_checks(scene, seed=alone.frame.seed) == ([], [])


@pytest.mark.parametrize("scene", [
    pytest.param({"block": "metal"}, id="no rough surface"),
    pytest.param({"road": ROUGH}, id="no plane that mirrors"),
])
def test_silence_where_nothing_is_scattered_into_a_plane(scene):
    for seed in range(1, 4):
        assert plane_checks(make_scene(**scene), seed=seed) == ([], [])


def test_silence_where_many_rays_share_the_echo():
    """A wide rough wall square to a wide plane close by is met so often that no ray stands for the others."""
    scene = ep.Scene()
    scene.add(ep.actors.ground((12, 12)), name="road", material="asphalt")
    scene.add(ep.actors.wall(4.0, 3.0), name="front", material=ROUGH, position=(3, 0, 0), yaw=0.5 * np.pi)
    paths = ep.trace(scene, make_radar(), num_rays=RAYS, seed=1)
    assert len(slow_levels(paths)) > 50 and all(check.agrees for check in check_planes(paths, "hann"))


def test_frames_in_time_say_it_once(alone):
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        frames = list(ep.Sequence(make_scene(), make_radar(), frames=3, interval=0.01, num_rays=RAYS, seed=alone.frame.seed,
                                  scatterers="rays"))
    loud = [frame for frame in frames if any(check.name == NAME and not check.agrees for check in frame.checks)]
    assert len(loud) > 1
    assert len([one for one in said if "'road'" in str(one.message)]) == 1
