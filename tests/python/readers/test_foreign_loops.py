"""Animations of foreign files that begin anew: for ever, as smoothly as they are sampled, in the memory of one run."""
from __future__ import annotations

import numpy as np
import pytest

import echopath as ep
from echopath.truth import boxes_at
from fuzz.feeds.foreign_seeds import archive
from support.files.mesh_texts import obj

LATE = 12345.625  # s, far beyond anything that is stored
ROUNDING = 1e-9   # m, of times of a day
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0.0]])
FACES = np.array([[0, 1, 2], [0, 2, 3]])
STAGE = """#usda 1.0
(
    metersPerUnit = 1
    upAxis = "Z"
    timeCodesPerSecond = 10
    startTimeCode = 5
    endTimeCode = 15
)
def Xform "carrier"
{
    double3 xformOp:translate.timeSamples = { 5: (0, 0, 0), 15: (4, 0, 0), }
    uniform token[] xformOpOrder = ["xformOp:translate"]
    def Mesh "sheet"
    {
        int[] faceVertexCounts = [3]
        int[] faceVertexIndices = [0, 1, 2]
        point3f[] points.timeSamples = {
            7: [(0, 0, 0), (1, 0, 0), (0, 0, 1)],
            9: [(0, 0, 0), (1, 0, 0), (0, 0, 3)],
        }
    }
}
"""


def scene_of(model) -> ep.Scene:
    scene = ep.Scene()
    scene.add(model, name="m")
    return scene


def at(time: float, period: float, begin: float, end: float) -> float:
    """What goes from 0 to 1 between two times of each run."""
    return float(np.clip((time % period - begin) / (end - begin), 0.0, 1.0))


@pytest.mark.parametrize("offset", [0.0, 0.35])
def test_transforms_and_points_of_usd_go_on_for_ever(tmp_path, offset):
    (tmp_path / "stage.usda").write_text(STAGE)
    model = ep.load_model(tmp_path / "stage.usda", loop=True, offset=offset)
    assert (model.duration, model.animation) == (1.0, "timeline")
    assert any(f"vertices jump by up to {np.hypot(4, 2):.2g} m wherever the loop" in note for note in model.notes)
    scene = scene_of(model)
    for time in (0.0, 0.25, 0.85, 7.3, LATE, -3.25):
        x, z = 4.0 * at(time + offset, 1.0, 0.0, 1.0), 1.0 + 2.0 * at(time + offset, 1.0, 0.2, 0.4)
        wanted = [[x, 0, 0], [x + 1, 0, 0], [x, 0, z]]
        assert np.abs(scene.world_vertices(0, time) - wanted).max() < ROUNDING, time


def test_notes_of_loops_tell_jumps_at_any_offset_and_of_no_closed_way(tmp_path):
    """A small body that goes round a closed square of 200 m, and one that goes ahead, late in a recording."""
    corners = [(0, 0), (200, 0), (200, 200), (0, 200), (0, 0)]
    samples = ", ".join(f"{5.0 + 2.5 * k}: ({x}, {y}, 0)" for k, (x, y) in enumerate(corners))
    small = STAGE.replace("(1, 0, 0), (0, 0, 1)", "(.1, 0, 0), (0, 0, .1)")
    small = small.replace("(1, 0, 0), (0, 0, 3)", "(.1, 0, 0), (0, 0, .1)")
    for text, offset, jumps in ((small.replace("5: (0, 0, 0), 15: (4, 0, 0)", samples), 0.0, False), (small, 0.9e9, True)):
        (tmp_path / "stage.usda").write_text(text)
        model = ep.load_model(tmp_path / "stage.usda", loop=True, offset=offset)
        assert any("vertices jump by up to 4 m" in note for note in model.notes) == jumps
        assert any("jump" in note for note in model.notes) == jumps


@pytest.mark.parametrize("offset", [0.0, 0.35])
def test_loops_of_usd_are_the_range_of_the_stage(tmp_path, offset):
    """Samples before its first frame and after its last one, as of a lead-in, are played once at most."""
    text = STAGE.replace("startTimeCode = 5", "startTimeCode = 8").replace("endTimeCode = 15", "endTimeCode = 12")
    (tmp_path / "stage.usda").write_text(text)
    model = ep.load_model(tmp_path / "stage.usda", loop=True, offset=offset)
    assert model.duration == 0.4
    scene = scene_of(model)
    for time in (0.0, 0.25, 0.39, 0.85, 7.3, LATE, -3.25):
        code = 8.0 + 10.0 * ((time + offset) % 0.4)
        x, z = 4.0 * (code - 5.0) / 10.0, 1.0 + 2.0 * min(1.0, (code - 7.0) / 2.0)
        wanted = [[x, 0, 0], [x + 1, 0, 0], [x, 0, z]]
        assert np.abs(scene.world_vertices(0, time) - wanted).max() < ROUNDING, time
    once = scene_of(ep.load_model(tmp_path / "stage.usda", offset=offset))
    assert once.world_vertices(0, -0.2 - offset)[0, 0] == pytest.approx(0.4, abs=ROUNDING)


@pytest.mark.parametrize("beside", [-8e-5, -2e-5, 0.0, 2e-5, 8e-5])
def test_bodies_whose_loop_begins_anew_are_as_fast_as_before_and_after(tmp_path, beside):
    """The sheet goes 4 m/s ahead, back to its begin every second, 0.67 m down: no difference across that is a velocity."""
    (tmp_path / "stage.usda").write_text(STAGE)
    scene = scene_of(ep.load_model(tmp_path / "stage.usda", loop=True))
    boxes = boxes_at(scene, [["m"]], 3.0 + beside, 0.01)
    assert boxes.velocity[0] == pytest.approx([4.0, 0.0, 0.0], abs=1e-6)


