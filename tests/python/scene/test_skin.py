"""Skins: vertices against closed forms, and their echoes against those of the same motion told in another way."""
import h5py
import numpy as np
import pytest
from scipy.special import ellipj, ellipkm1

import echopath as ep
from support.arm import BEND, ELBOW, LENGTH, arm_weights, make_arm, tube
from support.radars import build_radar
from support.references.slow_lengths import deformed
from support.shapes import METAL, lambert

BLEND_TOLERANCE = 1e-12        # m: a few dozen operations on numbers of order 1
SPLINE_TOLERANCE = 1e-8        # m: keyframes 5 ms apart, 5/384 h^4 times the fourth derivative (below 100 m/s^4)
SPEED_TOLERANCE = 0.01         # relative: the mean over a frame about the lowest point
SAME_LENGTH = 1e-12            # m
SEAM_TOLERANCE = 1e-6          # of the field: float weights of rays that a seam would bend by degrees
GRAVITY, START_ANGLE = 9.81, np.radians(30)
CUT_TOLERANCE = 1e-5           # of the largest sample; without the cut the kink leaves radians
SAME_SIGNAL = 1e-6             # of the largest sample: the tolerance of synthesis, 1e-7 of the sum of all echoes


def make_radar(num_chirps=64, **settings):
    return build_radar(num_samples=512, num_chirps=num_chirps, **settings)


def pendulum_angle(times, length=1.0):
    """theta(t) in rad of a pendulum let go at START_ANGLE, exact for any angle (Jacobi's elliptic functions)."""
    modulus2 = np.sin(START_ANGLE / 2) ** 2
    quarter = ellipkm1(1 - modulus2)
    sine = ellipj(quarter + np.sqrt(GRAVITY / length) * np.asarray(times), modulus2)[0]
    return 2 * np.arcsin(np.sqrt(modulus2) * sine)


PERIOD = 4 * np.sqrt(1.0 / GRAVITY) * ellipkm1(np.cos(START_ANGLE / 2) ** 2)  # s


def swing(end=2.2, step=0.005):
    """Keyframes of a pendulum that hangs along -z and swings in the xz plane."""
    times = np.arange(-0.05, end, step)
    half = -0.5 * pendulum_angle(times)  # turning about -y takes -z towards +x
    zero = 0 * times
    return ep.KeyframeMotion(times=times, rotations=np.column_stack([np.cos(half), zero, np.sin(half), zero]))


def swung(point, angle):
    cos, sin = np.cos(angle), np.sin(angle)
    x, y, z = point
    return np.array([cos * x - sin * z, y, sin * x + cos * z])


def pendulum():
    """An arm whose shoulder swings, its tip 1 m below, rigid at the elbow."""
    mesh = ep.Mesh(tube().vertices / LENGTH, tube().triangles)
    return mesh, ep.Skin(mesh.vertices,
                         [ep.Joint("upper", motion=swing()), ep.Joint("fore", "upper", position=(0, 0, -0.5))],
                         arm_weights(mesh.vertices * LENGTH))


def test_the_closed_form_has_the_published_period():
    assert abs(PERIOD - 2.0410) < 5e-5
    quarters = pendulum_angle(PERIOD * np.array([0, 0.25, 0.5, 1]))
    assert np.abs(quarters - START_ANGLE * np.array([1, 0, -1, 1])).max() < BLEND_TOLERANCE


@pytest.mark.parametrize("share", [0.0, 0.11, 0.25, 0.5, 0.77, 1.0])
def test_a_skinned_pendulum_is_where_the_closed_form_says(share):
    mesh, skin = pendulum()
    time = share * PERIOD
    expected = np.array([swung(vertex, pendulum_angle(time)) for vertex in mesh.vertices])
    assert np.abs(skin.at(time) - expected).max() < SPLINE_TOLERANCE


