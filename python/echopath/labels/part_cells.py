"""What labels of maps have in common, whatever the axes of the map are."""
from __future__ import annotations

import dataclasses

import numpy as np


@dataclasses.dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class PartCells:
    """The powers of parts in the cells of a map, and which cells have a label; the classes that have it say what each is."""

    part_names: list
    power: np.ndarray
    whole: np.ndarray
    share: np.ndarray
    dominant: np.ndarray
    noise_power: float
    noise_margin_db: float
    dynamic_range_db: float
    above_noise: np.ndarray
    mask: np.ndarray
