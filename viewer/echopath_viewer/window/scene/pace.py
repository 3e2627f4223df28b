"""How much is drawn in the time that a picture may take: rays and pixels while the camera moves, smooth edges."""
from __future__ import annotations

import math

FEWEST_RAYS, FEW_RAYS, MANY_RAYS = 300, 2000, 20_000
SLOW, QUICK = 0.045, 0.022  # s of a picture: with what the rest of the window takes, more than SLOW is below 15 pictures a second
MOST_SLOW = 2               # pictures in a row, before less is drawn: one may be slow by chance
GROWTH = 1.25               # from one number of rays to the next
FAR_TOO_SLOW = 2.0          # times SLOW: pixels become as coarse as they may be at once

INSTANT, NUM_QUICK, SAMPLES = 0.008, 5, 4  # s of a picture; pictures in a row, before edges are smoothed; samples of a pixel


class Pace:
    """As many rays as leave a smooth motion, in pixels as coarse as they may be: a software picture takes its time for the
    pixels of the rays.

    num_rays: that the next picture has at most; coarseness: its pixels are squares of that many of the screen's
    """

    def __init__(self, coarsest: int, first_rays: int):
        """coarsest: that pixels may be; first_rays: that are tried before the time of a picture is known."""
        self.num_rays, self.coarseness, self._coarsest = first_rays, 1, coarsest
        self.begin()

    def begin(self) -> None:
        """Another motion begins: what was too much in the last one is tried again."""
        self._too_many, self._too_fine, self._num_slow = math.inf, 0, 0

    def follow(self, seconds: float, num_there: int) -> bool:
        """Takes note of what a picture took in s, of num_there rays at most; returns whether the next one is drawn
        in another way."""
        before, more = (self.num_rays, self.coarseness), min(int(GROWTH * self.num_rays), num_there)
        self._num_slow = self._num_slow + 1 if seconds > SLOW else 0
        if self._num_slow >= MOST_SLOW:
            self._num_slow = 0
            self._draw_less(seconds, num_there)
        elif seconds > SLOW:
            return False
        elif self.num_rays < more < self._too_many:
            self.num_rays = more
        elif self.coarseness - 1 > self._too_fine and seconds * self.coarseness < SLOW * (self.coarseness - 1):
            self.coarseness -= 1  # lines take a time that goes with their length in pixels
        return (self.num_rays, self.coarseness) != before

    def _draw_less(self, seconds: float, num_there: int) -> None:
        if self.coarseness < self._coarsest:
            self._too_fine = self.coarseness
            self.coarseness = self._coarsest if seconds > FAR_TOO_SLOW * SLOW else self.coarseness + 1
        else:
            self._too_many = min(self.num_rays, num_there)
            self.num_rays = max(int(self._too_many / max(GROWTH, seconds / SLOW)), FEWEST_RAYS)


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
