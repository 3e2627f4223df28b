"""What hidden objects would send around a corner: diffraction into shadows, which no trace follows."""
from __future__ import annotations

import dataclasses
from typing import NamedTuple

import numpy as np

from .. import _core
from ..arguments.checks import Progress, checked, count, real
from ..base.classes.equality import has_same_fields
from ..base.classes.made_by import made_by
from ..base.radar.antennas import field_toward, polarization_of
from ..base.radar.chirps import start_with_middle
from ..base.text.mesh_names import object_of
from ..paths.absent import NO_MESH
from ..paths.resolution import Interval, interval_of
from ..paths.surface_points import SurfacePoints, surface_points
from ..scene.lifetimes import scene_in_frame
from ..scene.scene import Scene
from .traces import trace

NUM_POINTS = 256  # of an object's surface that are looked at


@made_by("ep.around_corners")
@dataclasses.dataclass(frozen=True, eq=False)
class AroundCorner:
    """What an object would send around the edges between it and the radar; made by `around_corners`.

    name: of the object; hidden_share: of the area that faces the radar, 0 to 1, which something else hides from an end of it
    corner: name of the mesh whose edge leads to the point that the strongest wave comes to, "" where no edge does
    point: [3], m, world: on that edge, on the way out where both ways have one; length: m, half of the way out and back. Both
        are zero where no edge leads there
    loss_db: dB, of the echo around edges beside that of the hidden surface were nothing in the way; inf: no edge leads there
    power: W at the first antennas, of that echo; low, high: W, ends of the 95 % interval that the rays leave to it
    """

    name: str
    hidden_share: float
    corner: str
    point: np.ndarray
    length: float
    loss_db: float
    power: float
    low: float
    high: float

    @property
    def resolved(self) -> bool:
        """The rays know the object's level to 0.3 dB; else `power` may be anything from `low` to `high`, and more rays help."""
        return self.high == 0.0 or Interval(self.power, self.low, self.high).resolved

    def __eq__(self, other) -> bool:
        return has_same_fields(self, other) if isinstance(other, AroundCorner) else NotImplemented

    __hash__ = None


@checked(time=real(unit="s"), num_rays=count(1, 2**24))
def around_corners(scene: _core.Scene, radar: _core.Radar, *, time: float = 0.0, num_rays: int = 5000,
                   progress: Progress = None) -> list[AroundCorner]:
    """What objects that something hides would send around one edge there and one back, the strongest first.

    `trace` follows no wave into a shadow. This says what it neglects: the level of each object alone, its sharp edges with it,
    times the power that the uniform theory of diffraction brings around edges, as those on both sides of a board, to each of
    its hidden points, from the first transmitter and back to the first receiver, with their gains toward the strongest edge.
    The points are 256, spread over the object's area; what is hidden on less of it may be missed. Edges are those of all
    bodies that keep their shape, as of perfect conductors; the part of the shadow is that of any body. Waves around two
    edges, one behind the other, those along a face from its own edge, also to what is flush with it, and what the objects'
    own shadows let pass, are left out; levels are good to some 3 dB where an object is much smaller than its distance from
    the corner, and `resolved`.
    scene, radar: of the frame, without what is absent from it (`SceneNode.lifetime`); time: s, of its middle
    num_rays: for the level of each object alone
    progress: callable (stage, fraction), True for bars, or None
    Returns a list of AroundCorner, of objects with hidden points. Raises ValueError for motions that do not cover the time.
    """
    scene = scene_in_frame(scene, radar, start_with_middle(radar, time))
    found = [_told(scene, radar, hidden, time, num_rays, progress)
             for hidden in hidden_objects(scene, radar, time, progress)]
    return sorted(found, key=lambda one: -one.power)


@dataclasses.dataclass(frozen=True)
class Hidden:
    """Points [N] of an object that face the radar, and what comes to them around edges.

    ways: of the first transmitter and the first receiver; is_hidden: [N], from either
    straight: [N], power gain of both toward the points themselves
    """

    name: str
    alone: _core.Scene
    points: SurfacePoints
    ways: tuple[dict, dict]
    is_hidden: np.ndarray
    straight: np.ndarray

    @property
    def shares(self) -> np.ndarray:
        """[N], of the field there and back; 0 where nothing hides the point."""
        return np.where(self.is_hidden, self.ways[0]["share"] * self.ways[1]["share"], 0.0)

    @property
    def factors(self) -> np.ndarray:
        """[N], of the power that isotropic antennas in sight would send and receive."""
        return self.shares ** 2 * np.abs(self.ways[0]["pattern"] * self.ways[1]["pattern"]) ** 2


