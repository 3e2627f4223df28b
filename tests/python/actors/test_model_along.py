"""Animated models along trajectories: feet that stand stay where they are, poses go with the distance."""
import math

import numpy as np
import pytest

import echopath as ep
from echopath.readers.played import PlayedCurve
from support.files.gltf_files import BOX, BOX_SIDES, GltfFile, rig_file
from support.files.scene_text import ANTENNAS, WAVEFORM

STEP = 0.6           # m, that a foot is pushed back while it stands, half a loop of 1 s
WAY = 2 * STEP       # of a loop
STANDS = 2e-4        # m, of single precision and curves
AHEAD = ep.Trajectory([(0, 0), (9, 0)], speed=1.7, stops=[(0, 0.2), (4.0, 0.6), (math.inf, 0)])


def two_feet(forward=(0.0, 0.0, 1.0), drift=0.0) -> GltfFile:
    """Blocks that are pushed back on the ground and swung forward above it in turn, along an axis of the file, y up.

    drift: m that both go ahead in a loop beside that
    """
    file = GltfFile()
    mesh = file.mesh(BOX * 0.05 + [0, 0.05, 0], BOX_SIDES)
    ahead, up = np.array(forward), np.array([0.0, 1.0, 0.0])
    foot = np.array([0.5 * STEP * ahead, -0.5 * STEP * ahead, 0.3 * up, 0.5 * STEP * ahead])
    times = np.array([0.0, 0.5, 0.75, 1.0])
    other = np.array([-0.5 * STEP * ahead, 0.3 * up, 0.5 * STEP * ahead, -0.5 * STEP * ahead])
    other_times = np.array([0.0, 0.25, 0.5, 1.0])
    side = np.cross(up, ahead) * 0.2
    file.json |= {"nodes": [{"name": "left", "mesh": mesh}, {"name": "right", "mesh": mesh}], "scenes": [{"nodes": [0, 1]}]}
    rows = [(0, times, foot + side), (1, other_times, other - side)]
    file.animation(*((node, "translation", at, places + drift * at[:, None] * ahead, "LINEAR") for node, at, places in rows))
    return file


def loaded(tmp_path, file, **options):
    (tmp_path / "walker.glb").write_bytes(file.glb())
    return ep.load_model(tmp_path / "walker.glb", **{"loop": True} | options)


def world(model, name, times):
    scene = ep.Scene()
    scene.add(model, name="m")
    mesh = next(mesh.id for mesh in scene.meshes if mesh.name.endswith(name))
    return np.array([scene.world_vertices(mesh, float(time)).mean(axis=0) for time in times])


@pytest.mark.parametrize("forward", [(0, 0, 1), (1, 0, 0), (0.6, 0, -0.8)])
def test_feet_that_are_pushed_back_stand_on_the_trajectory(tmp_path, forward):
    """In place, whichever way the model looks, through a start and stops: the way of a loop is found by itself."""
    model = loaded(tmp_path, two_feet(forward)).along(AHEAD)
    assert model.motion is AHEAD and any("played once in 1.2 m" in note for note in model.notes)
    times = np.arange(AHEAD.begin, AHEAD.end, 0.004)
    share = np.mod(AHEAD.distance(times) / WAY, 1.0)
    for name, stands in (("left", share < 0.5), ("right", share >= 0.5)):
        places = world(model, name, times)
        assert np.abs(places[stands, 2] - places[:, 2].min()).max() < STANDS
        both = stands[1:] & stands[:-1] & (np.abs(np.diff(share)) < 0.2)
        assert both.sum() > 200 and np.abs(np.diff(places, axis=0)[both]).max() < STANDS
        assert places[:, 2].max() > 0.25
    side = world(model, "left", times)[:, 1] - world(model, "right", times)[:, 1]
    assert side == pytest.approx(0.4, abs=1e-3)  # to the left of the other one, as it looks


