"""How many rays are drawn while the camera moves."""
from __future__ import annotations

FEWEST_RAYS = 300
SLOW, QUICK = 0.045, 0.022  # s of a picture: with what the rest of the window takes, more than SLOW is below 15 pictures a second


class Pace:
    """As many rays as leave a smooth motion: halved after a slow picture, doubled after a quick one.

    num_rays: that the next picture has at most
    """

    def __init__(self):
        self.num_rays = FEWEST_RAYS

    def follow(self, seconds: float, num_there: int) -> bool:
        """Takes note of what a picture took in s, of num_there rays at most; returns whether the next one has another number."""
        before = self.num_rays
        if seconds > SLOW:
            self.num_rays = max(before // 2, FEWEST_RAYS)
        elif seconds < QUICK and before < num_there:
            self.num_rays = 2 * before
        return self.num_rays != before
