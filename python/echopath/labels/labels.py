"""What annotation gives: labels of the cells of a map, of the objects of the scene, and of their ghosts."""
from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from ..arguments.checks import choice
from ..arguments.part_names import BESIDE, REST
from ..base.classes.equality import has_same_fields
from ..base.classes.made_by import made_by
from ..base.text.counts import counted
from ..paths.resolution import Interval
from ..paths.visibility import HIDDEN_SHARE
from .dataset import dataset_of
from .left_out import LeftOut
from .part_cells import PartCells
from .report import ghost_words, object_words, text_of
from .table import table_of

if TYPE_CHECKING:
    from ..base.classes.foreign_types import Axes, DataFrame, Dataset

NONE = -1  # in a map of indices: no label
COMES_INTO_VIEW = "comes into view"
UNRESOLVED = "unresolved"


class Peak(NamedTuple):
    """The strongest cell of a label in a range-Doppler map: range in m, velocity in m/s (receding positive), power in W."""

    range: float
    velocity: float
    power: float


class AzimuthPeak(NamedTuple):
    """The strongest cell of a label in a range-azimuth map: range in m, azimuth in rad (left positive), power in W."""

    range: float
    azimuth: float
    power: float


class Box(NamedTuple):
    """Smallest box about the cells of a label, between the centres of its outermost cells: ranges in m, velocities in m/s.

    Velocities fold: velocity_min > velocity_max where the box goes over the end of the axis.
    """

    range_min: float
    range_max: float
    velocity_min: float
    velocity_max: float


class AzimuthBox(NamedTuple):
    """Smallest box about the cells of a label, between the centres of its outermost cells: ranges in m, azimuths in rad."""

    range_min: float
    range_max: float
    azimuth_min: float
    azimuth_max: float


def is_occluded(seen) -> bool:
    """Whether others hide an object. seen: ObjectVisibility or ObjectLabel"""
    return seen.visible_share <= HIDDEN_SHARE and bool(seen.occluders)


@made_by("ep.annotate")
@dataclasses.dataclass(frozen=True, repr=False)
class ObjectLabel:
    """What a map shows of one object of the scene, by echoes that take no mirror.

    name: full name in the scene
    status: the first of these that holds
        "seen": it has cells
        "ghosts only": it has none, but a ghost of it has; `is_occluded` tells of objects that only multipath lights
        "outside the map": an end of the radar has no antenna that looks at it, or all of it lies beyond the range axis
        "masked": some of its cells are above the noise, but stronger echoes have them or they are below the dynamic range
        "comes into view": as "occluded" at the time of the trace, but not at others of the frame: what it sends then is in no
            path of the trace (retrace="invalid" adds it)
        "occluded": others hide it (visible_share is at most 5 %) and none of its cells is above the noise; see `occluders`
        "unresolved": none of its cells is above the noise, but the rays leave open whether its echoes are (`received`): more
            rays tell, see `ep.unresolved`
        "hidden in noise": it has echoes, none of them above the noise
        "not seen": it has no echo, for example because it mirrors all away from the radar
    cells: how many cells of the mask it has: where no ghost, no other object and not the surroundings are stronger; a ghost of
        its own has no cell where the direct echoes are at most 10 dB weaker, than the ghost or than their own strongest cell
        (above the noise): there no receiver tells one from the other
    power: W, received by its direct echoes, mean over channels, chirps and samples; within its cells or not. Where it
        has no signal of its own, as mostly an object that is "hidden in noise", this is the mean over the random phases
    peak: its strongest cell with its own power there, Peak or AzimuthPeak; None without cells
    box: Box or AzimuthBox about its cells, None without cells
    visible_share: of the solid angle in which the radar would see it alone, the share that nothing hides, 0 to 1
    occluders: {name: share of that solid angle which this one hides}, largest first
    received: Interval of the mean received power of its direct echoes, over the random phases, in W, and whether the rays know
        it; None: echoes that only records of later keyframes have (`retrace`)
    """

    name: str
    status: str
    cells: int
    power: float
    peak: Peak | AzimuthPeak | None
    box: Box | AzimuthBox | None
    visible_share: float
    occluders: dict[str, float]
    received: Interval | None

    @property
    def is_occluded(self) -> bool:
        """Whether others hide it from the radar (visible_share is at most 5 %), also where its status is another.

        An object that only multipath lights has the status "ghosts only", and is occluded all the same.
        """
        return is_occluded(self)

    def __repr__(self) -> str:
        return f"ObjectLabel({object_words(self)})"


