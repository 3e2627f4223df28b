"""Effects of motion during a frame."""
from __future__ import annotations

import numpy as np

from ..base.radar.velocities import folded
from ..base.text.counts import counted
from ..scene.closing_speeds import speeds_of_objects
from .rules import Case, rule

SURFACE_SEARCHES = 32  # stretches in which new surface is looked for (sim/stream/keyframes.h)


def _moves(case: Case) -> bool:
    return len(case.moving) > 0 or case.radar.is_moving


@rule("motion over chirps", "Node.motion", "Radar.motion", "Radar.is_moving")
def _over_chirps(case: Case):
    reasons = ["the radar moves"] * case.radar.is_moving + [case.named(case.moving)] * (len(case.moving) > 0)
    return _moves(case), "; ".join(reasons) or "nothing moves"


@rule("velocities that fold")
def _folded(case: Case):
    limit = case.radar.waveform.max_velocity(case.radar.num_slots)
    if not _moves(case):
        return False, "nothing moves"
    speeds = {name: float(np.median(of_mesh)) for name, of_mesh in speeds_of_objects(case.scene, case.radar, case.time).items()}
    fast = sorted((name for name, speed in speeds.items() if abs(speed) > limit), key=lambda name: -abs(speeds[name]))
    if not fast:
        return False, f"no object comes or goes faster than {limit:.4g} m/s; what turns on one may"
    shown = f"'{fast[0]}' at {speeds[fast[0]]:+z.4g} m/s is shown at {folded(speeds[fast[0]], 2.0 * limit):+z.4g} m/s"
    others = f", and {len(fast) - 1} more likewise" if len(fast) > 1 else ""
    return True, f"{shown}{others}; the map of velocity repeats itself every {2.0 * limit:.4g} m/s"


@rule("motion within chirps", "synthesize.evaluate")
def _within_chirps(case: Case):
    if not _moves(case):
        return False, "nothing moves"
    exact = case.settings.evaluate == "samples"
    return True, 'at every sample; evaluate = "samples"' if exact else "linear; with motion over chirps"


@rule("points of reflection that move", "synthesize.replay")
def _moved_points(case: Case):
    if case.settings.replay == "fermat":
        return True, 'one Newton step; replay = "fermat"'
    return False, 'frozen where the trace found them, but on mirrors; replay = "material"'


@rule("records renewed at keyframes", "synthesize.retrace")
def _renewed(case: Case):
    what = {"never": "one record serves the frame",
            "invalid": "shadows, points of reflection, what edges leave of images and new surface, "
                       f"in {SURFACE_SEARCHES} of the stretches at most",
            "always": "the scene is traced anew"}[case.settings.retrace]
    return case.settings.retrace != "never", f'{what}; retrace = "{case.settings.retrace}"'


@rule("deforming meshes", "Node.deformation")
def _deforming(case: Case):
    return case.meshes_or(case.deforming, "no mesh has a vertex sequence, morph targets or a skin")


@rule("paths at rest evaluated once")
def _bypass(case: Case):
    if case.radar.is_moving:
        return False, "the radar moves"
    still = case.num_meshes - len(case.moving)
    return still > 0, f"{still} of {counted(case.num_meshes, 'mesh')} and the radar stand still" if still else "all meshes move"
