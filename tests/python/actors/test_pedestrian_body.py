"""The body of a pedestrian: lengths of its segments, closed surfaces of even triangles that overlap at their joints."""
import numpy as np
import pytest

import echopath as ep
from echopath.actors.human.anthropometry import Proportions
from echopath.actors.human.foot import Sole
from support.scenes.pedestrians import HEIGHT, rotation

SEGMENTS = [   # parent part, its child, length as a share of the height (Drillis and Contini)
    ("leg_left/thigh", "leg_left/shank", 0.245), ("leg_right/shank", "leg_right/foot", 0.246),
    ("arm_left/upper", "arm_left/forearm", 0.186), ("arm_right/forearm", "arm_right/hand", 0.146)]


@pytest.mark.parametrize("parent, child, share", SEGMENTS)
def test_segments_have_the_published_lengths_all_the_time(person, parent, child, share):
    joints = [np.asarray(person.parts[name].motion.translations) for name in (parent, child)]
    np.testing.assert_allclose(np.linalg.norm(joints[0] - joints[1], axis=1), share * HEIGHT, rtol=1e-9)


def test_body_stands_its_height_and_foot_has_its_length(person):
    top = person.vertices("head", np.linspace(0.0, 1.2, 25))[:, :, 2].max()
    assert 0.96 * HEIGHT < top < 1.0 * HEIGHT                    # bent knees take a few per cent
    assert np.ptp(person.parts["leg_left/foot"].mesh.vertices[:, 0]) == pytest.approx(0.152 * HEIGHT, rel=0.01, abs=0)


def test_every_part_is_closed_and_faces_outwards(person):
    assert len(person.parts) >= 16
    for part in person.actor.parts:
        triangles = np.asarray(part.mesh.triangles).astype(np.int64)
        directed = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
        keys = directed[:, 0] * len(part.mesh.vertices) + directed[:, 1]
        back = directed[:, 1] * len(part.mesh.vertices) + directed[:, 0]
        assert len(np.unique(keys)) == len(keys) and np.isin(back, keys).all()
        a, b, c = np.moveaxis(np.asarray(part.mesh.vertices)[triangles], 1, 0)
        assert np.sum(a * np.cross(b, c)) > 0
        assert part.mesh.num_removed_triangles == 0


def test_triangles_are_many_enough_and_even(person):
    assert 12_000 <= person.actor.num_triangles <= 25_000  # forearms want edges below 20 mm (TessellationWarning)
    finer = ep.actors.pedestrian(edge=0.009)
    assert finer.num_triangles == pytest.approx(4 * person.actor.num_triangles, rel=0.15, abs=0)
    sides = np.concatenate([np.linalg.norm(c - np.roll(c, 1, axis=1), axis=-1).ravel() for c in
                            (np.asarray(p.mesh.vertices)[np.asarray(p.mesh.triangles)] for p in finer.parts)])
    assert np.quantile(sides, 0.99) < 1.6 * 0.009


def winding(mesh, point):
    """Times that a closed surface goes round a point: its solid angle over 4 pi (Van Oosterom and Strackee 1983)."""
    r = np.asarray(mesh.vertices)[np.asarray(mesh.triangles)] - point
    d = np.linalg.norm(r, axis=-1)
    a, b, c = np.moveaxis(r, 1, 0)
    below = (np.prod(d, axis=1) + np.sum(a * b, 1) * d[:, 2] + np.sum(b * c, 1) * d[:, 0] + np.sum(c * a, 1) * d[:, 1])
    return np.sum(np.arctan2(np.sum(a * np.cross(b, c), 1), below)) / (2.0 * np.pi)


JOINTS = [("leg_{}/thigh", "leg_{}/shank"), ("leg_{}/shank", "leg_{}/foot"), ("arm_{}/upper", "arm_{}/forearm"),
          ("arm_{}/forearm", "arm_{}/hand"), ("pelvis", "leg_{}/thigh"), ("torso", "arm_{}/upper"), ("torso", "neck"),
          ("neck", "head"), ("pelvis", "torso")]


@pytest.mark.parametrize("parent, child", JOINTS)
def test_parts_overlap_at_their_joint_through_the_cycle(person, parent, child):
    parent, child = parent.format("right"), child.format("right")
    motion = person.parts[child].motion
    for k in range(0, 140, 20):
        joint = np.asarray(motion.translations)[k]
        for name in (parent, child):
            own = person.parts[name].motion
            local = rotation(np.asarray(own.rotations)[k]).T @ (joint - np.asarray(own.translations)[k])
            assert winding(person.parts[name].mesh, local) == pytest.approx(1.0, abs=1e-6), (name, k)


def test_parts_are_smooth_bodies_of_cloth_and_skin(person):
    assert all(part.smooth for part in person.actor.parts)
    assert all(node.smooth for node in person.scene.nodes if node.mesh is not None)
    by_material = {part.name: part.material for part in person.actor.parts}
    assert {name for name, material in by_material.items() if material == "skin"} == {
        "head", "neck", "arm_left/hand", "arm_right/hand"}
    assert set(by_material.values()) == {"clothing", "skin"}


def test_feet_are_a_step_width_apart():
    """Of the height, where they stand."""
    walker = ep.actors.pedestrian(height=HEIGHT, speed=1.4)
    sides = [next(part for part in walker.parts if part.name == f"leg_{side}/foot").motion.translations[:, 1]
             for side in ("left", "right")]
    assert np.median(sides[0]) - np.median(sides[1]) == pytest.approx(Proportions(HEIGHT).step_width, rel=0.1)


def test_a_foot_in_the_air_turns_without_a_jump_of_its_height_its_slope_and_its_bend():
    """Where the polynomial about the level foot meets the arcs of heel and toe: second differences on both sides."""
    sole, lowest, highest, step = Sole.of(Proportions(HEIGHT)), -0.3, 0.2, 1e-5

    def height(pitch):
        return sole.ankle_clear_of_floor(np.asarray(pitch), lowest, highest)

    for end in (lowest, highest):
        bends = [height(end + side * 2 * step) - 2 * height(end + side * step) + height(end) for side in (-1, 1)]
        slopes = [side * (height(end + side * step) - height(end)) for side in (-1, 1)]
        assert bends[0] / step**2 == pytest.approx(bends[1] / step**2, rel=0.01)
        assert slopes[0] / step == pytest.approx(slopes[1] / step, abs=2 * step)
