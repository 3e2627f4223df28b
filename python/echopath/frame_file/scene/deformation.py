"""Vertex sequences, skins and morph targets in HDF5 groups (layout: data/README.md)."""
from __future__ import annotations

import numpy as np

from ... import _core
from ..h5 import blames_group, read_array, read_attribute, read_group, read_texts, write_array, write_attribute, write_texts
from .curves import read_morph_targets, read_playback, write_morph_targets, write_playback
from .kinds import Kind, read_kind, write_kind
from .motion import read_motion, write_motion


def write_deformation(group, deformation) -> None:
    """Writes a vertex sequence, a skin or morph targets."""
    write_kind(group, deformation, _KINDS, "a VertexSequence, Skin or MorphTargets to deform a mesh")


@blames_group
def read_deformation(group):
    """The vertex sequence, skin or morph targets of a group."""
    return read_kind(group, _KINDS, "deformation")


def _write_sequence(group, sequence) -> None:
    write_attribute(group, "interpolation", sequence.interpolation)
    if sequence.period is not None:
        write_playback(group, sequence)
    write_array(group, "times", sequence.times, unit="s")
    write_array(group, "vertices", sequence.vertices, unit="m")


def _read_sequence(group):
    times = read_array(group, "times", np.float64, (None,))
    playback = read_playback(group) if "period" in group.attrs else {}
    return _core.VertexSequence(times, read_array(group, "vertices", np.float64, (len(times), None, 3)),
                                read_attribute(group, "interpolation", str), **playback)


def _write_skin(group, skin) -> None:
    joints = skin.joints
    names = [joint.name for joint in joints]
    write_texts(group, "joint", names)
    parents = [-1 if joint.parent is None else names.index(joint.parent) for joint in joints]
    write_array(group, "parent", np.array(parents, np.int32))
    write_array(group, "placement", np.array([joint.transform for joint in joints]), unit="m")
    write_array(group, "inverse_bind", np.array([joint.inverse_bind for joint in joints]), unit="m")
    motions = group.create_group("motions")
    for index, joint in enumerate(joints):
        if joint.motion is not None:
            write_motion(motions.create_group(str(index)), joint.motion)
    write_array(group, "vertices", skin.vertices, unit="m", compress=True)
    write_array(group, "weights", skin.weights, compress=True)
    write_array(group, "joint_indices", skin.joint_indices, compress=True)
    if skin.shape is not None:
        write_deformation(group.create_group("shape"), skin.shape)


def _read_skin(group):
    names = read_texts(group, "joint")
    count = len(names)
    parents = read_array(group, "parent", np.int32, (count,))
    placements = read_array(group, "placement", np.float64, (count, 4, 4))
    inverse_binds = read_array(group, "inverse_bind", np.float64, (count, 4, 4))
    motions = read_group(group, "motions")
    joints = []
    for index, name in enumerate(names):
        parent = int(parents[index])
        if not -1 <= parent < index:
            raise _core.FileError(f"{group.name}/parent: must name an earlier joint, is {parent} at joint {index}")
        motion = read_motion(read_group(motions, str(index))) if str(index) in motions else None
        joints.append(_core.Joint(name, None if parent < 0 else names[parent], transform=placements[index], motion=motion,
                                  inverse_bind=inverse_binds[index]))
    vertices = read_array(group, "vertices", np.float64, (None, 3))
    weights = read_array(group, "weights", np.float64, (len(vertices), None))
    indices = read_array(group, "joint_indices", np.uint32, weights.shape)
    return _core.Skin(vertices, joints, weights, joint_indices=indices, shape=_read_shape(group))


def _read_shape(group):
    """What shapes the vertices before the joints move them, or None; a file may nest them no deeper."""
    if "shape" not in group:
        return None
    shape = read_group(group, "shape")
    if read_attribute(shape, "kind", str) == "skin":  # skins in skins may be nested without end
        raise _core.FileError(f"{shape.name}: must not be a skin")
    return read_deformation(shape)


_KINDS = {"skin": Kind(_core.Skin, _write_skin, _read_skin),
          "morph": Kind(_core.MorphTargets, write_morph_targets, read_morph_targets),
          "vertices": Kind(_core.VertexSequence, _write_sequence, _read_sequence)}
