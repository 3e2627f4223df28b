"""What small files keep of a frame: its maps and labels, without paths and signals."""
from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np

from ..arguments.checks import refused
from ..base.classes.by_partition import ByPartition
from ..base.classes.equality import has_same_fields
from ..base.classes.made_by import made_by
from ..detections.detections import Detections
from ..labels.labels import Labels
from ..truth import Truth
from .frame import Frame

if TYPE_CHECKING:
    from ..base.classes.foreign_types import Axes

# Fields of Labels that small files keep for cells of the mask alone.
_OF_THE_MASK = ("power", "whole", "mean_power", "mean_share", "power_error", "share_error")


@made_by("ep.load_sequence")
@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class FrameMaps:
    """Maps, labels and detections of a frame, as the small files of a sequence keep them; made by `StoredSequence`.

    start_time: s, first sample of the frame; seed, noise_seed: of the rays and of the thermal noise, None: no noise
    labels: {partition: Labels}; powers of cells that have no label are 0 in them, and so are shares; {} without labels
    detections: Detections without the paths behind them, None: not asked for
    velocity: [V] m/s, receding positive; range: [R] m: axes of the range-Doppler map
    power: f32 [V, R] W of that map with its noise, mean over channels; None in files of keep="labels"
    azimuth: [A] rad, left positive; azimuth_power: f32 [A, R] W of the range-azimuth map; None where the radar sees no azimuth
        and in files of keep="labels"
    kept_truth: Truth of the objects in the middle of the frame, None: not asked for
    """

    start_time: float
    seed: int
    noise_seed: int | None
    labels: dict[str, Labels]
    detections: Detections | Any  # None unless it was asked for
    velocity: np.ndarray
    range: np.ndarray
    power: np.ndarray | None = None
    azimuth: np.ndarray | None = None
    azimuth_power: np.ndarray | None = None
    kept_truth: Truth | None = None

    def __eq__(self, other) -> bool:
        return has_same_fields(self, other) if isinstance(other, FrameMaps) else NotImplemented

    __hash__ = None  # type: ignore[assignment]

    @property
    def truth(self) -> Truth:
        """Truth of the objects, as `Frame.truth`. Raises ValueError where the run was not asked for one (`truth=`)."""
        if self.kept_truth is None:
            raise refused(ValueError, "frame", "of a run with truth=True", self)
        return self.kept_truth

    def plot(self, *, ax: Axes | None = None, vmin: float | None = None, vmax: float | None = None,
             title: str | None = None) -> Axes:
        """Draws the range-Doppler map with its noise, and the detections in it, as `Frame.plot`.

        ax: Matplotlib axes to draw in, None: new ones; vmin, vmax: ends of the colour scale in dBm
        title: above the map, None: what it shows, with noise or without
        Returns the axes: range in m across, radial velocity in m/s up (receding positive). Raises ValueError for frames of
        keep="labels", which have no map.
        """
        from ..plots import draw_frame

        return draw_frame(self, ax=ax, vmin=vmin, vmax=vmax, title=title)

    if not TYPE_CHECKING:  # to checkers of types all names would be attributes
        def __getattr__(self, name: str):
            is_of_frames = hasattr(Frame, name) or name in Frame.__dataclass_fields__
            hint = "; small files have maps and labels alone, those of keep='all' the whole frame" if is_of_frames else ""
            raise AttributeError(f"'FrameMaps' object has no attribute '{name}'{hint}")

    def __repr__(self) -> str:
        power = "no power" if self.power is None else f"power [{len(self.velocity)}, {len(self.range)}]"
        return f"FrameMaps(at {self.start_time:.6g} s, {power}, labels: {', '.join(self.labels) or 'none'})"


def maps_of(frame: Frame, with_power: bool) -> FrameMaps:
    """What a small file keeps of a frame; with_power: maps too, not labels alone."""
    return FrameMaps(
        start_time=frame.start_time, seed=frame.seed, noise_seed=frame.noise_seed,
        labels=ByPartition({partition: _within_mask(labels) for partition, labels in frame.labels.items()}),
        detections=None if frame.detections is None else dataclasses.replace(frame.detections, echoes=None),
        velocity=frame.velocity, range=frame.range, power=frame.power if with_power else None, kept_truth=frame.kept_truth,
        azimuth=frame.azimuth if with_power else None, azimuth_power=frame.azimuth_power if with_power else None)


def _within_mask(labels):
    """Labels whose powers are kept where a cell has a label, and are 0 elsewhere: small when compressed."""
    values = {name: getattr(labels, name) for name in _OF_THE_MASK}
    kept = {name: np.where(labels.mask, value, 0.0) for name, value in values.items() if value is not None}
    return dataclasses.replace(labels, share=np.where(labels.mask, labels.share, 0.0), **kept)
