"""What the other radars of a scene send into the receivers of the radar of a frame."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..arguments.effects import INTERFERENCE, Choices, is_on
from ..arguments.frame_times import require_motion
from ..arguments.settings import TraceSettings
from ..base.process.callers import warn_user
from ..base.radar.antennas import polarization_of
from ..base.radar.chirps import start_with_middle
from ..scene.interferers import interferers_of, interferers_within
from ..scene.node import ALWAYS
from ..scene.sheets import passed_field
from ..tracing.traces import trace
from ..transmit import signal_shape
from ..weather.weather import attenuation_of
from .interference import frame_period, interference
from .interference_paths import powers_over_looks
from .interference_ways import antennas_see_each_other, interference_radar, require_apart, require_own_channels

_ROUNDING = 1e-9  # relative, of a lifetime that is the duration of a frame by another sum


def has_interference(scene, effects: Choices) -> bool:
    """Whether a scene has other radars and `effects` leave them on. Raises ValueError where only the latter ask for them."""
    return is_on(effects, INTERFERENCE, bool(interferers_of(scene)), "Scene.interferers")


def require_interferers(scene, radar: _core.Radar, effects: Choices, begin: float, end: float) -> None:
    """Raises ValueError, before the long work, for other radars that have no place at the begin of the first frame or at the end
    of the last one (s), or that of the radar."""
    if not has_interference(scene, effects):
        return
    for index, one in enumerate(interferers_of(scene)):
        argument = f"interferers[{index}].radar"
        require_own_channels(argument, one.radar)
        times = _span_of(one, begin, end)
        if times[0] > times[1]:
            continue
        require_motion(argument, one.radar, times)
        if one.over != "paths":
            require_apart(radar, one.radar, times, argument)


def warn_of_absent_interferers(scene, radar: _core.Radar, effects: Choices, begin: float, end: float) -> None:
    """Warns (RuntimeWarning) of other radars that do not send as long as a frame within a run, from begin to end in s."""
    if not has_interference(scene, effects):
        return
    for index, one in enumerate(interferers_of(scene)):
        first, last = _span_of(one, begin, end)
        if last - first < radar.frame_duration * (1.0 - _ROUNDING):
            warn_user(f"interferers[{index}]: does not send from {begin:g} to {end:g} s: its lifetime is {one.lifetime[0]:g} to "
                      f"{one.lifetime[1]:g} s")


def _span_of(one, begin: float, end: float) -> tuple[float, float]:
    """What of a time from begin to end (s) is within the lifetime of an Interferer; it ends before it begins where nothing is."""
    first, last = one.lifetime or ALWAYS
    return max(begin, first), min(end, last)


def interference_cube(scene, radar: _core.Radar, settings: TraceSettings, replay: str, progress=None) -> np.ndarray:
    """What the other radars of a scene send into the receivers in a frame, complex, in the shape of `synthesize` in sqrt(W).

    settings: of the trace of the frame, also of those from the other radars; replay: as in `synthesize`
    progress: as in `trace`. Warns of a radar that is never heard.
    """
    cube = np.zeros(signal_shape(radar), complex)
    begin = settings.start_time
    for index, one in interferers_within(scene, begin, begin + radar.frame_duration):
        ways = _ways_of(scene, radar, one, settings, replay, progress)
        if not any(way.any() for way in ways) and _sends_within(one, begin, begin + radar.frame_duration):
            _warn_of_silence(index, has_ways=bool(ways))
        cube += sum(ways)
    return cube


def _sends_within(one, begin: float, end: float) -> bool:
    """Whether a frame of an Interferer falls into a time from begin to end in s, or into a part of it: else that is its pause."""
    period = frame_period(one.radar, one.interval)
    into = (begin - one.offset) % period  # s, since one of its frames began
    return into < one.radar.frame_duration or into + end - begin > period


def _ways_of(scene, radar, one, settings: TraceSettings, replay: str, progress) -> list:
    """Signals of an Interferer in sqrt(W) over the direct way and over the paths of the scene, without those that it has not."""
    timing, ways = {"start_time": settings.start_time, "offset": one.offset, "interval": one.interval}, []
    paths = None if one.over == "direct" else _one_way_paths(scene, radar, one.radar, settings, progress)
    # Beside fields of paths that are vectors the direct one has its sign, too; scalar ones have none of the antennas.
    follows = settings.polarization == "auto" and paths is not None and paths.frame.polarization == "jones"
    polarization = "jones" if follows else settings.polarization
    if one.over != "paths" and (share := _direct_share(scene, radar, one.radar, settings)) > 0.0:
        ways.append(share * interference(radar, one.radar, **timing, polarization=polarization))
    if paths is not None and powers_over_looks(paths).any():
        ways.append(interference(radar, one.radar, paths, **timing, replay=replay))
    return ways


def _warn_of_silence(index: int, has_ways: bool) -> None:
    why = ("its chirps never come near those of the radar while it samples, which another offset or slope changes" if has_ways
           else "no way leads from it to the radar on which the antennas of both have gain and share a polarisation")
    warn_user(f"interferers[{index}]: is never heard in the frame: {why}")


def _direct_share(scene, radar, other, settings: TraceSettings) -> float:
    """What the scene leaves of the field of the direct way in the middle of the frame: 0 where something stands in it, or an
    antenna has no gain there."""
    time = radar.middle_of_frame(settings.start_time)
    between = interference_radar(radar, other, time=time)
    sent, heard = (np.mean([one.position for one in antennas], axis=0)
                   for antennas in (between.transmitters, between.receivers))
    if not (antennas_see_each_other(radar, other, time, settings.polarization)
            and _core.are_clear(scene, time=time, origin=sent, points=[heard])[0]):
        return 0.0
    passed = passed_field(scene, time=time, begin=sent, end=heard, frequency=other.waveform.start_frequency,
                          polarization=polarization_of(between.transmitters[0]))
    return passed * float(np.exp(-attenuation_of(scene, other, settings.effects) * np.linalg.norm(heard - sent)))


def _one_way_paths(scene, radar, other, settings: TraceSettings, progress):
    """Paths from the other radar to this one, both as they stand in the middle of the frame, through the scene of then."""
    time = radar.middle_of_frame(settings.start_time)
    between = interference_radar(radar, other, time=time)
    between = between.replace(multiplexing="tdm", code_phases=None, waveform=between.waveform.replace(num_chirps=1))
    return trace(scene, between, settings=settings.replace(start_time=start_with_middle(between, time)), progress=progress)
