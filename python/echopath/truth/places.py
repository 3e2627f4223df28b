"""Where objects are in range-azimuth maps."""
from __future__ import annotations

import numpy as np

from ..arguments.objects import named_globs
from ..base.radar.antennas import centre_of
from .boxes import boxes_at


def true_places(scene, radar, objects, time) -> dict:
    """{name: (range in m, azimuth in rad)} of the middle of the boxes of objects, as a radar sees them.

    scene, radar: of the map; objects: as in `families`, but None; time: s. Raises AttributeError for other objects.
    """
    named = named_globs(objects)
    world = radar.world_from_radar(time)
    middle = boxes_at(scene, [globs for _, globs in named], time, radar.frame_duration).centre
    sight = (middle - world[:3, 3]) @ world[:3, :3] - centre_of(radar)
    return {name: (float(np.linalg.norm(way)), float(np.arctan2(way[1], way[0]))) for (name, _), way in zip(named, sight)}
