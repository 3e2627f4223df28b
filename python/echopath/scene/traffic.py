"""Traffic: objects that follow the trajectories of a file, put into a scene."""
from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from .. import _core, actors
from ..actors.laid_line import usual_speed
from ..arguments.checks import checked, optional, real, refused, text
from ..arguments.names import first_names
from ..arguments.objects import listed
from ..arguments.shown import writable
from ..base.classes.made_by import made_by
from ..base.text.counts import counted
from ..base.text.node_names import fit_name, unique
from ..readers.model import Model
from ..trajectories.arguments import optional_span
from ..trajectories.files.track_file import W, on_the_way, warn_of_nobody
from ..trajectories.kinds import of_kind, usual_kind, warn_of_unused_kinds
from ..trajectories.trajectory import Trajectory
from .scene import Scene, changed_scene

ActorOf = Callable[[str, Trajectory], Any]
ActorOfKinds = Mapping[str, ActorOf | Model | str | None]


@made_by("ep.add_traffic")
class Traffic(Mapping[str, Trajectory]):
    """The objects that `add_traffic` has put into a scene: {full name: Trajectory}. Raises KeyError for others.

    scene: that holds them; trajectories: {full name in the scene: Trajectory}
    """

    def __init__(self, scene, trajectories: dict[str, Trajectory]):
        self._scene, self._trajectories = scene, trajectories

    def __getitem__(self, name: str) -> Trajectory:
        return self._trajectories[name]

    def __iter__(self):
        return iter(self._trajectories)

    def __len__(self) -> int:
        return len(self._trajectories)

    def __repr__(self) -> str:
        return f"Traffic({counted(len(self), 'object')})"

    def present(self, begin: float, end: float | None = None) -> list[str]:
        """Names of the objects whose trajectories have begun and not ended, at a time or at some time of a span.

        begin, end: s; None: a single time. Raises TypeError or ValueError naming the argument.
        """
        begin = real(unit="s")("begin", begin)
        end = begin if end is None else real(begin, unit="s")("end", end)
        return [name for name, one in self._trajectories.items() if one.begin <= end and begin <= one.end]

    def show(self, begin: float, end: float | None = None) -> list[str]:
        """Makes the objects visible that are present, the others invisible, before a frame of that time is simulated.

        begin, end: s; None: a single time. Returns the names of those that are visible. Raises as `present` does.
        """
        present = self.present(begin, end)
        shown = set(present)
        for name in self._trajectories:
            if name in self._scene and self._scene[name].visible != (name in shown):
                self._scene[name].visible = name in shown
        return present


def _trajectories_rule(argument: str, value) -> dict[str, Trajectory]:
    rule = "a dict of trajectories by their names, as read_trajectories returns"
    if not isinstance(value, Mapping):
        raise refused(TypeError, argument, rule, value)
    for name, one in value.items():
        if not isinstance(name, str) or not isinstance(one, Trajectory):
            raise refused(TypeError, argument, rule, {name: one})
    return dict(value)


def _maker_rule(argument: str, value) -> ActorOf | None:
    if isinstance(value, Mapping):
        return _maker_of_kinds(argument, value)
    if value is not None and not _is_maker(value):
        raise refused(TypeError, argument, "a callable (name, trajectory) that returns an actor, a dict of them by globs of "
                      "kinds, or None", value)
    return value


def _is_maker(value) -> bool:
    return callable(value) and not isinstance(value, type)


class MakerOfKinds:
    """Makes actors by the kinds of trajectories.

    makers: of globs of kinds, of which the first that takes the kind counts, None: no object; kinds that none takes are as usual
    """

    def __init__(self, makers: dict[str, ActorOf | None]):
        self.makers = makers

    def __call__(self, name: str, trajectory: Trajectory):
        maker = of_kind(self.makers.items(), trajectory.kind, usual_actor)
        return None if maker is None else maker(name, trajectory)


def _maker_of_kinds(argument: str, makers: Mapping) -> MakerOfKinds:
    """The maker of a dict {glob of kinds: maker, model, name of an actor or None}."""
    found = {}
    for glob, maker in makers.items():
        place = f"{argument}['{text(argument, glob)}']"
        if isinstance(maker, str):
            maker = _maker_by_name(place, maker)
        elif isinstance(maker, Model):
            maker = _always(maker)
        elif maker is not None and not _is_maker(maker):
            raise refused(TypeError, place, "a callable (name, trajectory), a Model, the name of an actor, or None", maker)
        found[glob] = maker
    return MakerOfKinds(found)


def _always(model: Model) -> ActorOf:
    return lambda name, trajectory: model


def _maker_by_name(argument: str, actor: str) -> ActorOf:
    if actor not in following_actors():
        raise refused(ValueError, argument, f"an actor that takes a trajectory ({', '.join(following_actors())})", actor)
    return lambda name, trajectory: getattr(actors, actor)(trajectory=trajectory)


@functools.cache
def following_actors() -> list[str]:
    """Names of the actors that follow a trajectory by themselves, without further arguments."""
    signatures = {name: inspect.signature(getattr(actors, name)).parameters for name in actors.__all__
                  if inspect.isfunction(getattr(actors, name))}
    return [name for name, known in signatures.items() if "trajectory" in known
            and all(one.default is not one.empty for one in known.values())]


def _globs_rule(argument: str, value) -> list[str]:
    globs = [value] if isinstance(value, str) else listed(value)
    if not isinstance(globs, list) or not all(isinstance(glob, str) and glob for glob in globs):
        raise refused(TypeError, argument, "a glob of names or a list of globs", value)
    return globs


