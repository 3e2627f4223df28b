"""Remarks on rays and sequences of mirrors that a trace lost."""
from __future__ import annotations

from ..base.process.callers import warn_user
from ..base.text.counts import at_least, counted

LOST_SHARE = 0.01  # of the rays


def warn_of_record(frame) -> None:
    """Warns (RuntimeWarning) of the rays, sequences of mirrors and objects that the trace of a record left out.

    frame: _core.TraceFrame of the record
    """
    warn_of_lost_rays(frame.statistics)
    warn_of_unfollowed_frusta(frame.statistics)
    warn_of_unaimed(frame.statistics, frame.strata)


def warn_of_lost_rays(statistics) -> None:
    """Warns (RuntimeWarning) where more than one ray in a hundred met a surface that the radar touches, or slivers."""
    near, lost, rays = statistics.num_near_antenna, statistics.num_false_hits, max(statistics.num_rays, 1)
    if near + lost > LOST_SHARE * rays:
        met = [(near, "met a surface within 1 mm of the radar"),
               (lost, "met one that double precision does not confirm (in the plane of an antenna, or a long sliver)")]
        told = " and ".join(f"{at_least(count)} {what}" for count, what in met if count)
        warn_user(f"of {rays:,} rays, {told}: their echoes are left out. Antennas at least 1 mm off every surface see all")


def warn_of_unfollowed_frusta(statistics) -> None:
    """Warns (RuntimeWarning) where not every sequence of mirrors was tried."""
    count = statistics.num_unfollowed_frusta
    if count:
        warn_user(f"{at_least(count)} {_sequences(count)} not followed further: echoes over more mirrors are left out. "
                  "Fewer flagged mirrors or a smaller max_bounces see all")


def warn_of_unaimed(statistics, strata=()) -> None:
    """Warns (RuntimeWarning) where objects have no rays of their own: there are more than a record can tell strata apart, or
    more than the rays reach for."""
    count = num_unaimed(statistics, [stratum for stratum in strata if stratum.num_mirrors == 0])
    if count:
        warn_user(f"{at_least(count)} {_without_rays(count)}: only rays of the field of view meet such ones. "
                  "More rays reach more objects, and objects put under one parent are aimed at as one")


def num_unaimed(statistics, strata=()) -> int:
    """How many objects and images a trace did not aim at. strata: those of its frame"""
    idle = sum(stratum.num_rays == 0 and stratum.object >= 0 and stratum.focus_of < 0 for stratum in strata)
    return statistics.num_unaimed + idle


def unaimed(statistics, strata=()) -> str:
    """How many objects and images a trace did not aim at; "" for none. strata: those of its frame"""
    count = num_unaimed(statistics, strata)
    return f"{count:,} {_without_rays(count)}" if count else ""


def _without_rays(count: int) -> str:
    return "objects and images have no rays of their own" if count > 1 else "object or image has no rays of its own"


def _sequences(count: int) -> str:
    return "sequences of mirrors were" if count > 1 else "sequence of mirrors was"


def unfollowed_frusta(statistics) -> str:
    """How many sequences of mirrors a trace did not follow further; "" for none."""
    count = statistics.num_unfollowed_frusta
    return f"{count:,} {_sequences(count)} not followed further" if count else ""


def unfollowed_sheets(statistics) -> str:
    """Where a trace did not split rays at sheets, and how many legs it took to end at one; "" for none."""
    unsplit, stopped = statistics.num_unsplit_rays, statistics.num_stopped_passes
    texts = []
    if unsplit:
        were = "were" if unsplit > 1 else "was"
        texts.append(f"{counted(unsplit, 'ray')} {were} not reflected at a sheet after splitting at too many before")
    if stopped:
        texts.append(f"{counted(stopped, 'leg')} {'end' if stopped > 1 else 'ends'} behind 64 sheets")
    return "; ".join(texts)
