"""All frames of a time line at a glance: power by velocity and by range, and tracks of what was detected."""
from __future__ import annotations

import dataclasses

import numpy as np

import echopath as ep
from echopath.base.numerics.decibels import SMALLEST_POWER, in_dbm
from echopath.base.numerics.rotations import quaternions
from echopath.base.radar.antennas import middle_of_antennas, velocity_of_antennas
from echopath.base.radar.velocities import velocity_span_of
from echopath.frame_file.container import our_file
from echopath.frame_file.detections import read_detections
from echopath.frame_file.h5 import read_group
from echopath.frame_file.maps import axes_in_file, has_power, power_in_file
from echopath.frame_file.radar import read_radar

AXES = ("velocity", "range")
KNOWN = 0.25  # of the axis of velocities, the most that the velocity of a track may be uncertain by to be shown


@dataclasses.dataclass(frozen=True)
class Glance:
    """What is kept of one frame: kilobytes.

    time: s, its start; velocity [V] m/s and range [R] m: axes; by_velocity [V], by_range [R]: W, f32, summed over the other;
        all empty where the file has no map
    detections: ep.Detections without their paths, None: the file has none; radar: of the frame, None: the file has none
    """

    time: float
    velocity: np.ndarray
    range: np.ndarray
    by_velocity: np.ndarray
    by_range: np.ndarray
    detections: object = None
    radar: object = None


def no_glance(moment) -> Glance:
    """Of a frame whose file has no map, or cannot be read."""
    nothing = np.zeros(0, np.float32)
    return Glance(moment.start_time, nothing, nothing, nothing, nothing)


def glance_at(moment) -> Glance:
    """Reads the map and the detections of a frame of a time line, not its paths. Raises ep.FileError."""
    with our_file(moment.path) as file:
        if "maps" not in file and "spectra" not in file:
            return no_glance(moment)
        axes = axes_in_file(file)
        shape = len(axes["velocity"]), len(axes["range"])
        power = power_in_file(file, shape) if has_power(file) else np.zeros(shape, np.float32)
        seeds = {"seed": 0, "noise_seed": None}
        found = read_detections(read_group(file, "detections"), shape, **seeds) if "detections" in file else None
        radar = read_radar(read_group(file, "radar")) if "radar" in file else getattr(moment.stored, "radar", None)
    return Glance(moment.start_time, axes["velocity"], axes["range"], power.sum(axis=1), power.sum(axis=0), found, radar)


def has_map(glance: Glance) -> bool:
    """Whether there is a column to show of it."""
    return len(glance.velocity) > 0


def level_image(glances, axis: str):
    """(dBm, f32 [X, T], a column for each frame; axis values [X]) of glances; axis: a name of AXES.

    Frames with another axis than the first that has one have NaN.
    """
    values = next((getattr(one, axis) for one in glances if has_map(one)), np.zeros(0))
    columns = [in_dbm(getattr(one, f"by_{axis}").astype(float), SMALLEST_POWER) if _is_same(getattr(one, axis), values)
               else np.full(len(values), np.nan) for one in glances]
    return np.stack(columns, axis=1).astype(np.float32), values


def _is_same(axis: np.ndarray, other: np.ndarray) -> bool:
    """Whether a cell of one axis is where that of the other is: radars of as many cells may have them elsewhere."""
    return len(axis) == len(other) and bool(np.allclose(axis, other))


def tracks_of(glances):
    """ep.Tracks of the detections of frames in time, in the world; None where there are none, or their times do not ascend."""
    times = np.array([one.time for one in glances])
    if len(glances) < 2 or any(one.detections is None or one.radar is None for one in glances) or (np.diff(times) <= 0.0).any():
        return None
    middles = np.array([one.radar.middle_of_frame(one.time) for one in glances])
    try:
        return ep.track([one.detections for one in glances], middles, **_carried_by(glances, middles))
    except ValueError:  # antennas that see no directions
        return None


def _carried_by(glances, times) -> dict:
    """Keywords of `ep.track`: the radar of all frames; where files are of radars that were moved, rather than of one that moves,
    one that is where each of them is, which does not tell how fast it goes."""
    if all(one.radar == glances[0].radar for one in glances):
        return {"radar": glances[0].radar}
    return {"radar": _radar_of_all(glances, times), "velocity_std": None}


def _radar_of_all(glances, times):
    """The radar of the first frame, which at the time of each frame is where the radar of that one is."""
    poses = np.array([one.radar.world_from_radar(float(time)) for one, time in zip(glances, times)])
    motion = ep.KeyframeMotion(times, poses[:, :3, 3], quaternions(poses[:, :3, :3]), "linear")
    return glances[0].radar.replace(position=(0.0, 0.0, 0.0), yaw=0.0, pitch=0.0, motion=motion)


def track_values(tracks, glances, axis: str):
    """[N], range in m or radial velocity in m/s from the middle of the antennas of each row of tracks; NaN where the track does
    not know its velocity, as one that has just begun and is at rest until it is told otherwise.

    glances: those that the tracks are of
    """
    radars, times = [glances[frame].radar for frame in tracks.frame], np.asarray(tracks.time)
    way = track_places(tracks, glances) - _for_each(middle_of_antennas, radars, times)
    distance = np.linalg.norm(way, axis=1)
    if axis == "range":
        return distance
    own = _for_each(velocity_of_antennas, radars, times)
    sights = way / np.maximum(distance, 1e-9)[:, None]
    level = sights[:, :2]
    spread = np.sqrt(np.einsum("ni,nij,nj->n", level, tracks.covariance[:, 2:, 2:], level))
    spans = np.array([velocity_span_of(radar) for radar in radars])
    speeds = np.sum(level * tracks.state[:, 2:], axis=1) - np.sum(sights * own, axis=1)
    return np.where(spread <= KNOWN * spans, speeds, np.nan)


def track_places(tracks, glances):
    """[N, 3] m, in the world, of each row: with the height of the detection that is nearest from above, between these where a
    track goes on without one. Tracks have no heights of their own."""
    heights = np.zeros(len(tracks))
    for row in np.flatnonzero(tracks.is_detected):
        points = _points_in_world(glances[tracks.frame[row]], float(tracks.time[row]))
        heights[row] = points[np.linalg.norm(points[:, :2] - tracks.state[row, :2], axis=1).argmin(), 2]
    for number in np.unique(tracks.track):
        own = tracks.track == number
        seen = own & tracks.is_detected
        heights[own] = np.interp(tracks.time[own], tracks.time[seen], heights[seen])
    return np.column_stack([tracks.state[:, :2], heights])


def _points_in_world(glance: Glance, time: float):
    """[D, 3] m, of the detections whose directions are known."""
    world = glance.radar.world_from_radar(time)
    points = glance.detections.points
    return points[np.isfinite(points).all(axis=1)] @ world[:3, :3].T + world[:3, 3]


def _for_each(of_radar, radars, times):
    """[N, 3], what `of_radar` gives in the world for each radar and time in s."""
    return np.array([of_radar(radar, float(time)) for radar, time in zip(radars, times)]).reshape(-1, 3)
