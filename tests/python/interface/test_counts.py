"""Counts in warnings say little of their own, so that frames in a row repeat one text."""
from types import SimpleNamespace

import pytest

import echopath as ep
from echopath.base.text.counts import at_least, counted, named
from echopath.cli.dataset import _forecast_line as forecast_line
from echopath.cli.info import _describe_scene
from echopath.dataset import Forecast
from echopath.tracing.lost_rays import unaimed
from support.radars import build_radar


def test_a_count_is_said_in_few_ways_none_of_which_says_too_much():
    said = {count: int(at_least(count).removeprefix("at least ").replace(",", "")) for count in range(1, 5001)}
    assert all(count / 2.5 < least <= count for count, least in said.items())
    assert len(set(said.values())) == 12  # 1, 2, 5 to 1000, 2000, 5000
    assert at_least(40) == "at least 20" and at_least(123_456) == "at least 100,000"


def test_one_thing_is_not_said_as_several():
    assert [counted(1, thing) for thing in ("ray", "mesh", "vertex", "box")] == ["1 ray", "1 mesh", "1 vertex", "1 box"]
    assert [counted(2, thing) for thing in ("ray", "mesh", "vertex", "box")] == ["2 rays", "2 meshes", "2 vertices", "2 boxes"]
    assert counted(0, "path") == "0 paths" and counted(12_000, "path") == "12,000 paths"
    assert named(1, "cell") == "cell" and named(3, "cell") == "cells"


@pytest.mark.parametrize("count, words", [(1, "1 object or image has no rays of its own"),
                                          (2, "2 objects and images have no rays of their own")])
def test_effects_tell_of_one_object_as_of_one(count, words):
    assert unaimed(SimpleNamespace(num_unaimed=count)) == words


def test_lines_about_one_thing_say_it_as_one():
    scene = ep.Scene()
    scene.add(ep.Mesh([(5, 0, 0), (5, 1, 0), (5, 0, 1)], [(0, 1, 2)]), name="one", material="metal")
    assert any(line.endswith(" 1 triangle, metal") for line in _describe_scene(scene, build_radar(), 0.0))
    assert repr(scene["one"]).endswith(", 1 mesh)")
    assert forecast_line(Forecast(frames=1, seconds=60.0, bytes=2 ** 20)).startswith("1 frame to be made")
