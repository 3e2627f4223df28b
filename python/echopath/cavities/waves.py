"""What a cavity sends back: the incident wave in its mouth, the currents on its walls, and what these send through the mouth.

Kirchhoff: the mouth has the incident wave as it would be without the body. Its equivalent currents light the walls, on which
the equation of the magnetic field holds, with R from the source,
J = 2 n x H_mouth + 2 n x integral of (J x R) (jk + 1/R) e^{-jkR} / (4 pi R^2),
solved at the centres of facets. By reciprocity the reaction of J with what a wave from the receiver would send through the
mouth is the echo. Waves that the mouth turns back are left out; the way there and the way back differ by that, and their mean
is taken. Source: Obelleiro, Rodriguez and Burkholder 1995, who iterate the equation. Fields are in units of the incident
electric one, magnetic ones times 377 ohm; e^{jwt}.
"""
from __future__ import annotations

import threading

import numpy as np

from .walls import Facets

ROWS_AT_ONCE = 128
NEAR = 2.0  # sides of a facet: to nearer ones it is not one point


def cavity_field(walls: Facets, mouth: Facets, wavenumber: float, incidence, observation, transmitted, received) -> np.ndarray:
    """What the cavity adds to the echo field, complex [W], m (RadarCrossSection::field), for W waves.

    wavenumber: 1/m; incidence, observation: [W, 3], unit vectors toward the antennas; transmitted, received: [W, 3], unit
    vectors of polarisation across them. Zero where an antenna is behind the plane of the mouth.
    """
    outward = -mouth.normals[0]
    is_open = (incidence @ outward > 0.0) & (observation @ outward > 0.0)
    field = np.zeros(len(incidence), complex)
    if not is_open.any():
        return field
    incidence, observation, transmitted, received = (one[is_open] for one in (incidence, observation, transmitted, received))
    first, second = axes_across(walls.normals)
    ends = [(toward, *currents_of_mouth(mouth, toward, polarization))
            for toward, polarization in ((incidence, transmitted), (observation, received))]
    lit = [_along(first, second, magnetic_field_at(walls.centres, mouth, wavenumber, *end)) for end in ends]
    seen = [_along(first, second, magnetic_field_at(walls.centres, mouth, wavenumber, toward, -magnetic, electric))
            for toward, electric, magnetic in ends]  # the electric field, by duality
    excited = 2.0 * np.concatenate([np.concatenate([-across, along]) for along, across in lit], axis=1)
    solved = _solved(_equation(walls, first, second, wavenumber), excited).reshape(2, len(walls), 2, -1)
    weights = -1j * wavenumber / (4.0 * np.pi) * walls.areas
    there, back = (sum(weights @ (solved[axis, :, end] * seen[1 - end][axis]) for axis in range(2)) for end in range(2))
    field[is_open] = 0.5 * (there + back)
    return field


def _solved(matrix, excited) -> np.ndarray:
    """numpy.linalg.solve, in a thread: it hears no Ctrl-C, but whoever waits for it does. Python itself ends with it, no sooner:
    a library that is left while it works crashes."""
    from concurrent.futures import Future  # some 10 ms, which no other start of the package takes

    found = Future()

    def solve():
        try:
            found.set_result(np.linalg.solve(matrix, excited))
        except Exception as error:
            found.set_exception(error)

    threading.Thread(target=solve).start()
    return found.result()


def _along(first, second, fields) -> tuple[np.ndarray, np.ndarray]:
    """Components [N, W] of fields [N, W, 3] along both axes [N, 3]."""
    return np.einsum("nx,nwx->nw", first, fields), np.einsum("nx,nwx->nw", second, fields)


def axes_across(normals) -> tuple[np.ndarray, np.ndarray]:
    """Unit vectors [N, 3] that make a right-handed system with unit normals [N, 3]: first x second = normal."""
    steepest = np.eye(3)[np.abs(normals).argmin(axis=1)]
    first = np.cross(steepest, normals)
    first /= np.linalg.norm(first, axis=1)[:, None]
    return first, np.cross(normals, first)


def currents_of_mouth(mouth: Facets, toward, polarization) -> tuple[np.ndarray, np.ndarray]:
    """Electric and magnetic currents [W, 3] by which plane waves from directions [W, 3] enter at the mouth, without phases."""
    normal = mouth.normals[0]
    return np.cross(normal, np.cross(-toward, polarization)), -np.cross(normal, polarization)


