"""Rays at what a town consists of: it is one object, which surrounds the radar, so that no stratum holds it."""
import numpy as np
import pytest

import echopath as ep
from echopath.actors import shapes
from echopath.bench.physics import targets

ROUGH = ep.Material(reflectivity=0.3, scattering=1.0)
RAYS = 20000
WITHIN_DB = 0.3


def _add_town(scene, parent):
    """A ball in sight, two bins in a yard, of which a wall hides one, and a ground around the radar."""
    def add(mesh, name, position, below=parent):
        scene.add(mesh, name=name, material=ROUGH, position=position, parent=below)

    add(shapes.ground((200.0, 200.0), z=-1.0), "ground", (0.0, 0.0, 0.0))
    add(shapes.sphere(0.25, edge=0.03), "ball", (15.0, 0.0, 0.0))
    add(shapes.box((0.2, 20.0, 4.0)), "wall", (20.0, 15.0, 0.0))
    yard = scene.add(None, name="yard", parent=parent)
    add(shapes.box((1.0, 1.0, 1.0)), "bin", (30.0, -8.0, 0.0), yard)
    add(shapes.box((1.0, 1.0, 1.0)), "hidden", (26.0, 18.0, 0.0), yard)
    add(shapes.box((1.0, 60.0, 1.0)), "kerb", (0.0, -4.0, -1.0), yard)  # so wide that no stratum holds it, or the yard


@pytest.fixture
def town():
    scene = ep.Scene()
    _add_town(scene, scene.add(None, name="town"))
    return scene


def _strata(paths):
    return {stratum.name: stratum.num_rays for stratum in paths.frame.strata}


def _direct(paths, name):
    return ep.received_power(paths.select(f"T '*{name}' R"))


def test_things_are_known_as_well_as_objects_that_stand_by_themselves(town):
    apart = ep.Scene()
    _add_town(apart, None)
    truth = _direct(ep.trace(apart, targets.radar(), max_bounces=1, num_rays=2 ** 18), "ball").power
    found = _direct(ep.trace(town, targets.radar(), max_bounces=1, num_rays=RAYS), "ball")
    assert found.interval_db < WITHIN_DB
    assert abs(10.0 * np.log10(found.power / truth)) < WITHIN_DB


def test_rays_are_aimed_at_what_does_not_surround_the_radar(town):
    strata = _strata(ep.trace(town, targets.radar(), max_bounces=1, num_rays=RAYS))
    assert {name for name in strata if "focus" not in name} == {"town/ball", "town/wall", "town/yard/bin", "town/yard/hidden",
                                                               "field of view"}


def test_ghosts_of_a_thing_that_only_a_mirror_shows_are_found():
    """A ball behind a screen, and a metal wall aside, each an object or all below one node."""
    powers = []
    for has_parent in (False, True):
        scene = ep.Scene()
        town = scene.add(None, name="town") if has_parent else None
        for mesh, name, material, position in (
                (shapes.ground((200.0, 200.0), z=-1.0), "ground", ROUGH, (0.0, 0.0, 0.0)),
                (shapes.box((0.2, 2.0, 2.0)), "screen", ROUGH, (8.0, 0.0, 0.0)),
                (shapes.sphere(0.3, edge=0.05), "ball", ROUGH, (15.0, 0.0, 0.0)),
                (shapes.wall(80.0, 20.0), "wall", ep.Material.metal(mirror=True), (0.0, 4.0, -10.0))):
            scene.add(mesh, name=name, material=material, position=position, parent=town)
        paths = ep.trace(scene, targets.radar(), max_bounces=3, num_rays=30000)
        powers.append(ep.received_power(paths.select("T '*wall' '*ball' '*wall' R")))
    apart, below = powers
    assert apart.interval_db < WITHIN_DB and below.interval_db < WITHIN_DB
    assert abs(10.0 * np.log10(below.power / apart.power)) < WITHIN_DB


def test_things_that_stand_apart_are_aimed_at_one_by_one():
    """A yard before the radar, of which one stratum holds all: a bus would have most of the rays, and a ball next to none."""
    scene = ep.Scene()
    yard = scene.add(None, name="yard", position=(30.0, 0.0, 0.0))
    scene.add(shapes.box((10.0, 2.5, 3.0)), name="bus", material=ROUGH, parent=yard, position=(0.0, 8.0, 0.0))
    scene.add(shapes.sphere(0.15, edge=0.03), name="ball", material=ROUGH, parent=yard, position=(0.0, -6.0, 0.0))
    row = scene.add(None, name="fence", position=(20.0, 15.0, 0.0))  # its pales stand apart, but fill what holds them
    for index in range(20):
        scene.add(shapes.plate(0.1, 1.2), name=f"pale_{index}", material=ROUGH, parent=row, position=(0.0, 0.15 * index, 0.0))
    paths = ep.trace(scene, targets.radar(), max_bounces=1, num_rays=8000)
    assert set(_strata(paths)) == {"yard/bus", "yard/ball", "fence", "field of view"}
    assert _direct(paths, "ball").interval_db < 0.5 * WITHIN_DB


