"""What labels of maps have in common, whatever the axes of the map are."""
from __future__ import annotations

import dataclasses

import numpy as np

from .. import _core


@dataclasses.dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class PartCells:
    """The powers of parts in the cells of a map, and which cells have a label; the classes that have it say what each is."""

    part_names: list[str]
    power: np.ndarray
    whole: np.ndarray
    share: np.ndarray
    dominant: np.ndarray
    noise_power: float
    noise_margin_db: float
    dynamic_range_db: float
    above_noise: np.ndarray
    mask: np.ndarray

    @property
    def noise_floor(self) -> float:
        """Power in W that cells above the noise exceed."""
        return floor_over(self.noise_power, self.noise_margin_db)


def floor_over(noise_power: float, margin_db: float) -> float:
    """Power in W that cells above a noise of `noise_power` W exceed; margin_db: minus infinity: no cell is in the noise"""
    return noise_power * 10.0 ** (0.1 * margin_db)


def masks_of(whole: np.ndarray, noise_floor: float, dynamic_range: float, strongest: float | None = None) -> tuple:
    """(above_noise, mask), bool [V, R] of powers of the whole [V, R] in W.

    noise_floor: W; dynamic_range: ratio of powers, down to which the mask goes below the strongest cell of the echoes
    strongest: W in that cell, None: the whole is echoes alone. Leakage, which no path makes, may be far above all echoes
    """
    peak = np.max(whole, initial=0.0)
    share = 1.0 if strongest is None or peak == 0.0 else strongest / peak
    return _core.cell_masks(whole, noise_floor, min(1.0, dynamic_range * share))