def test_a_skinned_pendulum_has_the_doppler_of_its_tip():
    """By the energy of a pendulum, v = sqrt(2 g l (1 - cos 30 degrees)), l = 1 m: 1.62129 m/s and 838.25 Hz at the lowest
    point."""
    mesh, skin = pendulum()
    scene = ep.Scene()
    scene.add(mesh, name="pendulum", material=lambert(0.5), motion=skin, position=(8, 0, 1))
    radar = make_radar(num_chirps=128, chirp_interval=30e-6)
    start = 0.25 * PERIOD - 0.5 * 128 * 30e-6
    paths = ep.trace(scene, radar, num_rays=20000, max_bounces=1, start_time=start)
    points = paths.points(paths.frame.trace_time)[paths.offsets]
    tip = paths.select(points[:, 2] < 0.02)
    assert tip.num_paths > 10
    times = start + np.array([0.0, 128 * 30e-6])
    before, after = tip.lengths(times)
    heights = 1 - points[points[:, 2] < 0.02][:, 2]  # m below the shoulder
    speed = (after - before) / (times[1] - times[0]) / 2 / heights
    assert np.abs(speed / -1.62129 - 1).max() < SPEED_TOLERANCE  # it swings from +x to -x: towards the radar
    frequency = 2 * np.abs(speed.mean()) * radar.waveform.centre_frequency / ep.speed_of_light
    assert abs(frequency / 838.25 - 1) < SPEED_TOLERANCE
    spectrum = ep.range_doppler(ep.synthesize(tip, radar), radar, zero_pad=8)
    row = np.abs(spectrum.values[0, 0]).max(axis=1).argmax()
    assert abs(spectrum.velocity[row] / -1.62129 - 1) < 0.05  # of a cell of 0.5 m/s: the tip is a few mm of arm


def random_skin(seed, weights_as="columns"):
    rng = np.random.default_rng(seed)
    joints, count = [], 7
    for index in range(count):
        parent = None if index == 0 else f"j{rng.integers(index)}"
        motion = [None, ep.LinearMotion(rng.normal(size=3), rng.normal(size=3))][index % 3 > 0]
        transform = np.eye(4)
        transform[:3] += 0.2 * rng.normal(size=(3, 4))
        joints.append(ep.Joint(f"j{index}", parent, transform=transform, motion=motion))
    vertices, weights = rng.normal(size=(50, 3)), rng.random((50, count)) * (rng.random((50, count)) < 0.6)
    weights[:, 0] += 1e-3
    weights /= weights.sum(axis=1, keepdims=True)
    if weights_as == "columns":
        return ep.Skin(vertices, joints, weights)
    order = np.argsort(-weights, axis=1)
    return ep.Skin(vertices, joints, np.take_along_axis(weights, order, axis=1), joint_indices=order)


@pytest.mark.parametrize("weights_as", ["columns", "rows"])
def test_blending_is_that_of_an_independent_evaluation(weights_as):
    skin = random_skin(3, weights_as)
    for time in (0.0, 0.4, -1.3):
        assert np.abs(skin.at(time) - deformed(skin, time)).max() < BLEND_TOLERANCE
    assert skin.span == (-np.inf, np.inf)


def test_bind_matrices_may_differ_from_the_rest_pose():
    """As in glTF files: no rest transform, bind matrices given, the motion is the joint's own transform."""
    bind = np.eye(4)
    bind[:3, 3] = 0, 0, ELBOW
    motion = ep.LinearMotion((1, 0, 0), (0, 2, 0))
    skin = ep.Skin([[0, 0, -0.4]], [ep.Joint("fore", motion=motion, inverse_bind=bind)], [[1.0]])
    local = np.array([0, 0, -0.4 + ELBOW])
    angle = 2 * 0.3
    turned = [np.sin(angle) * local[2], 0, np.cos(angle) * local[2]]
    assert np.abs(skin.at(0.3)[0] - np.array(turned) - [0.3, 0, 0]).max() < BLEND_TOLERANCE
    assert np.array_equal(skin.joints[0].inverse_bind, bind)


def test_a_rigid_skin_is_a_rigid_node():
    motion = ep.LinearMotion((-2, 0.4, 0.1), (0, 1, 3))
    mesh = tube()
    skin = ep.Skin(mesh.vertices, [ep.Joint("all", motion=motion)], np.ones((len(mesh.vertices), 1)))
    radar, traces = make_radar(), []
    for told in (motion, skin):
        scene = ep.Scene()
        scene.add(mesh, name="arm", material=lambert(0.5), motion=told, position=(4, 0, 0.2), yaw=0.0)
        traces.append(ep.trace(scene, radar, num_rays=3000))
    one, other = traces
    assert np.array_equal(one.triangle_id, other.triangle_id) and one.num_paths > 100
    times = np.linspace(0, 0.004, 5)
    assert np.abs(one.lengths(times) - other.lengths(times)).max() < SAME_LENGTH
    assert np.abs(ep.synthesize(one) - ep.synthesize(other)).max() < SAME_SIGNAL * np.abs(ep.synthesize(one)).max()


