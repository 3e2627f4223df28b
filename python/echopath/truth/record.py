"""Truth as a value: a row for each object and frame."""
from __future__ import annotations

import dataclasses
import os
from typing import TYPE_CHECKING, Literal

import numpy as np

from ..arguments.checks import LARGEST_COUNT, count, refused, text
from ..base.classes.equality import has_same_fields
from ..base.classes.made_by import made_by
from ..base.numerics.rotations import quaternions
from ..base.text.counts import counted
from ..presentation.tables import make_table, write_csv
from .fields import FIELDS, UNITS

if TYPE_CHECKING:
    from ..base.classes.foreign_types import Axes, DataFrame, Dataset

_SIGNS = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])


@made_by("ep.truth")
@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Truth:
    """What is true of objects in the middle of frames, N rows of an object and a frame; made by `truth`.

    frame: i32 [N], index of the frame; time: [N] s, middle of the frame; name: [N] text, of the object
    position: [N, 3] m, world: the centre of the box; origin: [N, 3] m, world: the object's own origin, as its node is placed
        and moved (by a Trajectory, say); of groups whose meshes share place and motion, as a wheel's tyre and rim do, that
        place; of bodies without a motion of their own that deform, or whose parts move by themselves (`speed=` of actors), as
        far on in these axes as the centroid of the surface has come since time 0, or since the nearest time for which all
        their motions are made
    velocity: [N, 3] m/s, world: of the box's centre as part of the object's own axes, which node and motion carry; of
        bodies that deform, whose scale changes or whose parts move by themselves, plus the velocity of the centroid of the
        surface in these axes: a box whose faces go from limb to limb has no steady velocity of its own
    heading: [N] rad, horizontal direction of the velocity, left positive from the world's x; NaN below 0.1 mm/s
    size: [N, 3] m, of the smallest box about all vertices along the object's own axes; rotation: [N, 3, 3], world_from_box:
        those axes, of the node that bears its name, or of the lowest node above all its meshes; where all of these have one
        motion below it, as those of a trailer have, as that turns them; of what a placement mirrors with y to the other side
    yaw: [N] rad, where the box's own +x points; angular_velocity: [N, 3] rad/s, of these axes, in world axes
    position_in_radar: [N, 3] m; velocity_in_radar: [N, 3] m/s, its rate as it is seen from a radar that moves and turns;
        yaw_in_radar: [N] rad, of the box's +x in the radar's axes
    rotation_in_radar: [N, 3, 3], radar_from_box; direction_in_radar: [N, 3] unit vectors, where the velocity over ground
        points in the radar's axes, NaN below 0.1 mm/s. Both are NaN in files from before there were these
    range, azimuth, elevation: [N] m, rad, rad, of the box's centre from the point between transmitters and receivers that
        detections count from (`Detections.centre`); radial_velocity: [N] m/s, rate of that range, receding positive
    visible_share: [N], of the solid angle in which the radar would see the object alone, what nothing hides, 0 to 1
    received: [N] W, mean received power of the object's direct echoes (all its paths that touch nothing else, of any number
        of bounces on itself), over random phases, between the first antennas
    rcs: [N] m^2, radar cross section as seen: `received` by the radar equation for the box's centre, at the start frequency,
        by the gains of the first antennas there (polarisation left out): shadowed parts count as missing, and so does what the
        air of a scene with weather and sheets on the way take. NaN where an antenna has no gain; rcs_low, rcs_high: [N] m^2, of
        the 95 % interval of the received power
    """

    frame: np.ndarray
    time: np.ndarray
    name: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    heading: np.ndarray
    size: np.ndarray
    rotation: np.ndarray
    yaw: np.ndarray
    angular_velocity: np.ndarray
    origin: np.ndarray
    position_in_radar: np.ndarray
    velocity_in_radar: np.ndarray
    yaw_in_radar: np.ndarray
    rotation_in_radar: np.ndarray
    direction_in_radar: np.ndarray
    range: np.ndarray
    azimuth: np.ndarray
    elevation: np.ndarray
    radial_velocity: np.ndarray
    visible_share: np.ndarray
    received: np.ndarray
    rcs: np.ndarray
    rcs_low: np.ndarray
    rcs_high: np.ndarray

    @property
    def corners(self) -> np.ndarray:
        """Corners of the boxes, [N, 8, 3] m in world axes: the last axis of the box runs fastest."""
        return self._corners(self.position, self.rotation)

    @property
    def corners_in_radar(self) -> np.ndarray:
        """The same corners in the axes of the radar, [N, 8, 3] m."""
        return self._corners(self.position_in_radar, self.rotation_in_radar)

    @property
    def quaternions_in_radar(self) -> np.ndarray:
        """`rotation_in_radar` as unit quaternions (w, x, y, z), [N, 4]; w is 0 or more."""
        found = quaternions(self.rotation_in_radar) if len(self) else np.zeros((0, 4))
        return np.where(found[:, :1] < 0.0, -found, found)

    @property
    def rcs_dbsm(self) -> np.ndarray:
        """Radar cross section as seen, [N] in dB re 1 m^2; -inf for none."""
        with np.errstate(divide="ignore"):
            return 10.0 * np.log10(self.rcs)

    def of_object(self, name: str) -> Truth:
        """The rows of one object, in the order of the frames.

        name: as in the rows. Raises KeyError, TypeError for what is no text.
        """
        name = text("name", name)
        if not np.any(self.name == name):
            raise KeyError(f"name: must be one of {', '.join(dict.fromkeys(self.name.tolist()))}, got {name!r}")
        return self._where(self.name == name)

    def of_frame(self, frame: int) -> Truth:
        """The rows of the frame with that index; none where it has no objects. Raises TypeError for what is no index."""
        return self._where(self.frame == count(-LARGEST_COUNT)("frame", frame))

    def to_dataframe(self) -> DataFrame:
        """A pandas.DataFrame with a row for each object and frame.

        Columns: frame, time, name; x, y, z, vx, vy, vz, heading, length, width, height, yaw and the like in world axes,
        radar_x and the like in those of the radar, range, azimuth, elevation, radial_velocity, visible_share, received (W),
        rcs (m^2) with its interval, rotation and radar_rotation row by row; units in `attrs["units"]`. Needs pandas, raises
        ModuleNotFoundError without it.
        """
        return make_table(self._columns(), UNITS)

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """Writes the same table, whole or not at all; names of columns end with the unit (range_m, vx_m_per_s).

        path: of the file; unknown numbers are left empty. Raises ep.FileError.
        """
        write_csv(path, self._columns(), UNITS)

    def to_xarray(self) -> Dataset:
        """The same as an xarray.Dataset over time (middle of each frame, s), object and, of vectors, axis (x, y, z) or side of
        the box (length, width, height); NaN where a frame does not have an object.

        Variables are the fields of this class, `frame` a coordinate beside time; units stand in `attrs["units"]`. Needs xarray,
        raises ModuleNotFoundError without it.
        """
        from .arrays import truth_dataset

        return truth_dataset(self)

    def plot(self, view: Literal["radar", "world"] = "radar", *, ax: Axes | None = None, title: str = "") -> Axes:
        """Draws the box of each object from above, dashed where the radar sees nothing of it, and an arrow along its way of a
        second over ground.

        view: in the axes of the "radar", as `frame.detections.plot("above")` is, or of the "world"
        ax: Matplotlib axes to draw in, None: new ones; title: "": that of axes with a title, else how many objects
        Returns the axes: metres to the left across, left positive, and ahead up. Raises ValueError for another view,
        and for axes that hold a picture which is none from above.
        """
        from ..plots import draw_truth

        return draw_truth(self, view=view, ax=ax, title=title)

    def to_records(self) -> np.ndarray:
        """The rows as a structured array [N] whose fields are those of this class, names as UTF-8 of a fixed number of bytes:
        what .npy files and tables of HDF5 hold. `from_records` reads it."""
        encoded = np.char.encode(self.name.astype(str), "utf-8") if len(self.name) else np.zeros(0, "S1")
        values = {field: encoded if field == "name" else getattr(self, field) for field in _fields()}
        records = np.zeros(len(self), [(field, array.dtype, array.shape[1:]) for field, array in values.items()])
        for field, array in values.items():
            records[field] = array
        return records

    @staticmethod
    def from_records(records: np.ndarray) -> Truth:
        """The Truth of what `to_records` gave.

        records: structured array [N]. Raises ValueError for other fields.
        """
        names = records.dtype.names if isinstance(records, np.ndarray) else None
        if names is None or set(names) != set(_fields()):
            raise refused(ValueError, "records", "a structured array as Truth.to_records makes it", records)
        columns = {field: np.array(records[field]) for field in _fields()}
        columns["name"] = np.array([name.decode("utf-8") for name in columns["name"].tolist()], dtype=str)
        return Truth(**columns)

    def _corners(self, centres, rotations) -> np.ndarray:
        return centres[:, None] + np.einsum("nij,nkj->nki", rotations, _SIGNS * self.size[:, None])

    def _where(self, chosen) -> Truth:
        rows = np.flatnonzero(chosen)  # few of many as a rule: a mask would be gone through for each field
        return Truth(**{field: getattr(self, field)[rows] for field in _fields()})

    def _columns(self) -> dict:
        """{column: values [N]} of the table."""
        found = {}
        for name, field in FIELDS.items():
            flat = getattr(self, name).reshape(len(self), len(field.columns))
            found |= {column: flat[:, index] for index, column in enumerate(field.columns)}
        return found

    def __eq__(self, other) -> bool:
        return has_same_fields(self, other) if isinstance(other, Truth) else NotImplemented

    __hash__ = None

    def __len__(self) -> int:
        return len(self.name)

    def __repr__(self) -> str:
        names = list(dict.fromkeys(self.name.tolist()))
        shown = ", ".join(names[:8]) + (", ..." if len(names) > 8 else "")
        frames = counted(len(np.unique(self.frame)), "frame")
        return f"Truth({counted(len(self), 'row')}, {frames}, {counted(len(names), 'object')}: {shown})"


def _fields() -> list[str]:
    return [field.name for field in dataclasses.fields(Truth)]
