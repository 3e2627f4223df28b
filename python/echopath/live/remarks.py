"""What is wrong with a live scene, said as a fresh run says it."""
from __future__ import annotations

from ..base.process.callers import warn_user
from ..scene.bodies import warn_of_bodies
from ..scene.scene import Scene
from ..signals.rain_echoes import has_rain_echoes
from ..signals.silence import warn_of_silence
from ..tracing.edge_paths import warn_of_edge_paths
from ..tracing.lost_rays import warn_of_record
from ..tracing.tessellation import warn_of_coarse_meshes
from .kept_signal import KeptSignal, Update


def warn_of_scene(scene: Scene, radar, start_time: float) -> None:
    """Warns (RuntimeWarning, TessellationWarning) as `trace` does of a scene by itself, and of what `simulate` hears in it or
    makes of it and no path does.

    start_time: s, of the frame
    """
    warn_of_coarse_meshes(scene, radar.waveform.start_frequency)
    warn_of_bodies(scene, radar, start_time)
    if has_rain_echoes(scene, ()):
        warn_user("scene.weather: live views have no echoes of its rain, only its attenuation; simulate has both")
    if scene.interferers:
        warn_user(f"scene.interferers: live views have no signals of other radars, here {len(scene.interferers)}; simulate "
                  "has them")
    if radar.receiver is not None and (faults := radar.receiver.plain()):
        warn_user(f"radar.receiver: live views have no faults of the receiver, here {', '.join(faults)}; simulate has them")


def warn_of_update(kept: KeptSignal, done: Update, radar) -> None:
    """Warns (RuntimeWarning) as `trace` does where all rays were shot, and as `simulate` does where nothing is heard."""
    if done.new_record is not None:
        warn_of_record(done.new_record.frame)
        warn_of_edge_paths(done.new_record)
    if not kept.cube.any():
        warn_of_silence(kept.paths(), radar, kept.cube)