def test_rays_that_an_error_asks_for_are_not_taken_from_what_is_known():
    """A bicycle needs many rays, balls few: they keep those with which they were known."""
    scene = ep.Scene()
    scene.add(ep.actors.bicycle(), name="bicycle", position=(20.0, 5.0, 0.0), yaw=0.5)
    for index in range(3):
        scene.add(shapes.sphere(0.3, edge=0.05), name=f"ball_{index}", material=ROUGH, position=(15.0, -3.0 * index, 0.5))
    first = _strata(ep.trace(scene, targets.radar(), max_bounces=1, num_rays=4000, batches=1))
    paths = ep.trace(scene, targets.radar(), max_bounces=1, num_rays=4000, target_error_db=1.0, max_rays=64000)
    last = _strata(paths)
    for index in range(3):
        assert last[f"ball_{index}"] >= first[f"ball_{index}"] / 2 and _direct(paths, f"ball_{index}").interval_db < WITHIN_DB
    assert last["bicycle"] > 4 * first["bicycle"]


def test_all_echoes_count_once(town):
    """Whatever rays are aimed at: a ball far from everything has the power of one alone, and so has the town as a whole."""
    apart = ep.Scene()
    _add_town(apart, None)
    powers = [ep.received_power(ep.trace(scene, targets.radar(), max_bounces=1, num_rays=2 ** 18)).power
              for scene in (town, apart)]
    assert abs(10.0 * np.log10(powers[0] / powers[1])) < 0.05


def test_the_things_of_one_object_share_its_rays():
    """Few rays, so that none go first to find out who needs them: a fifth of the aimed ones for each of five objects."""
    scene = ep.Scene()
    _add_town(scene, scene.add(None, name="town"))
    for index in range(4):
        scene.add(shapes.sphere(0.3, edge=0.1), name=f"ball_{index}", material=ROUGH, position=(10.0, 2.0 * index - 9.0, 0.0))
    strata = _strata(ep.trace(scene, targets.radar(), max_bounces=1, num_rays=8000))
    things = sum(count for name, count in strata.items() if name.startswith("town/"))
    assert things == pytest.approx(strata["ball_0"], abs=4)


def test_more_things_than_rays_can_serve_are_left_to_the_field_of_view():
    scene = ep.Scene()
    town = scene.add(None, name="town")
    scene.add(shapes.ground((200.0, 200.0), z=-1.0), name="ground", material=ROUGH, parent=town)
    for index in range(400):
        angle, distance = 2.0 * np.pi * index / 400, 10.0 + 0.1 * index
        scene.add(shapes.box((0.05, 0.05, 0.2)), name=f"pole_{index}", material=ROUGH, parent=town,
                  position=(distance * np.cos(angle), distance * np.sin(angle), 0.0))
    nearest = {f"town/pole_{index}" for index in range(256)}
    with pytest.warns(RuntimeWarning, match="at least 100 objects and images have no rays of their own"):
        paths = ep.trace(scene, targets.radar(), max_bounces=1, num_rays=RAYS)
    assert set(_strata(paths)) == {*nearest, "field of view"} and paths.frame.statistics.num_unaimed == 144
    few = ep.trace(scene, targets.radar(), max_bounces=1, num_rays=600)
    assert set(_strata(few)) == {"field of view"}


def test_more_images_than_rays_can_serve_are_told():
    """Each of 200 poles between two walls that are mirrors has an image over each; 256 of these have rays of their own."""
    scene = ep.Scene()
    for name, side, yaw in (("left", 10.0, 0.0), ("right", -10.0, np.pi)):
        scene.add(shapes.wall(2000.0, 200.0), name=name, material=ep.Material.metal(mirror=True), position=(0.0, side, -100.0),
                  yaw=yaw)
    town = scene.add(None, name="town")
    scene.add(shapes.ground((200.0, 19.0), z=-1.0), name="ground", material=ROUGH, parent=town)
    for index in range(200):
        scene.add(shapes.box((0.05, 0.05, 0.2)), name=f"pole_{index}", material=ROUGH, parent=town,
                  position=(20.0 + 0.3 * index, 5.0 * np.sin(index), 0.0))
    with pytest.warns(RuntimeWarning, match="at least 100 objects and images have no rays of their own"):
        paths = ep.trace(scene, targets.radar(), max_bounces=2, num_rays=RAYS)
    images = [stratum for stratum in paths.frame.strata if stratum.num_mirrors == 1]
    assert len(images) == 256 and paths.frame.statistics.num_unaimed == 2 * 200 - 256
    reason, = (effect.reason for effect in paths.effects if effect.name == "rays aimed at objects")
    assert "144 objects and images have no rays of their own" in reason
