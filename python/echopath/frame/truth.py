"""The truth of frames, beside what they hold."""
from __future__ import annotations

import dataclasses
from collections.abc import Iterable

import numpy as np

from .. import _core
from ..arguments.checks import checked, refused
from ..arguments.iterables import iterable
from ..arguments.objects import Objects, objects_rule
from ..truth import Truth, joined, truth_of_frame
from .frame import Frame
from .maps import FrameMaps

_RULE = "a Frame, Paths, the Truth of a frame, or some of these"
Described = Frame | FrameMaps | Truth | _core.Paths


def _frames_rule(argument: str, value):
    """What can be iterated for frames; a single one becomes a list of it."""
    if isinstance(value, Described):
        return [value]
    return iterable(argument, value, _RULE)


@checked(frame=_frames_rule, objects=objects_rule)
def truth(frame: Described | Iterable[Frame] | Iterable[FrameMaps] | Iterable[Truth] | Iterable[Frame | FrameMaps],
          objects: Objects = None) -> Truth:
    """Where each object is in the middle of a frame, how it moves, its box, how much of it the radar sees, and how strongly.

    The box is the smallest about all vertices of the object at that time along the object's own axes; velocities are
    differences of fourth order over 0.1 ms either side of it (less in shorter frames) of the node's motion, and of bodies that
    deform of the surface's centroid. The radar cross section is that which the radar equation needs for the power that the
    rays brought by direct echoes.
    frame: a Frame or its Paths, or frames one after the other, used one at a time; FrameMaps of small files have a truth where
        the run was asked for one (`truth=` of `simulate` and `Sequence`). What a loop kept of its frames, `frame.truth` of
        each, becomes one Truth of all.
    objects: as in `families`, {name: globs} or globs, which are then the names; None: those that the run was asked for, or the
        objects that labels tell of
    Returns a Truth, a row for each object of each frame, in SI units. Raises TypeError or ValueError naming the argument, also
    for globs that take no mesh.
    """
    rows = []
    for number, one in enumerate(frame):
        if not isinstance(one, Described):
            raise refused(TypeError, "frame", _RULE, one)
        rows.append(_truth_of(one, objects, number))
    if not rows:
        raise ValueError("frame: must be one at least, got none")
    return joined(rows)


def _truth_of(frame, objects, number: int) -> Truth:
    """What a frame keeps, or what follows from its paths."""
    if isinstance(frame, Truth) and len(np.unique(frame.frame)) > 1:
        raise refused(ValueError, "frame", "the Truth of one frame", frame)
    kept = frame if isinstance(frame, Truth) else None if isinstance(frame, _core.Paths) else frame.kept_truth
    if kept is not None and objects is None:
        return dataclasses.replace(kept, frame=np.full(len(kept), number, np.int32))
    if isinstance(frame, FrameMaps | Truth):
        rule = "of a run with truth=True" if kept is None else "a Frame for objects of a call, which need its paths"
        raise refused(ValueError, "frame", rule, frame)
    return truth_of_frame(frame, objects, number)
