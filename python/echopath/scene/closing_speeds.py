"""How fast the objects of a scene come nearer to a radar or go away from it."""
from __future__ import annotations

import numpy as np

from ..base.antennas import centre_of
from ..base.mesh_names import object_of
from ..base.rates import step_within


def closing_speeds(scene, radar, time: float) -> dict[str, float]:
    """{object: m/s of its vertex whose distance changes fastest, receding positive} of those that move towards the radar or
    from it.

    time: s, of the scene; the distance is that from the middle of the antennas. Differences of second order over `STEP` meet the
        speed of a wheel of 0.3 m and 50 turns/s to 0.01 m/s.
    """
    step = step_within(radar.frame_duration)
    antennas = [_middle_of_antennas(radar, instant) for instant in (time - step, time + step)]
    found = {}
    for mesh in scene.meshes:
        if radar.motion is None and not scene.is_moving(mesh.id):
            continue
        before, after = (np.linalg.norm(scene.world_vertices(mesh.id, instant) - antenna, axis=1)
                         for instant, antenna in zip((time - step, time + step), antennas))
        speeds, name = (after - before) / (2.0 * step), object_of(mesh.name)
        fastest = float(speeds[np.abs(speeds).argmax()])
        if abs(fastest) > abs(found.get(name, 0.0)):
            found[name] = fastest
    return found


def _middle_of_antennas(radar, time: float):
    world_from_radar = radar.world_from_radar(time)
    return world_from_radar[:3, :3] @ centre_of(radar) + world_from_radar[:3, 3]
