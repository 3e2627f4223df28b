"""Signals in which nothing is heard."""
from __future__ import annotations

import numpy as np

from ..base.numerics.rotations import matrices
from ..base.process.callers import warn_user
from ..base.text.counts import counted


def warn_of_silence(paths, radar, cube: np.ndarray, told: set[str] | None = None) -> None:
    """Warns where paths were found and nothing is heard, of all reasons that hold.

    paths: _core.Paths; radar: that hears them; cube: sqrt(W), their signal
    told: reasons that were told already, of which alone nothing is said again; new ones are added
    """
    told = set() if told is None else told
    if not paths.num_paths or cube.any():
        return
    reasons = _reasons(paths, radar)
    if told.issuperset(reasons):
        return
    told.update(reasons)
    warn_user(f"no signal of {counted(paths.num_paths, 'path')}: {'; '.join(who + why for why, who in reasons.items())}")


def _reasons(paths, radar) -> dict[str, str]:
    """{reason: the paths that it holds for, as the words before it}"""
    time = paths.frame.trace_time
    last = radar.waveform.max_range
    ends = (_first_place(antennas, radar, paths.radar, time) for antennas in (radar.transmitters, radar.receivers))
    beyond = paths.lengths([time], *ends)[0] > 2.0 * last
    unseen = ~_antennas_see(paths, radar, time)
    said = [(beyond, f"beyond the last range of the waveform, {last:.4g} m"),
            (unseen & ~beyond, "where the antennas have no gain: they look elsewhere")]
    reasons = {where: f"{_how_many(lie)} " for lie, where in said if lie.any()}
    if not (beyond | unseen).all():
        reasons["rays too few for the coherent echo of a surface found none of it: ep.unresolved(paths) says which "
                "objects need more, ep.received_power(paths) how much there may be"] = ""
    return reasons


def _first_place(antennas, radar, traced, time: float) -> np.ndarray:
    """Where the first of a radar's antennas stands in the frame of the radar that traced, [3] in m."""
    in_world = radar.world_from_radar(time) @ [*antennas[0].position, 1.0]
    return np.linalg.solve(traced.world_from_radar(time), in_world)[:3]


def _how_many(lie: np.ndarray) -> str:
    """The subject and the verb of a sentence on some of the paths, bool [P]."""
    if lie.all():
        return "they lie" if len(lie) > 1 else "it lies"
    return f"{lie.sum():,} lie" if lie.sum() > 1 else "1 lies"


def _antennas_see(paths, radar, time: float) -> np.ndarray:
    """Whether any transmitter has gain toward the first hit of each path, and any receiver toward its last, bool [P]."""
    points = paths.points(time)
    ends = points[paths.offsets], points[paths.offsets + paths.num_bounces - 1]
    world = radar.world_from_radar(time)
    sent, heard = (_has_gain(antennas, (end - world[:3, 3]) @ world[:3, :3])
                   for antennas, end in zip((radar.transmitters, radar.receivers), ends))
    return sent & heard


def _has_gain(antennas, points) -> np.ndarray:
    """Whether any of the antennas has gain toward points [N, 3] in the radar's frame, bool [N]; one at an antenna has."""
    seen = np.zeros(len(points), bool)
    for antenna in antennas:
        ways = points - antenna.position
        lengths = np.linalg.norm(ways, axis=1)
        is_away = lengths > 0.0
        directions = ways[is_away] / lengths[is_away, None] @ matrices(antenna.orientation)
        seen[is_away] |= antenna.pattern.field(directions) != 0.0
        seen |= ~is_away
    return seen
