"""Where the objects of frames are, how they move, and how much of them the radar sees."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..arguments.objects import named_globs
from ..base.numerics.rates import radar_rate
from ..base.radar.antennas import centre_of
from ..paths.resolution import FamilyPowers, family_powers
from ..paths.visibility import visibility_in_trace
from .boxes import boxes_at
from .cross_section import isotropic_power
from .record import Truth

_SLOWEST = 1e-4  # m/s, below which there is no heading


def truth_of_frame(frame, objects=None, number: int = 0) -> Truth:
    """The Truth of one Frame or of its Paths. objects: as in `families`; number: index of the frame"""
    paths = getattr(frame, "paths", frame)
    radar = getattr(frame, "radar", paths.radar)
    powers = family_powers(paths, objects) if isinstance(frame, _core.Paths) else frame._powers_of(objects)
    found, time = powers.families, paths.frame.trace_time
    globs = dict(named_globs(objects) or [(name, [name]) for name in found.objects])
    boxes = boxes_at(paths.scene, [globs[name] for name in found.objects], time, radar.frame_duration)
    count = len(found.objects)
    seen = {one.name: one.visible_share for one in visibility_in_trace(paths, radar, objects)} if count else {}
    return Truth(frame=np.full(count, number, np.int32), time=np.full(count, time), name=np.array(found.objects, dtype=str),
                 position=boxes.centre, velocity=boxes.velocity, heading=_heading(boxes.velocity), size=boxes.size,
                 rotation=boxes.rotation, yaw=_yaw(boxes.rotation), angular_velocity=boxes.angular_velocity,
                 origin=boxes.origin, **_in_radar(boxes, radar, time),
                 visible_share=np.array([seen[name] for name in found.objects], float),
                 **_cross_sections(powers, radar, boxes.centre, time))


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


def _cross_sections(found: FamilyPowers, radar, centres, time: float) -> dict:
    """Received power of the direct echoes and the cross section that it means."""
    direct = {family.object: power for family, power in zip(found.families, found.powers) if not family.is_ghost}
    powers = [direct.get(name) for name in found.families.objects]
    unit = isotropic_power(radar, centres, time)
    unit = np.where(unit > 0.0, unit, np.nan)
    received, low, high = (np.array([0.0 if one is None else getattr(one, name) for one in powers])
                           for name in ("power", "low", "high"))
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
