"""Antenna patterns from files."""
from __future__ import annotations

import os
from pathlib import Path
from typing import Literal

from ... import _core
from ...arguments.checks import checked, flag, one_of, optional
from ...arguments.shown import refused
from ...base.storage.files import bytes_of
from .boresight import AXES, turned
from .cuts import are_cuts, pattern_of_cuts
from .grids import read_grid

Axis = Literal["x", "y", "z"]


@checked(normalize=flag, boresight=optional(one_of(Axis)))
def load_antenna(path: str | os.PathLike[str], *, normalize: bool = False,
                 boresight: Axis | None = None) -> _core.AntennaPattern:
    """Reads an antenna pattern from a file: our own, one that a field solver wrote, or two cuts.

    path: of a text file of one of these kinds, which its lines tell:
        a table: a line of column names and then a line for each direction, in any order, with commas, semicolons, tabs or
        blanks between. Two columns are angles, azimuth_deg and elevation_deg in the antenna's frame (boresight +x, azimuth
        about z to the left, elevation from the xy-plane) or theta_deg and phi_deg of the file's own axes (theta from its z, phi
        from its x to its y), one is gain_db over isotropic ("-inf": none), and phase_deg may be one. Every value of the
        one angle needs every value of the other. Lines that begin with # are passed over. The names that HFSS, CST and FEKO
        give to angles and to the whole gain are known, and what else these write is passed over: no phases are read from them.
        Directivity is taken for gain, with a mean of 1 at most;
        cuts of Planet (.msi, .pln): GAIN, HORIZONTAL and VERTICAL. The gain between the
        cuts is interpolated; it is exact in both planes
    normalize: True scales the gain to a mean of 1 over the sphere, as of an antenna without losses
    boresight: the axis of a file over theta and phi along which the antenna looks, None: "z". The next axis (after z comes x)
        is then the antenna's left, and the one after it is up
    Returns an AntennaPattern as `GainTable` makes it. Raises FileError naming the file, and the line if there is one, and
    ValueError where a boresight is given to a file that has its own. Warns (RuntimeWarning) where most of the power goes more
    than 45 degrees off the boresight.
    """
    path = Path(path)
    lines = _text_of(path).splitlines()
    try:
        grid = None if are_cuts(lines) else read_grid(lines)
        if grid is not None and grid.is_spherical:
            return turned(grid, AXES[boresight or "z"], normalize)
        found = grid.table(normalize) if grid is not None else pattern_of_cuts(lines, normalize)
    except ValueError as error:
        raise _core.FileError(f"{path}: {error}") from None
    if boresight is not None:
        raise refused(ValueError, "boresight", f"left out for {path}, whose angles count from the boresight", boresight)
    return found


def _text_of(path: Path) -> str:
    """With a byte-order mark or without. Names of makers and comments may be of an older encoding; what counts is ASCII."""
    content = bytes_of(path)
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        if b"\0" in content:
            raise _core.FileError(f"{path}: is not UTF-8 text (byte {error.start})") from None
        return content.decode("latin-1")
