"""Which objects a radar can see, and what hides the others."""
from __future__ import annotations

import dataclasses
import weakref

from .. import _core
from ..arguments.checks import Progress, checked, count, optional, real
from ..arguments.frame_times import require_motion
from ..arguments.objects import Objects, named_globs, objects_rule
from ..base.classes.made_by import made_by
from ..base.numerics.golden import golden_place
from ..scene.lifetimes import scene_at

HIDDEN_SHARE = 0.05  # an object of which no more than this is in sight counts as hidden
LEAST_HIDDEN = 0.005  # share of an object from which what hides it is named
DIRECTIONS = 128  # on each object: labels and truth look at all objects of each frame
DIRECTIONS_OF_PLACES = 256  # on each object: shares to .006 rms, for the question whether they are above HIDDEN_SHARE
_KEPT: weakref.WeakKeyDictionary = weakref.WeakKeyDictionary()  # {record: geometry}, one entry at most
FRAME_PLACES = (0.0, 1.0, *map(golden_place, (1, 2, 3)))  # shares of a frame: its ends and irrational ones


def occluder_words(occluders: dict) -> str:
    """What hides an object and how much of it, "wall 40%, car 3%"; "" where nothing hides half a percent."""
    return ", ".join(f"{name} {share:.0%}" for name, share in occluders.items() if share >= LEAST_HIDDEN)


@made_by("ep.visibility")
@dataclasses.dataclass(frozen=True)
class VisibilityFromEnd:
    """An object as one end of the radar sees it, from the mean position of its antennas.

    visible_share: of the solid angle that the object would fill alone, 0 to 1; an object does not hide itself
    occluders: {name: share of that solid angle where this one is nearest}, largest first; with visible_share they add up
        to 1. Names are those of objects, and of other surfaces as in `Family.via`
    in_view: an antenna has gain toward a part of it, hidden or not; toward a vertex of it where it is seen edge-on
    distance: m, to the nearest point of its triangles
    solid_angle: sr that it would fill alone, to a few percent where one surface hides all of it; 0: seen edge-on, and then
        the shares are 0
    """

    visible_share: float
    occluders: dict[str, float]
    in_view: bool
    distance: float
    solid_angle: float

    def __repr__(self) -> str:
        return f"<VisibilityFromEnd {self._text()}>"

    def _text(self) -> str:
        hidden = "".join(f", {share:.1%} behind {name}" for name, share in self.occluders.items())
        view = "" if self.in_view else ", out of view"
        return f"{self.visible_share:.1%} visible{hidden}, {self.distance:.4g} m{view}"


@made_by("ep.visibility")
@dataclasses.dataclass(frozen=True)
class ObjectVisibility:
    """How much of an object the radar can see; made by `visibility`.

    name: of the object
    mesh_ids: tuple of the IDs of its meshes
    transmitter, receiver: visibility from each end, with distances in m
    """

    name: str
    mesh_ids: tuple[int, ...]
    transmitter: VisibilityFromEnd
    receiver: VisibilityFromEnd

    @property
    def worse(self) -> VisibilityFromEnd:
        """From the end that sees less of the object: an echo needs both."""
        return self.receiver if self.receiver.visible_share < self.transmitter.visible_share else self.transmitter

    @property
    def visible_share(self) -> float:
        """Share of its solid angle that the end sees which sees less, 0 to 1."""
        return self.worse.visible_share

    @property
    def occluders(self) -> dict[str, float]:
        """{name: share of the solid angle that it hides} from that end, largest first."""
        return self.worse.occluders

    @property
    def in_view(self) -> bool:
        """Whether both ends have an antenna with gain toward a part of it."""
        return self.transmitter.in_view and self.receiver.in_view

    @property
    def distance(self) -> float:
        """Half the way from the transmitter to its nearest point and from its nearest point to the receiver, m."""
        return 0.5 * (self.transmitter.distance + self.receiver.distance)

    def __repr__(self) -> str:
        return f"<ObjectVisibility {self.name}: {self.worse._text()}>"


