"""Lengths from replay against an independent evaluation in NumPy, for everything that moves."""
import warnings

import numpy as np
import pytest

import echopath as ep
from support.arm import make_arm
from support.radars import build_radar
from support.references import slow_lengths
from support.shapes import quad

LENGTH_TOLERANCE = 1e-12  # m
ROUGH = ep.Material(reflectivity=0.5, scattering=0.7)
TRANSMITTERS, RECEIVERS = [(0, 0, 0.2), (0.1, 0.3, 0)], [(0, 0.01, 0.2), (-0.05, 0, 0), (0, -0.2, 0.1)]


def make_radar(motion=None):
    return build_radar(TRANSMITTERS, RECEIVERS, num_chirps=64, chirp_interval=1e-4, motion=motion)


def wall():
    return quad((-5, 3, -5), (20, 3, -5), (20, 3, 6), (-5, 3, 6))


def linear_keys(rotation_step):
    times = np.linspace(-0.5, 0.5, 6)
    angles = np.outer(times, rotation_step)
    half = 0.5 * np.linalg.norm(angles, axis=1)
    axis = np.array(rotation_step) / np.linalg.norm(rotation_step)
    rotations = np.column_stack([np.cos(half), np.outer(np.sign(times) * np.sin(half), axis)])
    return ep.KeyframeMotion(times=times, translations=np.outer(times**2, [1, -2, 0.5]), rotations=rotations,
                             interpolation="linear")


def rigid(scene):
    scene.add(name="car", position=(6, 0.5, 0), yaw=0.3, motion=ep.LinearMotion((-3, 1, 0), (0, 0.1, 0.6)))
    scene.add(ep.actors.box((1.0, 0.8, 0.6)), name="body", material=ROUGH, parent="car", motion=linear_keys([0.2, 1, 3]))
    uneven = np.diag([0.2, 0.3, 0.25, 1.0])
    uneven[:3, 3] = 4.5, -1.2, 0.2
    scene.add(ep.actors.sphere(1.0, subdivisions=3), name="egg", material="metal", smooth=True, transform=uneven,
              motion=ep.LinearMotion((1, 0, 2), (9, 5, 7)))


def vertex_sequence(scene):
    mesh = ep.actors.sphere(0.5, subdivisions=3)
    times = np.linspace(-0.02, 0.03, 9)
    grown = [mesh.vertices * (1 + 0.4 * np.sin(150 * t + 4 * mesh.vertices)) for t in times]
    sequence = ep.VertexSequence(times=times, vertices=grown, interpolation="linear")
    for index, smooth in enumerate((False, True)):
        scene.add(mesh, name=f"jelly{index}", material=ROUGH, motion=sequence, smooth=smooth, position=(5, 1.2 * index, 0))


def skin(scene):
    mesh, arm = make_arm(motions=[ep.LinearMotion(angular_velocity=(0, 4, 0)), linear_keys([0, 3, 1])])
    for index, smooth in enumerate((False, True)):
        scene.add(mesh, name=f"arm{index}", material=ROUGH, motion=arm, smooth=smooth, position=(4, 0.6 * index - 0.3, 0.5))


def mirrors(scene):
    scene.add(wall(), name="wall", material=ep.Material(permittivity=5 - 0.3j, scattering=0.3, mirror=True),
              motion=ep.LinearMotion((0, -2, 0.5), (0, 0, 0.02)))
    scene.add(quad((-5, -9, -1), (30, -9, -1), (30, 9, -1), (-5, 9, -1)), name="floor",
              material=ep.Material.metal(mirror=True))
    rigid(scene)


def everything(scene):
    mirrors(scene)
    vertex_sequence(scene)
    skin(scene)


@pytest.mark.filterwarnings("ignore::echopath.TessellationWarning")
@pytest.mark.parametrize("build, radar_motion", [
    (rigid, None), (vertex_sequence, None), (skin, None), (mirrors, None),
    (rigid, ep.LinearMotion((15, 1, 0), (0, 0, 0.4))), (everything, linear_keys([1, 0, 2]))])
def test_lengths_are_those_of_an_independent_evaluation(build, radar_motion):
    scene = ep.Scene()
    build(scene)
    radar = make_radar(radar_motion)
    paths = ep.trace(scene, radar, num_rays=600, max_bounces=3)
    paths = paths.select(np.arange(paths.num_paths) % (1 + paths.num_paths // 250) == 0)  # the slow one is slow
    assert paths.num_paths > 40 and (build is skin or build is rigid or paths.num_bounces.max() > 1)
    for time in (0.0, 0.0231, paths.frame.trace_time):
        for tx, transmitter in enumerate(TRANSMITTERS):
            for rx, receiver in enumerate(RECEIVERS):
                expected = slow_lengths.lengths(paths, time, np.array(transmitter), np.array(receiver))
                assert np.abs(paths.lengths([time], tx, rx)[0] - expected).max() < LENGTH_TOLERANCE


def test_values_at_a_time_have_the_same_bits_whatever_other_times_stand_beside_it():
    scene = ep.Scene()
    everything(scene)
    paths = ep.trace(scene, make_radar(), num_rays=3000, seed=4, max_bounces=3)
    times = list(np.linspace(0.0, 0.006, 21))  # more than are evaluated together
    for values in (paths.lengths, paths.amplitudes):
        together, alone = values(times, 1, 2), [values([time], 1, 2)[0] for time in times]
        assert together.shape == (21, paths.num_paths) and np.array_equal(together, alone)
    assert paths.lengths([]).shape == (0, paths.num_paths)


def test_times_outside_of_a_motion_are_refused_whatever_paths_touch():
    """Behind the radar something moves by keyframes that end at .5 s: no path meets it, so that none poses it."""
    scene = ep.Scene()
    scene.add(wall(), name="wall", material=ROUGH)
    scene.add(ep.actors.box((1.0, 0.8, 0.6)), name="behind", material=ROUGH, position=(-30, 0, 0),
              motion=linear_keys([0.2, 1, 3]))
    paths = ep.trace(scene, make_radar(), num_rays=300, max_bounces=1).select("T 'wall' R")
    assert paths.lengths([0.4], 0, 0).size > 0
    with pytest.raises(ValueError, match=r"^motion: must be defined at 0\.6 s .*behind"):
        paths.lengths([0.6], 0, 0)


@pytest.mark.parametrize("way", ["hidden", "absent"])
def test_what_takes_no_part_is_not_asked_at_other_times(way):
    """A mesh that deforms from 10 s on leaves no trace in a frame before it: the signal is that of a scene without it."""
    scene, without, radar = ep.Scene(), ep.Scene(), make_radar()
    for one in (scene, without):
        one.add(wall(), name="wall", material=ROUGH, motion=ep.LinearMotion(velocity=(1, 0, 0)))
    sheet = np.array([[0, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    scene.add(ep.Mesh(sheet, [[0, 1, 2]]), name="flag", material=ROUGH, position=(8, 3, 0),
              motion=ep.VertexSequence(times=[10, 11], vertices=[sheet, 1.1 * sheet]))
    if way == "hidden":
        scene["flag"].visible = False
    else:
        scene["flag"].lifetime = (10, 11)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "'flag' is absent", RuntimeWarning)
        paths = ep.trace(scene, radar, num_rays=300)
    expected = ep.synthesize(ep.trace(without, radar, num_rays=300), radar)
    assert np.any(expected) and np.array_equal(ep.synthesize(paths, radar), expected)
