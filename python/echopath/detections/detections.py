"""A labelled point cloud."""
from __future__ import annotations

import dataclasses
import os
from typing import TYPE_CHECKING, Literal

import numpy as np

from ..arguments.checks import LARGEST_COUNT, count
from ..base.classes.equality import has_same_fields
from ..base.classes.made_by import made_by
from ..presentation.tables import make_table, write_csv
from .directions import toward
from .echo_fields import EchoFields

if TYPE_CHECKING:
    from ..base.classes.foreign_types import Axes, DataFrame

DetectionsView = Literal["range_doppler", "above"]
NOISE = "noise"  # part of a detection that no echo made
COLUMNS = ("range", "velocity", "azimuth", "elevation", "power", "snr_db", "part", "object", "ghost_type", "order",
           "class_code", "share", "is_noise", "is_resolved", "velocity_index", "range_index", "seed", "noise_seed")
UNITS = {"range": "m", "velocity": "m/s", "azimuth": "rad", "elevation": "rad", "power": "W", "snr_db": "dB"}
_FIELDS = COLUMNS[:COLUMNS.index("is_noise")]


@made_by("ep.detect")
@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Detections:
    """Echoes that stand out of the noise of a range-Doppler map, D of them by cell; made by `detect`.

    cells: [D, 2] (velocity, range) indices; several detections of one cell have several directions
    range: [D] m, without the shift that this velocity makes in the map
    velocity: [D] m/s, receding positive, folded as in the map unless `folds` were tried
    azimuth, elevation: [D] rad, left and up positive, in the radar's frame; NaN where the antennas cannot tell
    power: [D] W, received, what windows lose between cells put back; noise: [D] W, mean about the cell
    part: [D] text, of the largest power in the cell; "noise" where is_noise; "" where nobody asked. In frames also what no path
        makes: "interference", "rain", "leakage"; and "residue", of other transmitters' echoes behind a code of "cdm", or of
        "ddm" or "bpm" whose chirps differ
    is_noise: bool [D], echoes and other signals hold less than half of what its cell has above the mean of thermal noise: noise
        alone made it, or made an echo larger by more than 3 dB and that mean
    is_resolved: bool [D], the rays know the mean received power of the object or ghost that made it to 0.3 dB (`ep.unresolved`);
        False where nobody knows
    share: [D] of that part in the sum of the powers of all parts, NaN without one
    object: [D] text, whose echo it is, "" for the surroundings, noise and what no path makes; ghost_type, order, class_code:
        i32 [D], as of `families`, 0 without an object
    echoes: which paths make which cell, None without paths
    centre: [3] m, in the radar's frame, from which points are counted: half-way between transmitters and receivers
    seed, noise_seed: of the rays and of the noise in the map, None: not known
    """

    cells: np.ndarray
    range: np.ndarray
    velocity: np.ndarray
    azimuth: np.ndarray
    elevation: np.ndarray
    power: np.ndarray
    noise: np.ndarray
    part: np.ndarray
    share: np.ndarray
    is_noise: np.ndarray
    object: np.ndarray
    ghost_type: np.ndarray
    order: np.ndarray
    class_code: np.ndarray
    is_resolved: np.ndarray
    echoes: EchoFields | None = None
    centre: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros(3))
    seed: int | None = None
    noise_seed: int | None = None

    @property
    def snr_db(self) -> np.ndarray:
        """Power over noise, [D] dB; infinite in a map without noise."""
        with np.errstate(divide="ignore"):
            return 10.0 * np.log10(self.power / self.noise)

    @property
    def points(self) -> np.ndarray:
        """[D, 3] m, in the radar's frame; in the xy-plane where no elevation is known, NaN where no azimuth is."""
        return self.centre + self.range[:, None] * toward(self.azimuth, np.nan_to_num(self.elevation))

    def paths(self, i: int) -> tuple[np.ndarray, np.ndarray]:
        """The paths behind detection i: (indices i64 [N], shares [N] of the power), largest share first.

        Model: lengths and amplitudes of at most 8 channels at mid-frame, the velocity of `path_cells` and its change over the
        frame for the first antennas, and the response of the windows; powers are means over the channels, also of what was
        found in beams. Taken are the strongest that hold 99.99 % of the sum of the powers of single paths, of which the shares
        are.
        i: index, 0 to D - 1, or from the end, -1 to -D. Empty where is_noise. Raises ValueError where `detect` was given no
        paths, TypeError or ValueError for what is no whole number, IndexError.
        """
        i = count(-LARGEST_COUNT)("i", i)
        if self.echoes is None:
            raise ValueError("paths: detect(..., paths=) was not given any")
        if not -len(self) <= i < len(self):
            raise IndexError(f"i: must be in [0, {len(self)}), or count from the end, got {i}")
        if self.is_noise[i]:
            return np.zeros(0, np.int64), np.zeros(0)
        self.echoes.evaluate(self.cells)
        return self.echoes.paths(self.cells[i])

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """Writes a table with a row for each detection, whole or not at all.

        path: of the file. Columns in m, m/s, rad, W and dB as the fields, whose names end with the unit (range_m,
        velocity_m_per_s), then the indices of the cell and the seeds; unknown numbers are left empty. Raises ep.FileError.
        """
        flags = [self.is_noise.astype(int), self.is_resolved.astype(int)]
        seeds = [["" if seed is None else str(seed)] * len(self) for seed in (self.seed, self.noise_seed)]
        columns = [*(getattr(self, name) for name in _FIELDS), *flags, *self.cells.T, *seeds]
        write_csv(path, dict(zip(COLUMNS, columns)), UNITS)

    def to_pcd(self, path: str | os.PathLike[str]) -> None:
        """Writes a point cloud as the Point Cloud Library reads it (PCD 0.7, binary, float32), whole or not at all.

        path: of the file. Fields: x, y, z in m in the radar's frame (NaN where no azimuth is known), intensity in dB over the
        noise, velocity in m/s, range in m, azimuth and elevation in rad. Raises ep.FileError.
        """
        from .point_cloud import write_pcd

        write_pcd(self, path)

    def to_las(self, path: str | os.PathLike[str]) -> int:
        """Writes a point cloud as LAS 1.4, whole or not at all.

        path: of the file, .las or .laz. Coordinates in m in the radar's frame, to 0.1 mm; intensity in 1/100 dB over the
        noise; velocity (m/s), range (m), azimuth, elevation (rad) and snr_db as extra dimensions. Needs laspy.
        Returns how many detections are left out because no azimuth of them is known. Raises ep.FileError, and
        ModuleNotFoundError without laspy.
        """
        from .point_cloud import write_las

        return write_las(self, path)

    def to_dataframe(self) -> DataFrame:
        """A pandas.DataFrame with a row for each detection.

        Columns as in `to_csv`, named as the fields, in m, m/s, rad, W and dB, without the seeds, which stand in
        `attrs["seed"]` and `attrs["noise_seed"]`; units in `attrs["units"]`. Needs pandas, raises ModuleNotFoundError without it.
        """
        columns = {name: getattr(self, name) for name in (*_FIELDS, "is_noise", "is_resolved")}
        columns |= {"velocity_index": self.cells[:, 0], "range_index": self.cells[:, 1]}
        table = make_table(columns, UNITS)
        table.attrs |= {"seed": self.seed, "noise_seed": self.noise_seed}
        return table

    def plot(self, view: DetectionsView = "range_doppler", *, ax: Axes | None = None, title: str = "") -> Axes:
        """Draws a point for each detection, coloured by the object whose echo it is, larger where it is stronger; rings are
        ghosts.

        view: "range_doppler", or "above", which needs azimuths; ax: Matplotlib axes to draw in, None: new ones
        title: "": that of axes with a title, else how many there are
        Returns the axes: range in m and radial velocity in m/s, or metres to the left and ahead in the radar's frame. Raises
        ValueError for another view, for a view from above without azimuths, and for axes with a picture of another view.
        """
        from ..plots import draw_detections

        return draw_detections(self, view=view, ax=ax, title=title)

    def _repr_html_(self) -> str:
        from ..presentation.notebook import detections_html

        return detections_html(self)

    def __eq__(self, other) -> bool:
        return has_same_fields(self, other, leave_out=("echoes",)) if isinstance(other, Detections) else NotImplemented

    __hash__ = None

    def __len__(self) -> int:
        return len(self.range)

    def __repr__(self) -> str:
        if not len(self):
            return "Detections(0)"
        names, counts = np.unique(self.part[(self.part != "") & ~self.is_noise], return_counts=True)
        of_parts = "".join(f", {count} {name}" for name, count in zip(names, counts))
        of_parts += f", {self.is_noise.sum()} of noise alone" if self.is_noise.any() else ""
        return (f"Detections({len(self)}: {self.range.min():.2f} to {self.range.max():.2f} m, {self.velocity.min():z.2f} to "
                f"{self.velocity.max():z.2f} m/s{of_parts})")
