"""How much of the scene a pixel shows."""
from __future__ import annotations

import math

STEPS = 4  # of its width while the distance doubles


def pixel_at(distance: float, view_angle: float, height: int) -> float:
    """m that a pixel shows at a distance in m in front of the camera, or up to a sixth less, so that it changes in steps while
    the camera moves; 0 where that is not in front, or nothing is.

    view_angle: degrees, from the lower to the upper edge of the picture; height: of the picture in pixels
    """
    if not 0.0 < distance < math.inf:
        return 0.0
    step = 2.0**(math.floor(STEPS * math.log2(distance)) / STEPS)
    return step / pixels_per_radian(view_angle, height)


def pixels_per_radian(view_angle: float, height: int) -> float:
    """Of a small angle in the middle of the picture; arguments as above."""
    return max(height, 1) / (2.0 * math.tan(math.radians(view_angle) / 2.0))
