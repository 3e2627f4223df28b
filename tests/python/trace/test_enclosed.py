"""Radars that stand in a body of the scene."""
import warnings

import pytest

import echopath as ep
from support.radars import build_radar

RADAR = build_radar([(0, 0, 0.5)], [(0, 0, 0.5)], num_samples=16, num_chirps=4)
SAYS = "^radar: its first transmitter stands inside of 'ego', which is closed: what is outside of it is not seen"


def road_with_car(middle) -> ep.Scene:
    """The radar's own car, here a box of 4 m, and a ball ahead."""
    scene = ep.Scene()
    scene.add(ep.actors.box((4.0, 2.0, 1.5)), name="ego", material="metal", position=middle)
    scene.add(ep.actors.sphere(0.5), name="ball", material="metal", position=(8.0, 0.0, 0.5), smooth=True)
    return scene


def test_a_radar_in_its_own_car_is_told_that_it_sees_nothing_else():
    with pytest.warns(RuntimeWarning, match=SAYS):
        paths = ep.trace(road_with_car((-1.9, 0.0, 0.5)), RADAR, num_rays=2000)
    assert paths.select("T 'ego' R").num_paths > 0 and paths.select("T 'ball' R").num_paths == 0


def test_a_radar_on_its_car_sees_what_is_ahead_without_a_word():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        paths = ep.trace(road_with_car((-2.1, 0.0, 0.5)), RADAR, num_rays=2000)
    assert paths.select("T 'ball' R").num_paths > 0


def test_a_radar_in_a_cupboard_of_a_room_that_is_one_object_is_told():
    scene = ep.Scene()
    scene.add(name="room")
    for name, side, material in (("walls", 20.0, "concrete"), ("cupboard", 1.2, "metal")):
        scene.add(ep.actors.box(side), name=name, parent="room", material=material, position=(0.0, 0.0, 0.5))
    scene.add(ep.actors.sphere(0.5), name="ball", material="metal", position=(4.0, 0.0, 0.5), smooth=True)
    with pytest.warns(RuntimeWarning, match="stands inside of 'room/cupboard', which is closed"):
        paths = ep.trace(scene, RADAR, num_rays=2000)
    assert paths.select("T 'ball' R").num_paths == 0
