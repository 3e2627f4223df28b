"""What hidden objects would send around a corner: diffraction into shadows, which no trace follows."""
from __future__ import annotations

import copy
import dataclasses

import numpy as np

from .. import _core
from ..arguments.checks import checked, count, real
from ..base.made_by import made_by

NO_MESH = 2**32 - 1
MOST_POINTS = 256  # of an object that are looked at


@made_by("ep.around_corners")
@dataclasses.dataclass(frozen=True)
class AroundCorner:
    """What an object would send around the strongest edge between it and the radar; made by `around_corners`.

    name: of the object; hidden_share: of its vertices that face the radar, 0 to 1, which something else hides from an end of it
    corner: name of the mesh whose edge leads to the vertex that the strongest wave comes to, "" where no edge does
    point: [3], m, world: on that edge; length: m, half of the way out and back about it
    loss_db: dB, of the echo around edges beside that of the hidden vertices were nothing in the way; inf: no edge leads there
    power: W at the first antennas, of that echo
    """

    name: str
    hidden_share: float
    corner: str
    point: np.ndarray
    length: float
    loss_db: float
    power: float


@checked(time=real(unit="s"), num_rays=count(1, 2**24))
def around_corners(scene: _core.Scene, radar: _core.Radar, *, time: float = 0.0, num_rays: int = 5000) -> list[AroundCorner]:
    """What objects that something hides would send around one edge there and one back, the strongest first.

    `trace` follows no wave into a shadow. This says what it neglects: the level of each object alone, times the power that the
    uniform theory of diffraction brings around the best edge to each of its hidden vertices, from the first transmitter and
    back to the first receiver. Edges are those of all bodies that keep their shape, as of perfect conductors; the part of the
    shadow is that of any body. Waves around two edges, and what the objects' own shadows let pass, are left out; levels are
    good to some 3 dB where an object is much smaller than its distance from the corner.
    scene, radar: of the frame; time: s; num_rays: for the level of each object alone
    Returns a list of AroundCorner, of objects with hidden vertices. Raises ValueError for motions that do not cover the time.
    """
    found = [_told(scene, radar, hidden, time, num_rays) for hidden in hidden_objects(scene, radar, time)]
    return sorted(found, key=lambda one: -one.power)


@dataclasses.dataclass(frozen=True)
class Hidden:
    """Vertices [N, 3] of an object that face the radar, and what comes to them around edges.

    ways: of the first transmitter and the first receiver; is_hidden: [N], from either; chosen: [N], among those of points_of
    """

    name: str
    alone: _core.Scene
    points: np.ndarray
    chosen: np.ndarray
    ways: tuple[dict, dict]
    is_hidden: np.ndarray

    @property
    def shares(self) -> np.ndarray:
        """[N], of the field there and back; 0 where nothing hides the point."""
        return np.where(self.is_hidden, self.ways[0]["share"] * self.ways[1]["share"], 0.0)


def hidden_objects(scene, radar, time) -> list[Hidden]:
    """Objects of which something else hides a part from the first antennas at a time in s."""
    names = list(dict.fromkeys(mesh.name.split("/")[0] for mesh in scene.meshes))
    found = (_hidden(scene, radar, name, names, time) for name in names)
    return [one for one in found if one.is_hidden.any()]


def _hidden(scene, radar, name, names, time) -> Hidden:
    alone, points = _alone(scene, name, names), points_of(scene, name, time)
    ends = (radar.transmitters[0], radar.receivers[0])
    facing = np.all([_is_free(ways_to(alone, radar, end, points, time)) for end in ends], axis=0)  # seen were it alone
    ways = tuple(ways_to(scene, radar, end, points[facing], time) for end in ends)
    return Hidden(name, alone, points[facing], np.flatnonzero(facing), ways, ~np.all([_is_free(way) for way in ways], axis=0))


def _told(scene, radar, hidden: Hidden, time, num_rays) -> AroundCorner:
    factor = hidden.shares ** 2
    best, mean = int(np.argmax(factor)), float(factor[hidden.is_hidden].mean())
    around = [int(way["mesh_id"][best]) for way in hidden.ways if way["mesh_id"][best] != NO_MESH]
    return AroundCorner(hidden.name, float(hidden.is_hidden.mean()), scene.meshes[around[0]].name if mean > 0.0 else "",
                        hidden.ways[0]["point"][best], 0.5 * float(sum(way["length"][best] for way in hidden.ways)),
                        -10.0 * float(np.log10(mean)) if mean > 0.0 else np.inf,
                        level_of(hidden.alone, radar, time, num_rays) * float(factor.mean()) if mean > 0.0 else 0.0)


def _alone(scene, name, names):
    """The scene without the other objects."""
    alone = copy.deepcopy(scene)
    for other in names:
        if other != name:
            alone[other].visible = False
    return alone


def _is_free(ways) -> np.ndarray:
    """Which points [N] an antenna sees."""
    return (ways["mesh_id"] == NO_MESH) & (ways["share"] == 1.0)


def points_of(scene, name, time) -> np.ndarray:
    """Vertices [N, 3] of an object, at most MOST_POINTS, which stand for its surface."""
    vertices = np.concatenate([scene.world_vertices(mesh.id, time) for mesh in scene.meshes if mesh.name.split("/")[0] == name])
    return vertices[np.unique(np.linspace(0, len(vertices) - 1, min(len(vertices), MOST_POINTS)).astype(int))]


def ways_to(scene, radar, antenna, points, time) -> dict:
    """The ways from an antenna at a time in s to points [N, 3] in m (_core.ways_around_edges)."""
    world_from_radar = radar.world_from_radar(time)
    rotation, place = world_from_radar[:3, :3], world_from_radar[:3, 3]
    scalar, vector = antenna.orientation[0], antenna.orientation[1:]
    across = np.cross(vector, antenna.polarization)
    along = antenna.polarization + 2.0 * (scalar * across + np.cross(vector, across))  # in the radar's axes
    return _core.ways_around_edges(scene, time=time, frequency=radar.waveform.start_frequency,
                                   antenna=rotation @ antenna.position + place, polarization=rotation @ along, points=points)


def level_of(alone, radar, time, num_rays) -> float:
    """W that a scene sends straight back."""
    from ..tracing.traces import trace

    begin = time - 0.5 * radar.frame_duration  # rays see the scene at the middle of a frame
    return _core.received_power(trace(alone, radar, num_rays=num_rays, max_bounces=1, start_time=begin)).power