def jerk(begin, break_time):
    """Turns by 3 rad/s until break_time, then by -5 rad/s: a kink as of motion capture."""
    times = np.array([begin, break_time, break_time + 0.1])
    half = 0.5 * np.where(times <= break_time, 3 * (times - break_time), -5 * (times - break_time))
    zero = 0 * times
    rotations = np.column_stack([np.cos(half), zero, np.sin(half), zero])
    return ep.KeyframeMotion(times=times, rotations=rotations, interpolation="linear")


def test_breakpoints_of_joints_cut_the_frame():
    radar = make_radar()
    middle = 0.37 * radar.waveform.num_chirps * radar.waveform.chirp_interval
    mesh, skin = make_arm(motions=[None, jerk(-0.1, middle)])
    assert skin.breakpoints.tolist() == [middle] and skin.span == (-0.1, middle + 0.1)
    scene = ep.Scene()
    scene.add(mesh, name="arm", material=lambert(0.5), motion=skin, position=(3, 0, 0.3))
    assert scene.breakpoints.tolist() == [middle]
    paths = ep.trace(scene, radar, num_rays=2000, max_bounces=1).select("T 'arm/fore' R")
    assert paths.num_paths > 50
    exact = ep.synthesize(paths, radar, evaluate="chirps", method="direct")
    error = np.linalg.norm(ep.synthesize(paths, radar, method="direct") - exact, axis=3)[0, 0]
    assert error.max() < CUT_TOLERANCE * np.linalg.norm(exact, axis=3).max()
    with pytest.raises(ValueError, match="arm/upper"):
        scene.require_times(0.0, 1.0)


def test_a_skinned_mesh_becomes_a_mesh_for_each_joint():
    mesh, skin = make_arm()
    scene = ep.Scene()
    assert scene.add(mesh, name="left", material="skin", motion=skin, position=(2, 0, 0)) == "left"
    assert [node.name for node in scene.nodes] == ["left", "left/upper", "left/fore"]
    assert sum(len(part.triangles) for part in scene.meshes) == len(mesh.triangles)
    for part in scene.meshes:
        assert part.mesh.whole is mesh and scene.nodes[part.node].deformation is skin
        middle = part.mesh.vertices[part.triangles].mean(axis=1)[:, 2]
        assert (middle > -ELBOW - BEND).all() if part.name == "left/upper" else (middle < -ELBOW + BEND).all()
    again = ep.Scene()  # a part is not taken apart
    again.add(mesh.part(np.arange(len(mesh.triangles)) < 100), name="piece", material="skin", motion=skin)
    assert [part.name for part in again.meshes] == ["piece"]


def smooth_ball_field(split):
    """Sum of the echoes of a smooth ball at 1 m, whole or in two parts that one skin moves."""
    ball = ep.actors.sphere(0.1, subdivisions=4)
    motion = ep.LinearMotion((0, 1, 0), (1, 2, 3))
    joints = [ep.Joint("right", motion=motion), ep.Joint("left", "right")]
    right = (ball.vertices[:, 1] < 0.004).astype(float)  # the seam runs through the glint
    weights = np.column_stack([right, 1 - right] if split else [0 * right, 1 + 0 * right])
    scene = ep.Scene()
    scene.add(ball, name="ball", material=METAL, motion=ep.Skin(ball.vertices, joints, weights), smooth=True,
              position=(1, 0, 0))
    assert len(scene.meshes) == 1 + split
    paths = ep.trace(scene, make_radar(), num_rays=1 << 13, max_bounces=1)
    times = np.array([paths.frame.trace_time, 0.01])
    phase = 2 * np.pi * 77e9 / ep.speed_of_light * paths.lengths(times)
    return (paths.amplitudes(times) * np.exp(-1j * phase)).sum(axis=1)