@made_by("ep.annotate")
@dataclasses.dataclass(frozen=True, repr=False)
class GhostLabel:
    """What a map shows of one ghost: an object's echoes over the same mirrors, of the same type and order.

    The echoes of types 1 and 2 of order 2 over one mirror are the same way there and back: where transmitter and receiver
    stand side by side, no map tells them apart. Ghosts of an object over the same mirrors, of the same order, therefore
    compete for cells by the power of their common field; a cell that they win has the strongest of them by itself, the first
    of those within 0.1 dB: of a pair from one place type 1 has all cells and type 2 none.
    object: full name of the object; via: names of the children of the scene root that mirrored it, tuple of str
    ghost_type: 1 (last bounce on the object) or 2 (last bounce on a mirror); order: number of bounces
    class_code: of the Radar Ghost Dataset (Kraus et al.)
    cells, power (W), peak, box, received: as in ObjectLabel
    """

    object: str
    ghost_type: int
    order: int
    via: tuple[str, ...]
    class_code: int
    cells: int
    power: float
    peak: Peak | AzimuthPeak | None
    box: Box | AzimuthBox | None
    received: Interval | None

    def __repr__(self) -> str:
        return f"GhostLabel({ghost_words(self)})"


@made_by("ep.annotate")
@dataclasses.dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class Labels(PartCells):
    """Labels of all cells of a map [V, R]; of a range-azimuth map [A, R] wherever V is written.

    plane: "range_doppler" or "range_azimuth"
    velocity: [V] m/s, None in a range-azimuth map; azimuth: [A] rad, None in a range-Doppler map; range: [R] m
    part_names: [K], "other" after those that were asked for, then what no path makes, where the frame has it: "interference",
        "rain", "leakage", "residue" (of other transmitters' echoes behind a code of "cdm", or of "ddm" or "bpm" whose
        chirps differ)
    power: [K, V, R] W of each part, mean over channels, noise-free; whole: [V, R] W of their sum as fields, which differs
        from the sum of their powers where they interfere
    share: [K, V, R], powers of the parts over their sum: they add up to 1, or are 0 where there is no power
    dominant: i16 [V, R], the part of the largest share (the first of equal ones), -1 outside the mask
    noise_power: W, mean of the noise in a cell; noise_margin_db: dB above it that count as above the noise, minus
        infinity where all cells do (noise=False)
    dynamic_range_db: dB below the strongest cell of the paths that the mask goes down to, whatever leaks or interferes
    above_noise: bool [V, R], whether the whole is above the noise; mask: bool [V, R], above the noise and within the
        dynamic range
    objects: list of ObjectLabel, in the order of the scene; object_map: i16 [V, R], index into it, -1: none
    ghosts: list of GhostLabel; ghost_map: i16 [V, R], index into it, -1: none. A cell of the mask belongs to the object, the
        ghost (all types of its order over the same mirrors as one field) or the surroundings that have the largest power
        there, but for what an object shares with its ghosts (ObjectLabel.cells)
    mean_power: [K, V, R] W, over the random phases of rough surfaces; mean_share: [K, V, R], the shares of these powers
    power_error, share_error: [K, V, R] standard errors of mean_power in W and of mean_share, from the batches of rays
    certain: bool [V, R], whether the dominant part is that of the mean power too and leads the next by two standard errors;
        False outside the mask. These five are None unless asked for (`errors=True`)
    seed: of the rays that were labelled
    part_received: list [K] of Interval, the mean received power of each part in W and whether the rays know it; None: of cubes
        without selections
    left_out: LeftOut of the families of paths whose signals were not made because none of them can own a cell: how many, their
        mean power in W together, and what the strongest can show in a cell at most, W. The power of such an object or ghost is
        the mean over the random phases (`received`); its cells, peak and box are what all signals would give. None: of frames
        with keyframes, which make all signals
    """

    plane: str
    velocity: np.ndarray | None
    azimuth: np.ndarray | None
    range: np.ndarray
    objects: list[ObjectLabel]
    object_map: np.ndarray
    ghosts: list[GhostLabel]
    ghost_map: np.ndarray
    seed: int
    mean_power: np.ndarray | None = None
    mean_share: np.ndarray | None = None
    power_error: np.ndarray | None = None
    share_error: np.ndarray | None = None
    certain: np.ndarray | None = None
    part_received: list[Interval] | None = None
    left_out: LeftOut | None = None

    @property
    def shape(self) -> tuple[int, int]:
        """(V, R), number of cells along velocity or azimuth, and along range."""
        return self.whole.shape

    def to_xarray(self) -> Dataset:
        """The maps as an xarray.Dataset, without a copy: power (W) and share by part, velocity (m/s) or azimuth (rad), and
        range (m); whole (W), mask, dominant, object and ghost by cell, the last three indices of the coordinates dominant_names,
        object_names and ghost_names, -1: none; errors where they are known. Needs xarray, raises ModuleNotFoundError without it.
        """
        return dataset_of(self)

    def to_dataframe(self) -> DataFrame:
        """The objects and their ghosts as a pandas.DataFrame, a row for each, objects first.

        Columns: kind ("object" or "ghost"), name of the object, status (objects), via (names of what mirrored it, joined by
        " > "), ghost_type, order, class_code, cells, power (W); range (m), velocity (m/s) or azimuth (rad) and peak_power (W) of
        the strongest cell, the ends of the box about the cells; visible_share (objects); received, received_low and
        received_high (W, mean with its 95 % interval), is_resolved; units in `attrs["units"]`. Needs pandas, raises
        ModuleNotFoundError without it.
        """
        return table_of(self)

    def plot(self, what: Literal["parts", "objects"] = "parts", *, ax: Axes | None = None, title: str | None = None) -> Axes:
        """Draws the power of the whole in grey under the cells that have a label, with the names of the objects.

        what: "parts", cells by the part that dominates, all of them "other" where no parts were asked for, or "objects", cells
            of the objects and of their ghosts by type, which every Labels has
        ax: Matplotlib axes to draw in, None: new ones; title: None: what is shown
        Returns the axes: range in m across, radial velocity in m/s (receding positive) or azimuth in degrees up. Raises
        ValueError for another `what`.
        """
        from ..plots import draw_labels

        has_parts = not {REST, *BESIDE} >= set(self.part_names)
        of_parts = "Which part made each cell" if has_parts else 'Cells that have a label; plot("objects") tells whose'
        titles = {"parts": of_parts, "objects": "Objects and their ghosts"}
        title = titles[choice(*titles)("what", what)] if title is None else title
        return draw_labels(self, what=what, ax=ax, title=title)

    def _repr_html_(self) -> str:
        from ..presentation.notebook import labels_html

        return labels_html(self)

    def __eq__(self, other) -> bool:
        return has_same_fields(self, other) if isinstance(other, Labels) else NotImplemented

    __hash__ = None

    def __str__(self) -> str:
        return text_of(self)

    def __repr__(self) -> str:
        return (f"Labels({self.plane}, {list(self.shape)}, parts: {', '.join(self.part_names)}, "
                f"{counted(len(self.objects), 'object')}, {counted(len(self.ghosts), 'ghost')})")
