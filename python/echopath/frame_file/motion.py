"""Motions in HDF5 groups (layout: data/README.md)."""
from __future__ import annotations

import numpy as np

from .. import _core
from .curves import read_curve_motion, write_curve_motion
from .h5 import blames_group, read_array, read_attribute, write_array, write_attribute


def write_motion(group, motion) -> None:
    """Writes a linear motion, keyframes or curves."""
    if isinstance(motion, _core.LinearMotion):
        write_attribute(group, "kind", "linear")
        write_array(group, "velocity", motion.velocity, unit="m/s")
        write_array(group, "angular_velocity", motion.angular_velocity, unit="rad/s")
        return
    if isinstance(motion, _core.CurveMotion):
        write_attribute(group, "kind", "curves")
        write_curve_motion(group, motion)
        return
    if not isinstance(motion, _core.KeyframeMotion):
        raise ValueError(f"motion: must be a LinearMotion, KeyframeMotion or CurveMotion, got {motion!r}")
    write_attribute(group, "kind", "keyframes")
    write_attribute(group, "interpolation", motion.interpolation)
    write_array(group, "times", motion.times, unit="s")
    write_array(group, "translations", motion.translations, unit="m")
    write_array(group, "rotations", motion.rotations)


@blames_group
def read_motion(group):
    """The motion of a group."""
    kind = read_attribute(group, "kind", str)
    if kind == "linear":
        return _core.LinearMotion(velocity=read_array(group, "velocity", np.float64, (3,)),
                                  angular_velocity=read_array(group, "angular_velocity", np.float64, (3,)))
    if kind == "keyframes":
        return _core.KeyframeMotion(times=read_array(group, "times", np.float64, (None,)),
                                    translations=_filled(group, "translations", (None, 3)),
                                    rotations=_filled(group, "rotations", (None, 4)),
                                    interpolation=read_attribute(group, "interpolation", str))
    if kind == "curves":
        return read_curve_motion(group)
    raise _core.FileError(f"{group.name}: unknown kind of motion '{kind}'")


def _filled(group, name: str, shape: tuple):
    values = read_array(group, name, np.float64, shape)
    return values if len(values) else None
