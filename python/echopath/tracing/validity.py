"""Whether one trace serves a whole frame, and records brought up to another time of it."""
from __future__ import annotations

from .. import _core
from ..arguments.checks import ArrayLike, Progress, an, array, checked, flag, one_of, optional, real, refused
from ..arguments.settings import Replay, SignalSettings

_RADAR = optional(an(_core.Radar))


@checked(radar=_RADAR, replay=one_of(Replay), times=optional(array("[T]", finite=True)), arrays=flag)
def validity(paths: _core.Paths, radar: _core.Radar | None = None, *, replay: Replay = SignalSettings.replay,
             times: ArrayLike | None = None, arrays: bool = False, progress: Progress = None) -> _core.Validity:
    """Whether one trace serves the whole frame and the whole array: a report with warnings, and a certificate per object.

    Checks paths at both ends of the frame and at irrational places between, at eight more for each turn of what turns and two
    for each breakpoint of its motion, for the antennas of the trace and those at the rim of the array: phase errors of points
    of reflection that slide, whether these still lie on their surface, shadow rays of all legs, cosines, coefficients of
    images, what edges of unmarked planes leave of images over them; and traces the scene at these times for surface that was
    hidden from the trace. Exact parts of the replay (single bounces, images in mirrors) have no phase error. Of paths that
    end in a rough surface at most 16384 of each object and number of bounces are looked at. What more than 256 times would
    have to follow is a warning. Where the report asks for parts of the frame by themselves, `retrace` of `synthesize` and
    `simulate` does so, in as many stretches with keyframes=0. Parts of the array are radars with some of its receivers,
    `radar.replace(receivers=radar.receivers[:8])` and so on, each with a trace of its own; their cubes are joined along axis 1.
    paths: of a trace, all or a selection of them, which asks about these alone
    radar: another waveform, array or motion than that of the trace, or None
    replay: of the replay that is to be certified, as in `synthesize`
    times: [T] s, of the check, one at least, or None: as above
    arrays: keep what is found of each path, [P] each; then all are looked at
    progress: callable (stage, fraction), True for bars, or None
    Returns a Validity. Raises TypeError or ValueError naming the argument, also for motions that do not cover the times,
    KeyboardInterrupt on Ctrl-C.
    """
    if times is not None and not len(times):
        raise refused(ValueError, "times", "at least one time, or None", times)
    try:
        return _core.validity(paths, radar, replay=replay, times=times, arrays=arrays, progress=progress)
    except ValueError as error:
        if times is None or not str(error).startswith("time: "):
            raise
        raise ValueError(f"times: {str(error).removeprefix('time: ')}") from None


@checked(radar=_RADAR, time=real(unit="s"))
def renew(paths: _core.Paths, radar: _core.Radar | None = None, *, time: float, progress: Progress = None) -> _core.Renewal:
    """A record brought up to another time of the frame: hits stay, shadow rays and points of reflection are renewed.

    Material points keep their hits, and diffuse paths their weights and phases, so that rough surfaces keep their speckle.
    Coherent paths without edges get the coefficients of their angles at the time, and images over unmarked planes the share
    of the field that edges then leave. Surface that came into view has no paths here; `synthesize(retrace="invalid")` adds it.
    paths: of a trace
    radar: whose motion carries the antennas of the trace along, or None: that of the trace
    time: s
    progress: callable (stage, fraction), True for bars, or None
    Returns a Renewal. Raises TypeError or ValueError naming the argument, also where a motion does not cover the time.
    """
    return _core.renew(paths, radar, time=time, progress=progress)