@checked(scene=changed_scene, trajectories=_trajectories_rule, actor_of=_maker_rule, exclude=_globs_rule,
         during=optional_span, parent=optional(text), time=optional(real(unit="s")))
def add_traffic(scene: Scene, trajectories: Mapping[str, Trajectory], *, actor_of: ActorOf | ActorOfKinds | None = None,
                exclude: str | Iterable[str] = (), during: tuple[float, float] | None = None, parent: str | None = None,
                time: float | None = None) -> Traffic:
    """Puts an object for each trajectory into a scene, under its name; what a name of the scene must not hold becomes '_'.

    Trajectories whose names become alike by that are numbered.
    trajectories: {name: Trajectory}, such as read_trajectories returns
    actor_of: (name, trajectory) -> what Scene.add takes, such as `ep.actors.car(kind="suv", trajectory=trajectory)`; what does
        not follow the trajectory by itself is moved by it as a whole; None back: no object. None: by the words of
        `trajectory.kind`: truck, bus, van, motorcycle, bicycle, pedestrian, dog, else a compact car; persons of SUMO
        are no vehicles. Or a dict {glob of kinds: such a callable, a Model, whose meshes all share, the name of an actor, or
        None: no object}, of which the first that takes the kind counts, in whatever case; kinds that none takes are as usual:
        `{"police*": ep.load_model("police.glb"), "taxi": "car", "tram*": None}`
    exclude: globs of names that are left out, such as the car that carries the radar; each must take one
    during: (begin, end) in s, outside of which nothing is of interest: who is on the way at no time of it is left out, and the
        others' wheels, trailers and limbs move in it alone (`Trajectory.detailed`), which is faster for long ways. None: all
    parent: full name of the object whose axes the trajectories are in; None: the world
    time: s; what is not there at that time is not visible; None: everything is, at any time. `Traffic.show` changes it
    Returns the Traffic. Raises TypeError or ValueError naming the argument, also where the scene has an object of such a
    name, as after the same call before; nothing is added then. Warns (RuntimeWarning) of a span in which nobody is on the way,
    and of globs that take no kind of the trajectories.
    """
    maker = actor_of if callable(actor_of) else usual_actor
    if isinstance(maker, MakerOfKinds):
        warn_of_unused_kinds("actor_of", maker.makers, (one.kind for one in trajectories.values()))
    chosen = chosen_of(trajectories, list(exclude), during)
    warn_of_nobody(trajectories, during)
    traffic = put_traffic(scene, chosen, maker, during, parent)
    if time is not None:
        traffic.show(time)
    return traffic


def put_traffic(scene: Scene, trajectories: Mapping[str, Trajectory], maker: ActorOf, during: tuple[float, float] | None,
                parent: str | None = None) -> Traffic:
    """Puts what a maker makes for each of the trajectories that are chosen into a scene. Takes, returns and raises what
    `add_traffic` does."""
    made = {name: _made(maker, name, one if during is None else one.detailed(*during)) for name, one in trajectories.items()}
    present = {name: actor for name, actor in made.items() if actor is not None}
    _require_new(scene, present, parent)
    above, added = _above(parent), {}
    own_names = object_names(present, [name.removeprefix(above) for name in scene if name.startswith(above)])
    for name, actor in present.items():
        trajectory = trajectories[name]
        follows = getattr(actor, "motion", None) is not None
        full_name = scene.add(actor, name=own_names[name], parent=parent, motion=None if follows else trajectory)
        added[full_name] = trajectory
    return Traffic(scene, added)


def chosen_of(ways: Mapping[str, W], exclude: Iterable[str], during: tuple[float, float] | None) -> dict[str, W]:
    """Those that are not left out by their names or their times. Raises ValueError of globs that take none of the names."""
    for glob in exclude:
        if not any(_core.glob_takes(glob, name) for name in ways):
            raise refused(ValueError, "exclude", f"globs of which each takes one of {first_names(list(ways)) or 'none'}", glob)
    return {name: one for name, one in on_the_way(ways, during).items()
            if not any(_core.glob_takes(glob, name) for glob in exclude)}


def _made(maker: ActorOf, name: str, trajectory: Trajectory):
    """What is made for a name; what cannot be is told with it."""
    try:
        return maker(name, trajectory)
    except ValueError as error:
        raise type(error)(f"trajectories['{writable(name)[:60]}']: {error}") from None


def _require_new(scene, names, parent: str | None) -> None:
    """Raises ValueError where the scene has objects of these names already, such as those of a call before."""
    there = [name for name in names if _above(parent) + fit_name(name, "object") in scene]
    if there:
        whose = f"'{parent}'" if parent else "the scene"
        raise refused(ValueError, "trajectories", f"of names that {whose} does not have yet (scene.remove takes out what is "
                      "there, another parent has names of its own)", first_names(there))


def usual_actor(name: str, trajectory: Trajectory):
    """The actor that is usual for the kind of a trajectory, which follows it."""
    actor, keywords, _ = usual_kind(trajectory.kind, trajectory.is_person)
    if actor == "pedestrian" and usual_speed(trajectory._track) > 2.0:
        actor = "runner"
    return getattr(actors, actor)(trajectory=trajectory, **keywords)


def object_names(names: Iterable[str], taken: Iterable[str]) -> dict[str, str]:
    """{name of a trajectory: that of its object}, numbered where names become alike, or like one that is taken."""
    counts = dict.fromkeys(taken, 1)
    return {name: unique(fit_name(name, "object"), counts) for name in names}


def _above(parent: str | None) -> str:
    """What stands before the names of the objects in the scene."""
    return f"{parent}/" if parent else ""
