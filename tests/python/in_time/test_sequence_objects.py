"""All frames of a sequence have the same objects, however the radar drives by what is flat."""
from __future__ import annotations

import numpy as np
import pytest

import echopath as ep
from support.frames_in_time import make_radar

# The sphere about the wall, of 5.2 m about (11, 4, 0) m, holds the radar from x = 7.6 to 14.3 m: at one of 0, 10, 20 m.
SPEED, INTERVAL, IS_BESIDE = 20.0, 0.5, [False, True, False]


def drive(start_time: float = 0.0, frames: int = 3) -> ep.Sequence:
    """Along an unmarked wall, behind a car."""
    scene, motion = ep.Scene(), ep.LinearMotion((SPEED, 0.0, 0.0))
    scene.add(ep.actors.plate(10.0, 3.0), name="wall", material="concrete", position=(11.0, 4.0, 0.0), yaw=-np.pi / 2)
    scene.add(ep.actors.plate(2.0, 2.0), name="target", material="metal", position=(10.0, 0.0, 0.0),
              yaw=np.pi, motion=motion)
    radar = make_radar(motion=motion)
    return ep.Sequence(scene, radar, frames=frames, interval=INTERVAL, start_time=start_time, num_rays=2000, guard=False,
                       labels=True, truth=True)


def objects_of(frame) -> list:
    """The names of the objects by all who tell of them."""
    told = [[one.name for one in frame.labels["parts"].objects], list(ep.truth(frame).name)]
    if isinstance(frame, ep.Frame):
        told += [list(ep.families(frame.paths).objects), list(ep.truth(frame.paths).name)]
    return told


def test_a_wall_beside_the_radar_is_an_object_where_it_was_one_at_first():
    for frame, is_beside in zip(drive(), IS_BESIDE):
        assert objects_of(frame) == [["wall", "target"]] * 4
        alone = ep.trace(frame.scene, frame.radar, start_time=frame.paths.frame.start_time, num_rays=2000)
        assert ("wall" not in ep.families(alone).objects) == is_beside  # else this tells nothing


def test_a_wall_beside_the_radar_at_first_is_never_an_object():
    beside = drive(start_time=INTERVAL, frames=2)
    assert [objects_of(frame) for frame in beside] == [[["target"]] * 4] * 2
    assert objects_of(beside[1]) == objects_of(beside[1:][0]) == [["target"]] * 4  # alone, too


@pytest.mark.parametrize("keep", ["all", "labels"])
def test_files_keep_the_objects(tmp_path, keep):
    stored = drive().save(tmp_path / "drive", keep=keep)
    for frame in stored:
        assert set(map(tuple, objects_of(frame))) == {("wall", "target")}


def test_the_time_of_the_objects_is_the_middle_of_frame_0(tmp_path):
    sequence = drive()
    middle = 0.5 * sequence.radar.frame_duration
    assert [frame.paths.frame.objects_time for frame in sequence] == [middle] * 3
    paths = sequence[2].paths
    paths.save(tmp_path / "paths.h5")
    assert ep.Paths.load(tmp_path / "paths.h5").frame.objects_time == middle
    assert ep.trace(sequence.scene, sequence.radar, num_rays=2000).frame.objects_time is None
