"""Where the objects of frames are, how they move, and how much of them the radar sees."""
from __future__ import annotations

import dataclasses
from collections.abc import Iterable

import numpy as np

from .. import _core
from ..arguments.checks import checked, refused
from ..arguments.iterables import iterable
from ..arguments.objects import Objects, named_globs, objects_rule
from ..base.antennas import centre_of
from ..base.rates import radar_rate
from ..frame.frame import Frame
from ..frame.maps import FrameMaps
from ..paths.families import families
from ..paths.visibility import visibility_in_trace
from .boxes import boxes_at
from .cross_section import isotropic_power
from .record import Truth

_SLOWEST = 1e-4  # m/s, below which there is no heading
_RULE = "a Frame, Paths, or some of either"
Described = Frame | FrameMaps | _core.Paths


def _frames_rule(argument: str, value):
    """What can be iterated for Frames or Paths; a single one becomes a list of it."""
    if isinstance(value, Described):
        return [value]
    return iterable(argument, value, _RULE)


@checked(frame=_frames_rule, objects=objects_rule)
def truth(frame: Described | Iterable[Frame] | Iterable[FrameMaps] | Iterable[Frame | FrameMaps],
          objects: Objects = None) -> Truth:
    """Where each object is in the middle of a frame, how it moves, its box, how much of it the radar sees, and how strongly.

    The box is the smallest about all vertices of the object at that time along the object's own axes; velocities are
    differences of fourth order over 0.1 ms either side of it (less in shorter frames) of the node's motion, and of bodies that
    deform of the surface's centroid. The radar cross section is that which the radar equation needs for the power that the
    rays brought by direct echoes.
    frame: a Frame or its Paths, or frames one after the other, used one at a time; FrameMaps of small files have a truth where
        the run was asked for one (`truth=` of `simulate` and `Sequence`)
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
    kept = None if isinstance(frame, _core.Paths) else frame.kept_truth
    if kept is not None and objects is None:
        return dataclasses.replace(kept, frame=np.full(len(kept), number, np.int32))
    if isinstance(frame, FrameMaps):
        rule = "of a run with truth=True" if kept is None else "a Frame for objects of a call, which need its paths"
        raise refused(ValueError, "frame", rule, frame)
    return truth_of_frame(frame, objects, number)


def truth_of_frame(frame, objects=None, number: int = 0) -> Truth:
    """The Truth of one Frame or of its Paths. objects: as in `families`; number: index of the frame"""
    paths = getattr(frame, "paths", frame)
    radar = getattr(frame, "radar", paths.radar)
    found, time = families(paths, objects), paths.frame.trace_time
    globs = dict(named_globs(objects) or [(name, [name]) for name in found.objects])
    boxes = boxes_at(paths.scene, [globs[name] for name in found.objects], time, radar.frame_duration)
    count = len(found.objects)
    seen = {one.name: one.visible_share for one in visibility_in_trace(paths, radar, objects)} if count else {}
    return Truth(frame=np.full(count, number, np.int32), time=np.full(count, time), name=np.array(found.objects, dtype=str),
                 position=boxes.centre, velocity=boxes.velocity, heading=_heading(boxes.velocity), size=boxes.size,
                 rotation=boxes.rotation, yaw=_yaw(boxes.rotation), angular_velocity=boxes.angular_velocity,
                 origin=boxes.origin, **_in_radar(boxes, radar, time),
                 visible_share=np.array([seen[name] for name in found.objects], float),
                 **_cross_sections(paths, radar, found, boxes.centre, time))


def _in_radar(boxes, radar, time: float) -> dict:
    """The fields of Truth in the axes of the radar."""
    world, rate = radar.world_from_radar(time), radar_rate(radar, time)
    way = boxes.centre - world[:3, 3]
    position = way @ world[:3, :3]
    velocity = (boxes.velocity - rate[:3, 3]) @ world[:3, :3] + way @ rate[:3, :3]
    sight = position - centre_of(radar)
    distance = np.linalg.norm(sight, axis=1)
    rotation = np.einsum("ji,njk->nik", world[:3, :3], boxes.rotation)
    return {"position_in_radar": position, "velocity_in_radar": velocity, "yaw_in_radar": _yaw(rotation),
            "rotation_in_radar": rotation, "direction_in_radar": _direction(boxes.velocity) @ world[:3, :3], "range": distance,
            "azimuth": np.arctan2(sight[:, 1], sight[:, 0]),
            "elevation": np.arctan2(sight[:, 2], np.hypot(sight[:, 0], sight[:, 1])),
            "radial_velocity": np.sum(sight * velocity, axis=1) / np.maximum(distance, np.finfo(float).tiny)}


def _cross_sections(paths, radar, found, centres, time: float) -> dict:
    """Received power of the direct echoes and the cross section that it means."""
    count = len(found.objects)
    index = {name: number for number, name in enumerate(found.objects)}
    group = np.array([count if family.ghost_type else index.get(family.object, count) for family in found], np.uint32)
    powers = _core.received_powers(paths, group[found.family_of_path], count + 1)[:count]
    unit = isotropic_power(radar, centres, time)
    unit = np.where(unit > 0.0, unit, np.nan)
    received, low, high = (np.array([getattr(one, name) for one in powers], float) for name in ("power", "low", "high"))
    return {"received": received, "rcs": received / unit, "rcs_low": low / unit, "rcs_high": high / unit}


def _heading(velocity):
    is_moving = np.hypot(velocity[:, 0], velocity[:, 1]) >= _SLOWEST
    return np.where(is_moving, np.arctan2(velocity[:, 1], velocity[:, 0]), np.nan)


def _direction(velocity):
    speed = np.linalg.norm(velocity, axis=1, keepdims=True)
    return np.where(speed >= _SLOWEST, velocity / np.maximum(speed, _SLOWEST), np.nan)


def _yaw(rotation):
    return np.arctan2(rotation[:, 1, 0], rotation[:, 0, 0])


def joined(rows: list) -> Truth:
    """The rows of several Truths, one after the other."""
    if len(rows) == 1:
        return rows[0]
    return Truth(**{field: np.concatenate([getattr(one, field) for one in rows]) for field in Truth.__dataclass_fields__})