def test_smooth_surfaces_have_no_seams_between_joints():
    whole, parts = smooth_ball_field(False), smooth_ball_field(True)
    assert np.abs(parts / whole - 1).max() < SEAM_TOLERANCE


def skinned_scene():
    scene = ep.Scene()
    keys = jerk(-0.2, 0.05)
    for name, smooth in (("left", False), ("right", True)):
        mesh, skin = make_arm(motions=[ep.LinearMotion(angular_velocity=(0, 1, 0)), keys])
        scene.add(mesh, name=name, material=lambert(0.5), motion=skin, smooth=smooth, position=(3, 0.2, 0))
    return scene


def test_a_skin_read_back_gives_the_same_bits(tmp_path):
    scene, radar = skinned_scene(), make_radar(num_chirps=8)
    paths = ep.trace(scene, radar, num_rays=2000)
    paths.save(tmp_path / "frame.h5")
    read = ep.Paths.load(tmp_path / "frame.h5")
    assert [mesh.name for mesh in read.scene.meshes] == [mesh.name for mesh in scene.meshes]
    for mesh in scene.meshes:
        for time in (0.0, 0.11):
            assert np.array_equal(scene.world_vertices(mesh.id, time), read.scene.world_vertices(mesh.id, time))
    assert np.array_equal(paths.amplitudes([0.0, 1e-3]), read.amplitudes([0.0, 1e-3]))
    assert np.array_equal(ep.synthesize(paths), ep.synthesize(read))
    first = read.scene.nodes[read.scene.meshes[0].node].deformation
    assert first is read.scene.nodes[read.scene.meshes[1].node].deformation
    assert isinstance(first.joints[1].motion, ep.KeyframeMotion) and first.joints[1].parent == "upper"
    with h5py.File(tmp_path / "frame.h5") as file:
        assert len(file["scene/deformations"]) == 2 and len(file["scene/meshes"]) == 6  # two wholes with two parts each


@pytest.mark.parametrize("call, words", [
    (lambda: ep.Joint("a", position=(0, 0, 0), transform=np.eye(4)), ["transform", "position"]),
    (lambda: ep.Joint("a", transform=np.eye(3)), ["transform", "[4, 4]"]),
    (lambda: ep.Joint(""), ["name", "must not be empty"]),
    (lambda: ep.Skin([[0, 0, 0]], [ep.Joint("a"), ep.Joint("b", "c")], [[1, 0]]), ["joints", "earlier one as parent", "'c'"]),
    (lambda: ep.Skin([[0, 0, 0]], [ep.Joint("a")], [[0.5, 0.5]]), ["weights", "column for each joint", "got 2"]),
    (lambda: ep.Skin([[0, 0, 0]], [ep.Joint("a")], [[0.5]]), ["weights", "add up to 1", "0.5"]),
    (lambda: ep.Skin([[0, 0, 0]], [ep.Joint("a")], [[1.0]], joint_indices=[[0, 0]]), ["joint_indices", "[1, 1]"]),
    (lambda: ep.Skin([[0, 0, 0]], [ep.Joint("a")], [[1.0]]).parts(tube()), ["skin", "got 1"]),
    (lambda: tube().part([]), ["triangles", "one at least"]),
    (lambda: tube().part([True]), ["triangles"]),
])
def test_bad_skins_are_refused_by_name(call, words):
    with pytest.raises(ValueError) as caught:
        call()
    for word in words:
        assert word in str(caught.value)


def test_unknown_keywords_are_refused():
    with pytest.raises(TypeError, match="nearest right one is 'motion'"):
        ep.Joint("a", moton=None)
    with pytest.raises(TypeError, match="nearest right one is 'weights'"):
        ep.Skin([[0, 0, 0]], [ep.Joint("a")], weigths=[[1.0]], weights=[[1.0]])
    with pytest.raises(ValueError, match="Skin needs a mesh"):
        ep.Scene().add(name="x", motion=make_arm()[1])


def test_reprs_are_short():
    mesh, skin = make_arm()
    assert repr(skin) == f"Skin({len(mesh.vertices)} vertices, 2 joints)"
    assert repr(skin.joints) == "[Joint('upper'), Joint('fore', 'upper')]"
