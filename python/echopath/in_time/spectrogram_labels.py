"""Which part of the signal owns each cell of a spectrogram."""
from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from .. import _core
from ..arguments.checks import an, checked, optional, refused
from ..arguments.settings import LabelSettings
from ..base.classes.equality import has_same_fields, is_same
from ..base.classes.made_by import made_by
from ..base.text.counts import counted
from ..labels.part_cells import PartCells, floor_over, masks_of
from ..presentation.xarray_maps import spectrogram_labels_dataset
from .maps import Spectrogram

if TYPE_CHECKING:
    from ..base.classes.foreign_types import Axes, Dataset

_SAME = ("times", "velocity", "trains", "window_length", "hop", "window", "zero_pad", "range_gate", "channel")


@made_by("ep.spectrogram_labels")
@dataclasses.dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class SpectrogramLabels(PartCells):
    """Labels of all cells of a spectrogram [T, V]; made by `spectrogram(labels=True)` and `spectrogram_labels`.

    times: [T] s, velocity: [V] m/s, receding positive; train: i32 [T], trains: [N, 2] s, as in Spectrogram; part_names: [K]
    power: [K, T, V] W of each part; whole: [T, V] W
    share: [K, T, V], powers of the parts over their sum: they add up to 1, or are 0 where there is no power
    dominant: i16 [T, V], the part of the largest share (the first of equal ones), -1 outside the mask
    noise_power: W, mean of the noise in a cell; noise_margin_db: dB above it that count as above the noise, minus
        infinity where all cells do
    dynamic_range_db: dB below the strongest cell that the mask goes down to: of frames that of the paths, else of the whole
    above_noise: bool [T, V], whether the whole is above the noise; mask: bool [T, V], above it and within the dynamic range
    """

    times: np.ndarray
    velocity: np.ndarray
    train: np.ndarray
    trains: np.ndarray

    def to_xarray(self) -> Dataset:
        """The maps as an xarray.Dataset, without a copy: power (W) and share by part, time (s) and velocity (m/s); whole (W),
        mask, above_noise and dominant, an index of the coordinate dominant_names, -1: none. Needs xarray, raises
        ModuleNotFoundError without it.
        """
        return spectrogram_labels_dataset(self)

    def plot(self, *, ax: Axes | None = None, title: str = "Which part made each cell") -> Axes:
        """Draws the power of the whole in grey under the cells that have a label, coloured by the part that dominates.

        ax: Matplotlib axes to draw in, None: new ones; title: above the map
        Returns the axes: time in s across, radial velocity in m/s up (receding positive). Raises TypeError.
        """
        from ..plots import draw_spectrogram_labels

        return draw_spectrogram_labels(self, ax=ax, title=title)

    def __eq__(self, other) -> bool:
        return has_same_fields(self, other) if isinstance(other, SpectrogramLabels) else NotImplemented

    __hash__ = None

    def __repr__(self) -> str:
        cells = [np.count_nonzero(self.dominant == number) for number in range(len(self.part_names))]
        told = [f"{name}: {counted(count, 'cell')}" for name, count in zip(self.part_names, cells) if count]
        empty = [f"{counted(cells.count(0), 'part')} without cells"] if 0 in cells else []
        labelled = f"{np.count_nonzero(self.mask)} labelled"
        return f"SpectrogramLabels({', '.join([str(list(self.whole.shape)), labelled, *told, *empty])})"


def _parts_rule(argument: str, value) -> dict:
    if not isinstance(value, Mapping):
        raise refused(TypeError, argument, "a dict {name: Spectrogram}", value)
    if not value:
        raise refused(ValueError, argument, "a dict of one Spectrogram at least", value)
    return {str(name): an(Spectrogram)(argument, one) for name, one in value.items()}


@checked(parts=_parts_rule, whole=optional(an(Spectrogram)), noise_margin_db=LabelSettings.RULES["noise_margin_db"],
         dynamic_range_db=LabelSettings.RULES["dynamic_range_db"])
def spectrogram_labels(parts: Mapping[str, Spectrogram], whole: Spectrogram | None = None, *,
                       noise_margin_db: float = LabelSettings.noise_margin_db,
                       dynamic_range_db: float | None = LabelSettings.dynamic_range_db) -> SpectrogramLabels:
    """Which part owns each cell of a spectrogram, as `annotate` says of the cells of a map.

    Of frames `spectrogram(frames, labels=True).labels` has the same of all their parts, objects and ghosts, from one pass.
    parts: {name: Spectrogram}, of one signal and all by the same windows: `spectrogram(frames, part=name)` of each
    whole: Spectrogram of all of them together, None: the sum of their powers, which leaves out how they interfere
    noise_margin_db: dB above the mean of the noise that the whole must be, -300 to 300
    dynamic_range_db: dB below the strongest cell that the mask goes down to, None: no limit
    Returns SpectrogramLabels with maps [time, velocity]; a cell belongs to its strongest part. Raises TypeError or ValueError
    naming the argument, also for spectrograms of other times or velocities. Its arrays are its own.
    """
    first = next(iter(parts.values()))
    for name, one in [*parts.items(), *([("whole", whole)] if whole is not None else [])]:
        _require_same(name, one, first)
    return labels_of(parts, whole, noise_margin_db, dynamic_range_db)


def labels_of(parts: dict[str, Spectrogram], whole: Spectrogram | None, noise_margin_db: float, dynamic_range_db: float | None,
              strongest: float | None = None) -> SpectrogramLabels:
    """What `spectrogram_labels` returns, of arguments that are right.

    noise_margin_db: minus infinity: no cell is in the noise; strongest: W, as in `masks_of`
    """
    first = next(iter(parts.values()))
    power = np.stack([one.power for one in parts.values()])
    total = power.sum(axis=0) if whole is None else whole.power.copy()
    range_db = np.inf if dynamic_range_db is None else dynamic_range_db
    floor = floor_over(first.noise_power, noise_margin_db)
    above_noise, mask = masks_of(total, floor, 10.0 ** (-0.1 * range_db), strongest)
    return SpectrogramLabels(
        times=first.times.copy(), velocity=first.velocity.copy(), train=first.train.copy(), trains=first.trains.copy(),
        part_names=list(parts), power=power, whole=total, share=_core.power_shares(power),
        dominant=_core.strongest_part(power, mask), noise_power=first.noise_power, noise_margin_db=noise_margin_db,
        dynamic_range_db=range_db, above_noise=above_noise, mask=mask)


def _require_same(name: str, one: Spectrogram, first: Spectrogram) -> None:
    for field in _SAME:
        if not is_same(getattr(one, field), getattr(first, field)):
            argument = name if name == "whole" else "parts"
            raise ValueError(f"{argument}: must all have the same {field}, which '{name}' has not")