def test_a_way_of_its_own_is_taken_out(tmp_path):
    """An animation that goes 1.2 m ahead by itself: its feet stand in the file's own axes, and so they do along the way."""
    given = loaded(tmp_path, two_feet(drift=WAY))
    model = given.along(AHEAD)
    jumps = [[note for note in one.notes if "jump" in note] for one in (given, model, loaded(tmp_path, two_feet()))]
    assert jumps == [["the last pose is not the first: vertices jump by up to 1.2 m wherever the loop begins anew"], [], []]
    times = np.arange(1.0, 2.0, 0.01)
    share = np.mod(AHEAD.distance(times) / WAY, 1.0)
    places = world(model, "left", times)
    both = (share[1:] < 0.5) & (share[:-1] < 0.5) & (np.diff(share) > 0.0)
    assert both.sum() > 10 and np.abs(np.diff(places, axis=0)[both]).max() < STANDS
    assert np.abs(places[:, 0] - AHEAD.position(times)[:, 0]).max() < STEP  # it does not run away from its trajectory


@pytest.mark.parametrize("interpolation", ["LINEAR", "STEP"])
def test_a_skin_bends_by_the_distance(tmp_path, interpolation):
    """A tube that bends by 90 degrees and back in 2 s, once in 4 m: at half the way as at 1 s, and so on in loops."""
    given = loaded(tmp_path, rig_file(interpolation=interpolation))
    even = ep.Trajectory([(0, 0), (20, 0)], speed=2.0)
    scenes = []
    for model in (given, given.along(even, way=4.0)):
        scene = ep.Scene()
        scene.add(model, name="m")
        scenes.append(scene)
    for time in (0.03, 0.61, 1.4, 3.37, 7.9):
        phase = float(np.mod(even.distance(time) / 4.0, 1.0))
        for mesh in scenes[0].meshes:
            still, moved = scenes[0].world_vertices(mesh.id, 2.0 * phase), scenes[1].world_vertices(mesh.id, time)
            assert moved - even.position(time) == pytest.approx(still, abs=5e-5)
    with pytest.raises(ValueError, match="way: must be given, in m of a loop"):
        given.along(even)


@pytest.mark.parametrize("offset", [0.0, 0.3, -0.9])
def test_bones_that_go_ahead_do_so_along_the_trajectory_whatever_the_offset(tmp_path, offset):
    """A tube whose lower bone goes 3 m ahead in its loop of 2 s, while the upper one bends aside and back."""
    file = rig_file()
    animation = file.json["animations"][0]
    animation["channels"].append({"sampler": len(animation["samplers"]), "target": {"node": 1, "path": "translation"}})
    animation["samplers"].append({"input": file.accessor([0, 2]), "output": file.accessor([[0, 0, 0], [0, 0, 3]])})
    model = loaded(tmp_path, file, offset=offset).along(ep.Trajectory([(0, 0), (9, 0)], speed=3.0))
    assert any("played once in 3 m" in note for note in model.notes)
    lower, upper = (world(model, name, [0.0, 0.5])[:, :2] for name in ("lower", "upper"))
    assert np.abs(lower - [[0, 0], [1.5, 0]]).max() < 0.1
    assert upper[1, 1] < -0.1  # the file's -x, the right of who looks along its z


EVEN, WAY_OF_TURN = ep.Trajectory([(0, 0), (12, 0)], speed=3.0), 1.5  # two loops in a second


def test_what_is_played_has_the_rates_of_what_it_plays():
    """A smooth curve of one wave, and its cosine: at the keys too, where radial velocities would tell wrong tangents."""
    keys = np.linspace(0.0, 1.2, 49)
    wave = 2.0 * np.pi / 1.2
    values, rates = (np.outer(one, [0.0, 1.0, 0.0]) for one in (np.sin(wave * keys), wave * np.cos(wave * keys)))
    played = PlayedCurve(ep.Curve(keys, values, "hermite", in_tangents=rates, out_tangents=rates), 1.2, False)
    curve = played.along(EVEN, WAY_OF_TURN)
    motion, step = ep.CurveMotion(curve), 1e-5
    times = np.concatenate([curve.times[(curve.times > 0.1) & (curve.times < 3.9)][::7], np.linspace(0.2, 3.8, 50)])
    places = [[motion.at(time + late)[1, 3] for late in (-step, step)] for time in times]
    found = np.diff(places, axis=1)[:, 0] / (2.0 * step)
    assert found == pytest.approx(4.0 * np.pi * np.cos(4.0 * np.pi * times), abs=0.005 * 4.0 * np.pi)