def magnetic_field_at(points, mouth: Facets, wavenumber, toward, electric, magnetic) -> np.ndarray:
    """[N, W, 3] at points [N, 3], of currents [W, 3] in the mouth with the phases of plane waves from directions [W, 3]."""
    wave = mouth.areas[:, None] * np.exp(1j * wavenumber * mouth.centres @ toward.T)
    found = np.empty((len(points), len(toward), 3), complex)
    for begin in range(0, len(points), ROWS_AT_ONCE):
        away, distance = _away(points[begin:begin + ROWS_AT_ONCE], mouth.centres)
        unit, x = away / distance[..., None], 1.0 / (wavenumber * distance)
        wavelet = np.exp(-1j * wavenumber * distance) / (4.0 * np.pi * distance)
        curl = wavelet * (1j * wavenumber) * (1.0 - 1j * x)
        turning = np.stack([(curl * one) @ wave for one in np.moveaxis(unit, -1, 0)], axis=-1)
        across = (wavelet * (1.0 - 1j * x - x * x)) @ wave
        along, radial = wavelet * (1.0 - 3j * x - 3.0 * x * x), np.empty((*across.shape, 3, 3), complex)
        for one, other in ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)):
            radial[..., one, other] = radial[..., other, one] = (along * (unit[..., one] * unit[..., other])) @ wave
        found[begin:begin + ROWS_AT_ONCE] = np.cross(electric, turning) - 1j * wavenumber * (
            across[..., None] * magnetic - np.einsum("nwxy,wy->nwx", radial, magnetic))
    return found


def _equation(walls: Facets, first, second, wavenumber) -> np.ndarray:
    """The matrix [2N, 2N] of the components of J along both axes."""
    count = len(walls)
    matrix = np.eye(2 * count, dtype=complex)
    for begin in range(0, count, ROWS_AT_ONCE):
        rows = np.arange(begin, min(begin + ROWS_AT_ONCE, count))
        waves = _wavelets(walls, rows, wavenumber)
        for column, source in enumerate((first, second)):
            field = np.cross(source, waves)  # first . (n x H) = -second . H, second . (n x H) = first . H
            columns = slice(column * count, (column + 1) * count)
            matrix[rows, columns] += 2.0 * np.einsum("nx,nmx->nm", second[rows], field)
            matrix[count + rows, columns] -= 2.0 * np.einsum("nx,nmx->nm", first[rows], field)
    return matrix


def _wavelets(walls: Facets, rows, wavenumber) -> np.ndarray:
    """[R, N, 3]: at some facets, the integral over each of R (jk + 1/R) e^{-jkR} / (4 pi R^2), by pieces where it is near."""
    away, distance = _away(walls.centres[rows], walls.centres)
    distance[np.arange(len(rows)), rows] = np.inf  # a flat facet has no magnetic field along itself
    found = _strength(distance, wavenumber, walls.areas)[..., None] * away
    row, facet = np.nonzero(distance < NEAR * walls.side)
    counts = walls.first_piece[facet + 1] - walls.first_piece[facet]
    begins = np.concatenate([[0], np.cumsum(counts)])[:-1]
    piece = np.arange(counts.sum()) + np.repeat(walls.first_piece[facet] - begins, counts)
    from_pieces = walls.centres[rows[np.repeat(row, counts)]] - walls.pieces[piece]
    parts = _strength(np.linalg.norm(from_pieces, axis=1), wavenumber, walls.areas_of_pieces[piece])[:, None] * from_pieces
    if len(facet):
        found[row, facet] = np.add.reduceat(parts, begins)
    return found


def _strength(distance, wavenumber, areas) -> np.ndarray:
    """areas (jk + 1/R) e^{-jkR} / (4 pi R^2) at distances R in m; zero at an infinite one."""
    phase = wavenumber * np.where(np.isinf(distance), 0.0, distance)
    return areas * (1j * wavenumber + 1.0 / distance) / (4.0 * np.pi * distance ** 2) * np.exp(-1j * phase)


def _away(points, sources) -> tuple[np.ndarray, np.ndarray]:
    """Vectors [N, M, 3] from sources [M, 3] to points [N, 3], and their lengths [N, M], m."""
    away = points[:, None] - sources
    return away, np.linalg.norm(away, axis=2)