@checked(objects=objects_rule, time=optional(real(unit="s")), num_directions=count(1, 2**24))
def visibility(scene: _core.Scene, radar: _core.Radar, objects: Objects = None, *, time: float | None = None,
               num_directions: int = 4096, progress: Progress = None) -> list[ObjectVisibility]:
    """How much of each object the radar can see, and what hides the rest, by shadow rays.

    Directions over the cone that holds an object: where it would be hit if it were alone, is something else nearer? Straight
    lines only: what an object sends over mirrors is a matter of its paths (`families`).
    scene: what is looked at; radar: whose antennas look, each end from their mean position
    objects: as in `families`
    time: s, of scene and radar; None: the middle of a frame that starts at 0. What has a lifetime that does not hold it
        (`SceneNode.lifetime`) is neither looked at nor hides anything, and mesh IDs count what is there
    num_directions: on each object, about; the error of a share is 4e-4 rms for half hidden plates and 4096, and falls with
        the power -0.75; where what is met does not change, one in 16 is looked at
    progress: callable (stage, fraction), True for bars, or None
    Returns a list of ObjectVisibility, in the order of the objects; the same for any number of threads. Raises ValueError
    for bad names, globs that take no mesh and motions that do not cover the time.
    """
    time = radar.middle_of_frame() if time is None else time
    require_motion("radar", radar, (time,))
    there = scene_at(scene, time)
    return _as_objects(_core.visibility(there, radar, named_globs(objects), time, num_directions, progress))


def visibility_in_trace(paths, radar, objects=None, *, num_directions=DIRECTIONS, progress=None) -> list:
    """The same at the time of a trace, of the very objects that `families(paths, objects)` has, in their order. Where the
    trace kept no geometry, that of the record looked at last stays in memory with it, some 200 bytes a triangle.

    paths: of `trace`; radar: whose antennas look, not necessarily that of the trace; progress: as in `visibility`
    num_directions: on each object, about; shares of people, cars and poles that hide each other are known to 8e-3 rms and
        3e-2 at most by 128, to 4e-3 and 2e-2 by 512, and to 7e-4 and 3e-3 by 4096
    """
    _keep_geometry(paths)
    return _as_objects(_core.visibility_in_trace(paths, radar, named_globs(objects), None, num_directions, progress))


def appearing_in_frame(paths, radar, hidden, objects=None, *, progress=None) -> set:
    """Which of the objects that are hidden at the time of a trace are not at others of its frame: both ends and places between.

    hidden: names of objects; paths, radar, objects, progress: as in `visibility_in_trace`
    """
    scene = paths.scene
    moves = radar.is_moving or any(scene.is_moving(mesh.id) for mesh in scene.meshes)
    if not (moves and hidden):
        return set()
    appearing = set()
    globs = dict(named_globs(objects) or ())
    hidden = set(_core.may_appear_in_frame(paths, radar, named_globs(objects), sorted(hidden), FRAME_PLACES, HIDDEN_SHARE))
    for share in FRAME_PLACES:
        rest = {name: globs.get(name, name) for name in sorted(hidden - appearing)}  # usual objects are their own globs
        if rest:
            time = paths.frame.start_time + share * radar.frame_duration
            seen = _as_objects(_core.visibility_in_trace(paths, radar, named_globs(rest), time, DIRECTIONS_OF_PLACES, progress))
            appearing |= {one.name for one in seen if one.visible_share > HIDDEN_SHARE}
    return appearing


def _keep_geometry(paths) -> None:
    """Keeps the geometry of the record looked at last from look to look, where its trace did not keep any."""
    if paths not in _KEPT:
        kept = _core.KeptGeometry()
        is_new = _core.remember_geometry(paths, kept)
        _KEPT.clear()
        if is_new:
            _KEPT[paths] = kept


def _as_objects(found) -> list:
    return [ObjectVisibility(name, mesh_ids, VisibilityFromEnd(*transmitter), VisibilityFromEnd(*receiver))
            for name, mesh_ids, transmitter, receiver in found]