def test_what_turns_round_once_in_a_loop_goes_on_in_the_next_ones():
    """Its quaternions end with the other sign than they begin with."""
    angles = np.linspace(0.0, 2.0 * np.pi, 5)
    values = np.stack([np.cos(0.5 * angles), 0.0 * angles, 0.0 * angles, np.sin(0.5 * angles)], axis=-1)
    curve = PlayedCurve(ep.Curve(np.linspace(0.0, 1.0, 5), values, "linear"), 1.0, True).along(EVEN, WAY_OF_TURN)
    assert len(curve.times) < 1000
    motion, step = ep.CurveMotion(rotation=curve), 1e-5
    for time in np.linspace(0.01, 2.2, 111):
        turn = 4.0 * np.pi * time
        before, now, after = (motion.at(time + late)[:2, 0] for late in (-step, 0.0, step))
        assert now == pytest.approx([np.cos(turn), np.sin(turn)], abs=2e-4)
        rate = (after - before) / (2.0 * step)
        assert rate == pytest.approx(4.0 * np.pi * np.array([-np.sin(turn), np.cos(turn)]), abs=0.02 * 4.0 * np.pi)


def test_what_cannot_go_along_is_refused(tmp_path):
    file = two_feet()
    with pytest.raises(ValueError, match="model: must have a looped animation"):
        loaded(tmp_path, file, loop=False).along(AHEAD)
    model = loaded(tmp_path, file)
    with pytest.raises(TypeError, match="trajectory: must be a Trajectory"):
        model.along(3)
    with pytest.raises(ValueError, match="way: must be a finite number above 0 m"):
        model.along(AHEAD, way=0.0)
    scene = ep.Scene()
    with pytest.raises(ValueError, match="motion: must be left out for an actor or model"):
        scene.add(model.along(AHEAD), name="m", motion=AHEAD)
    vertices = np.stack([BOX, BOX + 0.1])
    np.savez(tmp_path / "frames.npz", vertices=vertices, triangles=BOX_SIDES, frame_rate=10.0)
    with pytest.raises(ValueError, match="model: must be animated by curves"):
        ep.load_model(tmp_path / "frames.npz", loop=True).along(AHEAD)


def test_a_scene_file_lets_a_model_go_along(tmp_path):
    (tmp_path / "walker.glb").write_bytes(two_feet().glb())
    text = WAVEFORM + ANTENNAS + """
[[objects]]
name = "walker"
model = "walker.glb"
loop = true
way = {way}
trajectory = {{points = [[3, 0], [9, 0]], speed = 1.5}}
"""
    for way, feet in (('"auto"', 1.2), ("1.5", 1.5)):
        (tmp_path / "scene.toml").write_text(text.format(way=way))
        scene = ep.load_scene(tmp_path / "scene.toml").scene
        motions = [node.motion.translation.times for node in scene.nodes if node.name.endswith("left")]
        assert np.min(np.abs(motions[0] - 2 * feet / 1.5)) < 1e-6  # a key where the second loop ends
    for way, words in (("-1.0", "objects.0..way: must be a finite number above 0"), ("true", "objects.0..way: must be")):
        (tmp_path / "scene.toml").write_text(text.format(way=way))
        with pytest.raises(ValueError, match=words):
            ep.load_scene(tmp_path / "scene.toml")
    (tmp_path / "scene.toml").write_text(text.format(way="1.0").replace("loop = true\n", ""))
    with pytest.raises(ValueError, match="objects.0..way: model: must have a looped animation"):
        ep.load_scene(tmp_path / "scene.toml")