def test_loops_keep_one_run_alone(tmp_path):
    (tmp_path / "stage.usda").write_text(STAGE)
    once, looped = (ep.load_model(tmp_path / "stage.usda", loop=loop) for loop in (False, True))
    for first, second in zip(once.nodes, looped.nodes):
        if first.motion is not None:
            assert len(second.motion.translation.times) == len(first.motion.translation.times) == 2
            assert (first.motion.period, second.motion.period) == (None, 1.0)
        if first.deformation is not None:
            assert len(second.deformation.times) == len(first.deformation.times) == 4
    assert scene_of(looped).breakpoints.size < 10


def circling(count: int = 24, period: float = 0.5) -> tuple[np.ndarray, np.ndarray]:
    """(times [T] s, frames [T, 4, 3]) of a sheet that goes round in a circle of 1 m; its last frame is its first."""
    times = np.linspace(0.0, period, count + 1)
    turn = 2.0 * np.pi * np.arange(count + 1) / count
    turn[-1] = 0.0
    return times, CORNERS + np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)[:, None]


def write_frames(tmp_path, times, frames) -> list:
    (tmp_path / "sheet.npz").write_bytes(archive(vertices=frames, triangles=FACES, times=times))
    folder = tmp_path / "sheet"
    folder.mkdir()
    for number, vertices in enumerate(frames):
        (folder / f"{number}.obj").write_bytes(obj(vertices, FACES))
    (folder / "frame_rate.txt").write_text(f"{1.0 / times[1]}")
    return [tmp_path / "sheet.npz", folder]


def test_closed_loops_of_frames_are_smooth_through_their_seam(tmp_path):
    """A circle through 24 points: splines err by 5/384 (2 pi / 24)^4 m, at the seam as elsewhere (Hall and Meyer 1976)."""
    bound, step = 5 / 384 * (2 * np.pi / 24) ** 4, 1e-4
    for path in write_frames(tmp_path, *circling()):
        scene = scene_of(ep.load_model(path, loop=True))
        on_circle = lambda time: np.array([np.cos(4 * np.pi * time), np.sin(4 * np.pi * time), 0.0])
        for time in (0.0, 0.01, 0.49, 0.4999, 0.51, 3.3, LATE):
            assert np.abs(scene.world_vertices(0, time)[0] - on_circle(time)).max() < 1.01 * bound + ROUNDING, (path.name, time)
        places = [scene.world_vertices(0, time)[0] for time in (0.5 - step, 0.5, 0.5 + step)]
        speed = np.diff(places, axis=0) / step
        assert np.linalg.norm(speed[1] - speed[0]) < 1.1 * (4 * np.pi) ** 2 * step  # the acceleration of the circle
        sequence = ep.load_model(path, loop=True).nodes[0].deformation
        assert len(sequence.times) == 25 + 2 * 16 and sequence.period == pytest.approx(0.5)


def test_loops_of_frames_that_are_not_closed_begin_anew_and_say_so(tmp_path):
    times = np.arange(5) / 20.0
    frames = CORNERS + times[:, None, None] * [0.0, 0.0, 1.5]
    for path in write_frames(tmp_path, times, frames):
        model = ep.load_model(path, loop=True)
        assert any("vertices jump by up to 0.3 m wherever the loop begins anew" in note for note in model.notes)
        scene = scene_of(model)
        for time in (0.0, 0.1, 0.199, 0.201, LATE):
            assert scene.world_vertices(0, time)[:, 2] == pytest.approx(1.5 * (time % 0.2), abs=1e-8)
        assert not any("jump" in note for note in ep.load_model(path).notes)


def test_frames_of_a_looped_mesh_sound_alike_run_by_run_and_are_kept_in_files(tmp_path):
    path = write_frames(tmp_path, *circling())[0]
    scene = ep.Scene()
    rough = ep.Material(permittivity=5.0, scattering=0.7)
    scene.add(ep.load_model(path, loop=True, offset=0.1, materials={"*": rough}), name="sheet", position=(5, 0, -3))
    waveform = ep.ChirpSequence(start_frequency=10e9, bandwidth=150e6, num_samples=32, sampling_rate=5e6, num_chirps=32,
                                chirp_interval=1e-3)
    radar = ep.Radar(waveform, transmitters=[ep.Antenna()], receivers=[ep.Antenna()])
    frames = [ep.simulate(scene, radar, num_rays=500, max_bounces=1, start_time=start, guard=False) for start in (0.38, 2.38)]
    assert np.abs(frames[0].cube).max() > 0.0  # through the seam, at 0.4 s
    assert np.abs(frames[1].cube - frames[0].cube).max() < 1e-6 * np.abs(frames[0].cube).max()
    ep.save_frame(frames[0], tmp_path / "frame.h5")
    again = ep.load_frame(tmp_path / "frame.h5").paths.scene
    for time in (0.0, 0.39, LATE):
        assert np.array_equal(again.world_vertices(0, time), scene.world_vertices(0, time))


def test_sequences_that_do_not_hold_their_period_are_refused_by_name():
    frames = np.stack([CORNERS, CORNERS])
    for arguments, said in (({"period": 2.0}, "times: must reach to the period; end, got 1"),
                            ({"period": 0.0}, "period: must be 1e-6 to 1e9 s, or None, got 0"),
                            ({"offset": 0.5}, "offset: must be 0 s without a period, got 0.5")):
        with pytest.raises(ValueError, match=said):
            ep.VertexSequence([0.0, 1.0], frames, **arguments)
    with pytest.raises(ValueError, match="times: must begin at 0 s or before, where there is a period; begin, got 0.1"):
        ep.VertexSequence([0.1, 1.0], frames, period=0.5)
