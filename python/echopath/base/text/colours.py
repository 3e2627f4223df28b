"""Colours of names, the same in pictures, label images and the viewer."""
from __future__ import annotations

import colorsys

from ..numerics.golden import golden_place

REST_COLOUR = (128, 128, 128)       # of the part "other"
# Okabe and Ito: told apart with any colour vision; beyond them hues a golden angle apart.
FIRST_COLOURS = ("#e69f00", "#56b4e9", "#009e73", "#f0e442", "#0072b2", "#d55e00", "#cc79a7")


def colours_of(names) -> list[tuple]:
    """A colour (red, green, blue), 0 to 255, for each of the names [N]; grey for "other"; the same ones for the same
    names."""
    counted = iter(range(len(names)))
    return [REST_COLOUR if name == "other" else _colour(next(counted)) for name in names]


def _colour(index: int) -> tuple:
    if index < len(FIRST_COLOURS):
        text = FIRST_COLOURS[index]
        return tuple(int(text[i:i + 2], 16) for i in (1, 3, 5))
    turn = golden_place(index - len(FIRST_COLOURS))
    saturation, value = 0.55 + 0.15 * (index % 3), 0.95 - 0.2 * (index % 2)
    return tuple(round(255 * part) for part in colorsys.hsv_to_rgb(turn, saturation, value))