def hidden_objects(scene, radar, time, progress=None) -> list[Hidden]:
    """Objects of which something else hides a part from the first antennas at a time in s."""
    meshes: dict[str, list] = {}
    for mesh in scene.meshes:
        meshes.setdefault(object_of(mesh.name), []).append(mesh)
    meshes = {name: own for name, own in meshes.items() if scene[name].visible}
    if not meshes:
        return []
    empty = _empty(scene, meshes)
    facing = [_facing(scene, radar, name, own, _alone(empty, name), time) for name, own in meshes.items()]
    places = np.concatenate([one.points.at(scene, time) for one in facing])  # together: each search finds the scene's edges anew
    ways = [ways_to(scene, radar, end, places, time, progress=progress) for end in _first_antennas(radar)]
    straight = np.prod([np.abs(field_toward(radar, end, places, time)) ** 2 for end in _first_antennas(radar)], axis=0)
    stops = np.cumsum([len(one.points) for one in facing])
    spans = [slice(stop - len(one.points), stop) for one, stop in zip(facing, stops)]
    found = [_hidden(one, [{key: values[span] for key, values in way.items()} for way in ways], straight[span])
             for one, span in zip(facing, spans)]
    return [one for one in found if one.is_hidden.any()]


class _Facing(NamedTuple):
    """An object, the scene without the others, and the points of it that face the radar."""

    name: str
    alone: _core.Scene
    points: SurfacePoints


def _facing(scene, radar, name, meshes, alone, time) -> _Facing:
    points = surface_points(scene, meshes, time, NUM_POINTS)
    ways = [ways_to(alone, radar, end, points.at(scene, time), time, edges=False) for end in _first_antennas(radar)]
    return _Facing(name, alone, points[np.all([_is_free(way) for way in ways], axis=0)])


def _hidden(facing: _Facing, ways, straight) -> Hidden:
    return Hidden(*facing, tuple(ways), ~np.all([_is_free(way) for way in ways], axis=0), straight)


def _first_antennas(radar) -> tuple:
    return radar.transmitters[0], radar.receivers[0]


def _told(scene, radar, hidden: Hidden, time, num_rays, progress) -> AroundCorner:
    factor, share = hidden.factors, float(hidden.is_hidden.mean())
    if not factor.any():
        return AroundCorner(hidden.name, share, "", np.zeros(3), 0.0, np.inf, 0.0, 0.0, 0.0)
    best = int(np.argmax(factor))
    around = next(way for way in hidden.ways if way["mesh_id"][best] != NO_MESH)
    level, mean = level_of(hidden.alone, radar, time, num_rays, progress), float(factor.mean())
    return AroundCorner(hidden.name, share, scene.meshes[int(around["mesh_id"][best])].name, around["point"][best],
                        0.5 * float(sum(way["length"][best] for way in hidden.ways)),
                        _decibels(hidden.straight[hidden.is_hidden].sum() / factor.sum()), *(mean * end for end in level))


def _decibels(ratio) -> float:
    return 10.0 * float(np.log10(ratio)) if ratio > 0.0 else -np.inf


def _empty(scene, names):
    """The scene without the objects."""
    empty = Scene(scene)  # those of records cannot be changed
    for name in names:
        empty[name].visible = False
    return empty


def _alone(empty, name):
    """The scene of one object, from that without any."""
    alone = Scene(empty)
    alone[name].visible = True
    return alone


def _is_free(ways) -> np.ndarray:
    """Which points [N] an antenna sees."""
    return (ways["mesh_id"] == NO_MESH) & (ways["share"] == 1.0)


def ways_to(scene, radar, antenna, points, time, *, edges=True, progress=None) -> dict:
    """The ways from an antenna at a time in s to points [N, 3] in m (_core.legs_around_edges).

    With them "pattern" [N], complex: the root of the antenna's gain, with its phase, toward where each way begins.
    """
    world_from_radar = radar.world_from_radar(time)
    rotation, place = world_from_radar[:3, :3], world_from_radar[:3, 3]
    ways = _core.legs_around_edges(scene, time=time, frequency=radar.waveform.start_frequency,
                                   antenna=rotation @ antenna.position + place,
                                   polarization=rotation @ polarization_of(antenna), points=points, edges=edges,
                                   progress=progress)
    ahead = np.where((ways["mesh_id"] == NO_MESH)[:, None], points, ways["point"])
    return ways | {"pattern": field_toward(radar, antenna, ahead, time)}


def level_of(alone, radar, time, num_rays, progress=None) -> Interval:
    """W that a scene and its sharp edges would send straight back from and to isotropic antennas."""
    radar = radar.replace(**{ends: [one.replace(pattern=None) for one in getattr(radar, ends)]
                             for ends in ("transmitters", "receivers")})
    begin = start_with_middle(radar, time)  # rays see the scene at the middle of a frame
    paths = trace(alone, radar, num_rays=num_rays, max_bounces=1, start_time=begin, edges=True, faint_power=0.0,
                  progress=progress)
    return interval_of(_core.received_power(paths, progress=progress))
