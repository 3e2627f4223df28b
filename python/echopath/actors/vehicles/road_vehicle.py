"""What cars and vans share: the body of an outline, and its wheels."""
from dataclasses import replace
from functools import lru_cache

import numpy as np

from ..actor import Actor
from ..lattice import cage_of, parts_of, refined
from .fittings import mirrors, plates
from .materials import BODY_MATERIALS
from .outline import full_cells, lattice_points
from .panels import label_of
from .wheel import Wheel, wheel_parts


def drive(outline, driving):
    """The Actor of an outline whose wheels roll as it drives (driving.Driving)."""
    return Actor(driving.carried(list(_shell(outline))) + four_wheels(outline, driving), driving.trajectory)


@lru_cache(maxsize=32)
def _shell(outline):
    """All at rest but the wheels, which the vehicles of one outline share: a tuple of parts."""
    parts, cage = body_parts(outline)
    return (*parts, *plates(cage), *mirrors(outline))


def body_parts(outline):
    """(parts of the body at rest, its refined cage)."""
    cage = refined(cage_of(lattice_points(outline), full_cells(), label_of(outline)), outline.levels)
    cage = replace(cage, vertices=_fitted(outline, cage.vertices))
    return parts_of(cage, BODY_MATERIALS, flat_sheets=("underside",)), cage


def four_wheels(outline, driving):
    """Parts wheel/front_left/tyre and so on."""
    wheel = Wheel(outline.tyre_diameter, outline.tyre_width, 0.66 * outline.tyre_diameter)
    parts = []
    for axle, x in (("front", outline.front_axle), ("rear", outline.rear_axle)):
        for side, sign in (("left", 1.0), ("right", -1.0)):
            parts += wheel_parts(wheel, f"wheel/{axle}_{side}", (x, sign * outline.wheel_y, wheel.radius), driving, outer=sign,
                                 wheelbase=outline.wheelbase if axle == "front" else None)
    return parts


def _fitted(outline, vertices):
    """Scales the body to its published length, width and height over its clearance."""
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    target_low = np.array([-outline.length / 2, -outline.width / 2, outline.clearance])
    target_high = np.array([outline.length / 2, outline.width / 2, outline.height])
    return target_low + (vertices - low) * (target_high - target_low) / (high - low)
