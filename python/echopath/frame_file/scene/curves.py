"""Curves, and what they move, in HDF5 groups (layout: data/README.md)."""
from __future__ import annotations

import numpy as np

from ... import _core
from ..h5 import read_array, read_attribute, read_group, write_array, write_attribute

CURVES = ("translation", "rotation", "scale")


def write_curve_motion(group, motion) -> None:
    """Writes the curves that a CurveMotion has."""
    write_playback(group, motion)
    for name in CURVES:
        if getattr(motion, name) is not None:
            _write_curve(group.create_group(name), getattr(motion, name))


def read_curve_motion(group):
    """The CurveMotion of a group."""
    curves = {name: _read_curve(read_group(group, name)) for name in CURVES if name in group}
    return _core.CurveMotion(**curves, **read_playback(group))


def write_morph_targets(group, morph) -> None:
    """Writes MorphTargets."""
    write_playback(group, morph)
    write_array(group, "vertices", morph.vertices, unit="m", compress=True)
    write_array(group, "targets", morph.targets, unit="m", compress=True)
    _write_curve(group.create_group("weights"), morph.weights)


def read_morph_targets(group):
    """The MorphTargets of a group."""
    vertices = read_array(group, "vertices", np.float64, (None, 3))
    targets = read_array(group, "targets", np.float64, (None, len(vertices), 3))
    return _core.MorphTargets(vertices, targets, _read_curve(read_group(group, "weights")), **read_playback(group))


def write_playback(group, moving) -> None:
    """Writes the period of a loop, if there is one, and the time of what is played at time 0."""
    write_attribute(group, "offset", moving.offset)
    if moving.period is not None:
        write_attribute(group, "period", moving.period)


def read_playback(group) -> dict:
    """The arguments `period` and `offset` of what is played."""
    period = read_attribute(group, "period", float) if "period" in group.attrs else None
    return {"period": period, "offset": read_attribute(group, "offset", float)}


def _write_curve(group, curve) -> None:
    write_attribute(group, "interpolation", curve.interpolation)
    write_array(group, "times", curve.times, unit="s")
    write_array(group, "values", curve.values)
    if curve.in_tangents is not None:
        write_array(group, "in_tangents", curve.in_tangents)
        if curve.out_tangents.tobytes() == curve.in_tangents.tobytes():  # a smooth curve, as most are: one array of two names
            group["out_tangents"] = group["in_tangents"]
        else:
            write_array(group, "out_tangents", curve.out_tangents)


def _read_curve(group):
    times = read_array(group, "times", np.float64, (None,))
    values = read_array(group, "values", np.float64, (len(times), None))
    tangents = {name: read_array(group, name, np.float64, values.shape) for name in ("in_tangents", "out_tangents")
                if name in group}
    return _core.Curve(times, values, read_attribute(group, "interpolation", str), **tangents)
