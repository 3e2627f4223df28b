"""Where the record of a frame of a sequence comes from."""
from __future__ import annotations

from .. import _core
from ..arguments.settings import TraceSettings
from ..tracing.traces import traced


def record_of(scene: _core.Scene, radar: _core.Radar, settings: TraceSettings, *, start_time: float,
              still_rays: _core.KeptStillRays, progress=None) -> _core.Paths:
    """The record of a frame of a sequence: the same bits whichever frames were recorded before.

    The scene is traced anew. Unless the settings say otherwise, rough surfaces scatter from points of their own, which are the
    same in all frames, and before a radar at rest what stands still has the same rays. All have the objects of frame 0: what
    surrounds the antenna there does so throughout.
    settings: of the rays, with the start of frame 0; start_time: s, of this frame; still_rays: of the sequence
    progress: as in `trace`
    """
    scatterers = "surface" if settings.scatterers == "auto" else settings.scatterers
    return traced(scene, radar, settings.replace(start_time=start_time, scatterers=scatterers),
                  objects_time=radar.middle_of_frame(settings.start_time), still_rays=still_rays, progress=progress)
