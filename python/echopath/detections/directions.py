"""Where the echoes of detected cells come from."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..spectra.angles import estimate_angles


def toward(azimuth, elevation):
    """Unit vectors [D, 3] of directions [D] in rad."""
    level = np.cos(elevation)
    return np.stack([level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation)], axis=-1)


def directions_of(spectrum, radar, peaks: dict, settings: dict, progress) -> dict:
    """Directions of the echoes in cells, at least one for each cell.

    peaks: cells [N, 2], with velocity [N] in m/s and range [N] in m of the echoes, which may lie beside the middles of their
        cells; settings: keywords of `estimate_angles`
    Returns index [D] of the cell, azimuth, elevation [D] in rad (NaN where the antennas cannot tell), fold [D] m/s, to be
    added to the velocity, power [D] W, NaN where no beams were made.
    """
    array = _core.virtual_array(radar)
    cells, velocity = peaks["cells"], peaks["velocity"]
    count = len(cells)
    unknown = {"index": np.arange(count), "azimuth": np.full(count, np.nan), "elevation": np.full(count, np.nan),
               "fold": np.zeros(count), "power": np.full(count, np.nan)}
    if count == 0 or not (array.tells_azimuths or array.tells_elevations):
        return unknown
    found = estimate_angles(spectrum, radar, cells=cells, velocity=velocity, range=peaks["range"], progress=progress, **settings)
    sees = {"azimuth": array.tells_azimuths, "elevation": array.tells_elevations}
    known = {"index": found.cell, "fold": found.velocity - velocity[found.cell], "power": found.power}
    known |= {name: getattr(found, name) if seen else np.full(len(found), np.nan) for name, seen in sees.items()}
    return _with_the_rest(known, unknown)


def _with_the_rest(known: dict, unknown: dict) -> dict:
    """Cells in which no beam has power keep their place."""
    rest = np.setdiff1d(unknown["index"], known["index"])
    joined = {name: np.concatenate([known[name], unknown[name][rest]]) for name in unknown}
    order = np.argsort(joined["index"], kind="stable")
    return {name: values[order] for name, values in joined.items()}
