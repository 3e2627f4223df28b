"""Persons who run, stand, or are children."""
from __future__ import annotations

from ... import _core
from ...arguments.checks import checked, optional, positive, real
from ...arguments.number_rules import start_time_rule
from ...trajectories.trajectory import Trajectory
from ..actor import Actor
from ..following import refuse_beside_trajectory, trajectory_rule
from ..laid_line import usual_speed
from .anthropometry import ChildProportions, Proportions
from .pedestrian import HEIGHTS, MIN_KEYFRAME_RATE, body_arrays, edge_of, material_rule, on_foot, walking
from .posture import standing
from .running import RunningGait, running_speeds

CHILD_HEIGHTS = (0.8, 1.5)   # m, of children of about 1 to 12 years


@checked(height=real(*HEIGHTS, unit="m"), speed=positive("m/s"), start_time=start_time_rule, duration=positive("s"),
         phase=real(unit="cycles"), edge=positive("m"), keyframe_rate=real(MIN_KEYFRAME_RATE, unit="1/s"),
         clothing=material_rule, skin=material_rule, trajectory=trajectory_rule)
def runner(*, height: float = 1.78, speed: float = 3.0, start_time: float = -0.5, duration: float = 2.5, phase: float = 0.0,
           edge: float = 0.018, keyframe_rate: float = 240.0, clothing: str | _core.Material = "clothing",
           skin: str | _core.Material = "skin", trajectory: Trajectory | None = None) -> Actor:
    """A person who runs along +x: as `pedestrian`, whose parts and arguments it shares, with a flight between the steps.

    Step frequency, share of stance and joint angles at characteristic instants follow what is published of adults
    (running.py); between them the trajectories are sines. A foot that touches the floor z = 0 does not slide.

    speed: in m/s, 1.8 to 5 for an adult of 1.78 m, others by the root of their height. phase: of the cycle of two steps at
    time 0, in cycles; 0 is the strike of the right foot. height, start_time, duration, edge, clothing, skin: as of
    `pedestrian`. keyframe_rate: in 1/s, at least 60. trajectory: as of `pedestrian`; at its stops one foot is down.
    Returns an Actor. Raises ValueError for values out of range, TypeError for unknown keywords.
    """
    refuse_beside_trajectory(trajectory, speed=(speed, 3.0), start_time=(start_time, -0.5), duration=(duration, 2.5),
                             phase=(phase, 0.0))
    return running(Proportions(height), speed=speed, start_time=start_time, duration=duration, phase=phase, edge=edge,
                   keyframe_rate=keyframe_rate, clothing=clothing, skin=skin, trajectory=trajectory)


def running(body, **settings):
    """The Actor of a body that runs. Settings as of runner()."""
    return on_foot(body, RunningGait, running_speeds(body), **settings)


@checked(height=real(*HEIGHTS, unit="m"), edge=positive("m"), clothing=material_rule, skin=material_rule)
def standing_person(*, height: float = 1.78, edge: float = 0.018, clothing: str | _core.Material = "clothing",
                    skin: str | _core.Material = "skin") -> Actor:
    """A person who stands still at the origin and looks along +x, arms hanging; the parts are those of `pedestrian`.

    height: of the body in m, 0.5 to 2.5. edge: in m, clothing, skin: as of `pedestrian`.
    Returns an Actor. Raises ValueError for values out of range, TypeError for unknown keywords.
    """
    return standing_body(Proportions(height), edge=edge, clothing=clothing, skin=skin)


def standing_body(body, *, edge, clothing, skin):
    """The Actor of a body that stands. Arguments as of standing_person()."""
    arrays = body_arrays(body, standing(body), None, edge=edge_of(body, edge), clothing=clothing, skin=skin)
    return Actor([part.build() for part in arrays])


@checked(height=real(*CHILD_HEIGHTS, unit="m"), speed=optional(real(0.0, unit="m/s")), start_time=start_time_rule,
         duration=positive("s"), phase=real(unit="cycles"), edge=positive("m"), trajectory=trajectory_rule)
def child(*, height: float = 1.15, speed: float | None = None, start_time: float = -0.5, duration: float = 2.5,
          phase: float = 0.0, edge: float = 0.014, trajectory: Trajectory | None = None) -> Actor:
    """A child who walks, runs or stands: `pedestrian`, `runner` or `standing_person` of a child's height.

    The head is as large as those of children of that height (Snyder and others 1977); below it the proportions are those of an
    adult (anthropometry.py).
    height: in m, 0.8 to 1.5 (about 1 to 12 years). speed: m/s along +x: 0 stands, below twice the hip height a second it
    walks, above it runs; unless given it walks at 1.4 m/s times the root of its height over an adult's. start_time, duration,
    phase, edge: as of `pedestrian`. trajectory: as of `pedestrian`, by the speed that is usual on it.
    Returns an Actor. Raises ValueError for values out of range, TypeError for unknown keywords.
    """
    body = ChildProportions(height)
    refuse_beside_trajectory(trajectory, speed=(speed, None), start_time=(start_time, -0.5), duration=(duration, 2.5),
                             phase=(phase, 0.0))
    looks = {"edge": edge, "clothing": "clothing", "skin": "skin"}
    if speed == 0.0:
        return standing_body(body, **looks)
    if trajectory is not None:
        speed = usual_speed(trajectory._track)
    elif speed is None:
        speed = 1.4 * (height / 1.78) ** 0.5
    walks = speed < max(2.0 * body.hip_height, running_speeds(body)[0])
    return (walking if walks else running)(body, speed=speed, start_time=start_time, duration=duration, phase=phase,
                                           keyframe_rate=120.0 if walks else 240.0, trajectory=trajectory, **looks)
