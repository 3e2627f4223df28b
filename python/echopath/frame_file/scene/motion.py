"""Motions in HDF5 groups (layout: data/README.md)."""
from __future__ import annotations

import numpy as np

from ... import _core
from ..h5 import blames_group, read_array, read_attribute, write_array, write_attribute
from .curves import read_curve_motion, write_curve_motion
from .kinds import Kind, read_kind, write_kind


def write_motion(group, motion) -> None:
    """Writes a linear motion, keyframes or curves."""
    write_kind(group, motion, _KINDS, "a LinearMotion, KeyframeMotion or CurveMotion")


@blames_group
def read_motion(group):
    """The motion of a group."""
    return read_kind(group, _KINDS, "motion")


def _write_linear(group, motion) -> None:
    write_array(group, "velocity", motion.velocity, unit="m/s")
    write_array(group, "angular_velocity", motion.angular_velocity, unit="rad/s")


def _read_linear(group):
    return _core.LinearMotion(velocity=read_array(group, "velocity", np.float64, (3,)),
                              angular_velocity=read_array(group, "angular_velocity", np.float64, (3,)))


def _write_keyframes(group, motion) -> None:
    write_attribute(group, "interpolation", motion.interpolation)
    write_array(group, "times", motion.times, unit="s")
    write_array(group, "translations", motion.translations, unit="m")
    write_array(group, "rotations", motion.rotations)


def _read_keyframes(group):
    return _core.KeyframeMotion(times=read_array(group, "times", np.float64, (None,)),
                                translations=_filled(group, "translations", (None, 3)),
                                rotations=_filled(group, "rotations", (None, 4)),
                                interpolation=read_attribute(group, "interpolation", str))


def _filled(group, name: str, shape: tuple):
    values = read_array(group, name, np.float64, shape)
    return values if len(values) else None


_KINDS = {"linear": Kind(_core.LinearMotion, _write_linear, _read_linear),
          "curves": Kind(_core.CurveMotion, write_curve_motion, read_curve_motion),
          "keyframes": Kind(_core.KeyframeMotion, _write_keyframes, _read_keyframes)}
