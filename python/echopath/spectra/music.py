"""Directions closer than a beam, by the space of the noise (MUSIC; Schmidt 1986)."""
from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..arguments.checks import ArrayLike, array, checked, count, flag
from .one_polarisation import warn_of_mixed_polarisations

_CELLS = array("[N, 2]", kind="whole")
_DIRECTIONS = array("[A]", finite=True)
MIRROR_TOLERANCE = 0.02  # wavelengths, as beams have it


@checked(azimuth=_DIRECTIONS, cells=_CELLS, num_sources=count(1, 64), forward_backward=flag)
def music(spectrum: _core.RangeDoppler, radar: _core.Radar, azimuth: ArrayLike, *, cells: ArrayLike, num_sources: int = 2,
          velocity_neighbours: int = 1, range_neighbours: int = 2, forward_backward: bool = False) -> NDArray[np.float64]:
    """Pseudo-spectrum over azimuth of some cells: high where a plane wave has no share in the space of the noise.

    The covariance of the channels over a cell and its neighbours has num_sources eigenvectors of signals; the value is
    |a|^2 over the squared length of a in the space of the others, a the steering vector of a direction in the xy-plane. Echoes
    of one phase law in all of these cells count as one source, where `forward_backward` may part two. The phase between
    transmit slots is that of the cell's velocity in all of them.
    spectrum: RangeDoppler with values [tx, rx, velocity, range] of that radar; radar: that of the spectrum
    azimuth: [A] rad in the radar's frame, left positive; cells: [N, 2] (velocity, range) indices
    num_sources: 1 to 64, fewer than channels; velocity_neighbours, range_neighbours: cells on each side, 0 to 64
    forward_backward: also average the covariance of the mirrored array (symmetric arrays)
    Returns [N, A], linear, at least 1. Raises TypeError, ValueError or IndexError naming the argument.
    """
    warn_of_mixed_polarisations(radar, "music")
    _core.beamform(spectrum, radar, [0.0], [0.0], cells=np.empty((0, 2), np.int64))  # of no cell: checks that they fit
    values = _core.compensate_tdm(spectrum, radar, 0).values if not spectrum.is_tdm_compensated else spectrum.values
    values = values.reshape(-1, *values.shape[2:])
    if num_sources >= len(values):
        raise ValueError(f"num_sources: must be fewer than the {len(values)} channels, got {num_sources}")
    _check_cells(cells, values.shape[1:])
    virtual = _core.virtual_array(radar)
    places = virtual.positions.reshape(-1, 3)
    opposite = _opposite_channels(places - virtual.centre, virtual.wavelength) if forward_backward else None
    wavenumber = 2.0 * np.pi / radar.waveform.wavelength
    toward = np.stack([np.cos(azimuth), np.sin(azimuth), np.zeros(len(azimuth))])
    steering = np.exp(-1j * wavenumber * places @ toward)
    found = []
    for velocity, distance in cells.tolist():  # numbers of Python: unsigned ones know nothing below 0
        rows = np.arange(velocity - velocity_neighbours, velocity + velocity_neighbours + 1) % values.shape[1]
        columns = np.arange(max(0, distance - range_neighbours), min(values.shape[2], distance + range_neighbours + 1))
        faster = spectrum.velocity[rows] - spectrum.velocity[velocity]  # than the echo of the cell, which lies in them, too
        turn = np.repeat(np.conj(_core.slot_phasors(radar, faster)), len(radar.receivers), axis=0)
        found.append(_pseudo_spectrum(values[:, rows][:, :, columns] * turn[..., None], steering, num_sources, opposite))
    return np.array(found).reshape(len(cells), len(azimuth))


def _check_cells(cells, shape) -> None:
    wrong = [tuple(map(int, cell)) for cell in cells if not all(0 <= index < size for index, size in zip(cell, shape))]
    if wrong:
        raise IndexError(f"cells: must lie within the {shape} cells of the map, got {wrong[0]}")


def _opposite_channels(places, wavelength: float) -> np.ndarray:
    """[channel] index of the channel at the opposite point of a symmetric array; raises ValueError for another.

    places: [channel, 3] and wavelength in m, from the array's centre
    """
    away = np.linalg.norm(places[:, None] + places, axis=-1)
    if away.min(axis=1).max() > MIRROR_TOLERANCE * wavelength:
        raise ValueError("forward_backward: needs an array that is symmetric about its centre, got one that is not")
    return away.argmin(axis=1)


def _pseudo_spectrum(snapshots, steering, num_sources: int, opposite) -> np.ndarray:
    """snapshots: [channel, ...]; steering: [channel, A]; opposite: [channel] index of a channel, or None"""
    vectors = snapshots.reshape(len(snapshots), -1)
    covariance = vectors @ np.conj(vectors.T)
    if opposite is not None:
        covariance = covariance + np.conj(covariance[np.ix_(opposite, opposite)])
    noise = np.linalg.eigh(covariance)[1][:, :-num_sources]
    rest = np.sum(np.abs(np.conj(noise.T) @ steering) ** 2, axis=0)
    return len(steering) / np.maximum(rest, np.finfo(float).tiny)
