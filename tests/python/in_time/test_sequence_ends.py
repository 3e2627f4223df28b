"""What stands before or behind its way in some frames, and would go on, is told; what comes to rest is not."""
import warnings

import numpy as np
import pytest

import echopath as ep
from support.files.gltf_files import rig_file
from support.radars import build_radar

LINE = [(10.0, 0.0), (30.0, 0.0)]  # 2 s at 10 m/s
WORDS = "still in some of the frames"


def said(scene, radar, start_time: float) -> list[str]:
    """Of 5 frames, one each quarter of a second."""
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        ep.Sequence(scene, radar, frames=5, interval=0.25, start_time=start_time, num_rays=100)
    return [str(one.message) for one in told if WORDS in str(one.message)]


def street(trajectory, **placed) -> ep.Scene:
    scene = ep.Scene()
    scene.add(ep.actors.car(trajectory=trajectory), name="car", **placed)
    return scene


@pytest.mark.parametrize("start_time, is_told", [(0.0, False), (0.9, False), (1.1, True), (-0.1, True), (5.0, True),
                                                 (-9.0, True)])
def test_a_car_whose_way_is_shorter_than_the_frames_is_told(start_time, is_told):
    told = said(street(ep.Trajectory(LINE, speed=10.0)), build_radar(), start_time)
    assert [one.split(",")[0] for one in told] == ["'car' stands still in some of the frames"] * is_told


def test_the_radar_is_told_too():
    told = said(ep.Scene(), build_radar().replace(motion=ep.Trajectory(LINE, speed=10.0)), 1.5)
    assert len(told) == 1 and told[0].startswith("the radar stands still")


@pytest.mark.parametrize("trajectory, visible", [
    (ep.Trajectory(LINE, speed=10.0, stops=[(0, 0.1), (np.inf, 0)]), True), (ep.Trajectory(LINE, speed=10.0, goes_on=9.0), True),
    (ep.Trajectory(LINE, speed=10.0), False)])
def test_what_comes_to_rest_goes_on_or_is_hidden_is_not_told(trajectory, visible):
    for start_time in (-0.5, 1.5, 4.0):
        assert said(street(trajectory, visible=visible), build_radar(), start_time) == []


@pytest.mark.parametrize("span, is_told", [((0.2, 1.7), False), ((0.0, 1.0), True), ((0.6, 2.0), True), ((1.9, 2.0), True)])
@pytest.mark.parametrize("actor", [ep.actors.truck, ep.actors.runner])
def test_wheels_and_limbs_that_move_in_some_frames_alone_are_told(actor, span, is_told):
    """From 0.5 s to a little over 1.5 s, as `during` of traffic has them move."""
    scene = ep.Scene()
    ep.add_traffic(scene, {"it": ep.Trajectory(LINE, speed=4.0)}, actor_of=lambda _, trajectory: actor(trajectory=trajectory),
                   during=span)
    told = said(scene, build_radar(), 0.5)
    assert [one.split(",")[0] for one in told] == ["'it': what moves in it"] * is_told


@pytest.mark.parametrize("span, is_told", [((0.2, 1.7), False), ((0.0, 1.0), True)])
def test_joints_of_a_skin_count_as_parts(tmp_path, span, is_told):
    """Of an animated model, whose only node stands on its trajectory."""
    (tmp_path / "rig.glb").write_bytes(rig_file().glb())
    rig, scene = ep.load_model(tmp_path / "rig.glb", loop=True), ep.Scene()
    ep.add_traffic(scene, {"it": ep.Trajectory(LINE, speed=4.0)}, during=span,
                   actor_of=lambda _, trajectory: rig.along(trajectory, way=1.0))
    told = said(scene, build_radar(), 0.5)
    assert [one.split(",")[0] for one in told] == ["'it': what moves in it"] * is_told

