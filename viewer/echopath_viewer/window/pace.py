"""How much is drawn in the time that a picture may take: rays while the camera moves, smooth edges."""
from __future__ import annotations

FEWEST_RAYS = 300
SLOW, QUICK = 0.045, 0.022  # s of a picture: with what the rest of the window takes, more than SLOW is below 15 pictures a second

INSTANT, NUM_QUICK, SAMPLES = 0.008, 5, 4  # s of a picture; pictures in a row, before edges are smoothed; samples of a pixel


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


class Smoothing:
    """Edges are smoothed where pictures are quick, as those of graphics cards are; no more once one with smooth edges was slow.

    samples: of each pixel, 0: edges are not smoothed
    """

    def __init__(self):
        self.samples, self._num_quick, self._is_tried = 0, 0, False

    def follow(self, seconds: float) -> bool:
        """Takes note of what a picture took in s; returns whether `samples` is another number now."""
        before = self.samples
        self._num_quick = self._num_quick + 1 if seconds < INSTANT else 0
        if self.samples and seconds > QUICK:
            self.samples = 0
        elif not self._is_tried and self._num_quick >= NUM_QUICK:
            self.samples, self._is_tried = SAMPLES, True
        return self.samples != before
