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


def test_rays_are_aimed_at_what_is_in_sight_and_does_not_surround_the_radar(town):
    strata = _strata(ep.trace(town, targets.radar(), max_bounces=1, num_rays=RAYS))
    assert {name for name in strata if "focus" not in name} == {"town/ball", "town/wall", "town/yard/bin", "field of view"}


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
    assert set(_strata(ep.trace(scene, targets.radar(), max_bounces=1, num_rays=RAYS))) == {*nearest, "field of view"}
    few = ep.trace(scene, targets.radar(), max_bounces=1, num_rays=600)
    assert set(_strata(few)) == {"field of view"}
