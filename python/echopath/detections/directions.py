"""Where the echoes of detected cells come from."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..spectra.angles import estimate_angles


def toward(azimuth, elevation):
    """Unit vectors [D, 3] of directions [D] in rad."""
    level = np.cos(elevation)
    return np.stack([level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation)], axis=-1)


def directions_of(spectrum, radar, cells, velocity, settings: dict, progress) -> dict:
    """Directions of the echoes in cells [N, 2], at least one for each cell.

    velocity: [N] m/s, of the echoes, which may lie beside the middles of their cells; settings: keywords of `estimate_angles`
    Returns index [D] of the cell, azimuth, elevation [D] in rad (NaN where the antennas cannot tell), fold [D] m/s, to be
    added to the velocity, power [D] W, NaN where no beams were made.
    """
    array = _core.virtual_array(radar)
    count = len(cells)
    unknown = {"index": np.arange(count), "azimuth": np.full(count, np.nan), "elevation": np.full(count, np.nan),
               "fold": np.zeros(count), "power": np.full(count, np.nan)}
    if count == 0 or not (array.tells_azimuths or array.tells_elevations):
        return unknown
    if settings.get("compensate", True):
        spectrum = _turned(spectrum, radar, cells, velocity - spectrum.velocity[cells[:, 0]])
    found = estimate_angles(spectrum, radar, cells=cells, progress=progress, **settings)
    sees = {"azimuth": array.tells_azimuths, "elevation": array.tells_elevations}
    known = {"index": found.cell, "fold": found.velocity - spectrum.velocity[cells[found.cell, 0]], "power": found.power}
    known |= {name: getattr(found, name) if seen else np.full(len(found), np.nan) for name, seen in sees.items()}
    return _with_the_rest(known, unknown)


def _turned(spectrum, radar, cells, faster):
    """The map with that phase taken out of cells [N, 2] which echoes faster [N] m/s than the cells add between transmit slots.

    Angles go by the velocity in the middle of a cell. What is left from slot to slot, at the edge of a cell half a turn over the
    number of all slots of the frame, looks like a direction.
    """
    if radar.multiplexing != "tdm" or len(radar.transmitters) == 1:
        return spectrum
    start = np.arange(len(radar.transmitters)) * radar.waveform.mean_interval  # s, of the slots
    state = spectrum.__getstate__()
    values = state["values"].reshape(spectrum.values.shape)
    doppler = 2.0 * faster / radar.waveform.wavelength  # Hz
    values[:, :, cells[:, 0], cells[:, 1]] *= np.exp(-2j * np.pi * np.outer(start, doppler))[:, None]
    turned = _core.RangeDoppler.__new__(_core.RangeDoppler)
    turned.__setstate__(state)
    return turned


def _with_the_rest(known: dict, unknown: dict) -> dict:
    """Cells in which no beam has power keep their place."""
    rest = np.setdiff1d(unknown["index"], known["index"])
    joined = {name: np.concatenate([known[name], unknown[name][rest]]) for name in unknown}
    order = np.argsort(joined["index"], kind="stable")
    return {name: values[order] for name, values in joined.items()}
