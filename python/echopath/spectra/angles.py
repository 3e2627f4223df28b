"""Angles of arrival: the virtual array, beams and spectra over it, and the directions of echoes."""
from __future__ import annotations

from typing import Literal

import numpy as np

from .. import _core
from ..arguments.checks import (
    COMMON,
    LARGEST_COUNT,
    ArrayLike,
    Progress,
    Window,
    array,
    checked,
    count,
    flag,
    one_of,
    optional,
    real,
    refused,
    window as window_rule,
)
from ..arguments.gates import gate
from ..base.radar.velocities import turns_look_like_directions
from .one_polarisation import warn_of_mixed_polarisations

BeamMethod = Literal["bartlett", "capon"]
Overlaps = Literal["average", "first"]
Combine = Literal["sum", "peak"]

ROUNDING = 1e-9  # of a cell of velocity, at the end of the axis

_ANGLES = optional(array("[]", "[N]"))
_CELLS = array("[N, 2]", kind="whole")
_OF_CELLS = optional(array("[N]", finite=True))
_BEAM_RULES = {
    "azimuth": _ANGLES, "elevation": _ANGLES, "method": one_of(BeamMethod), "overlaps": one_of(Overlaps), "compensate": flag,
    "diagonal_loading": real(1e-9, 1e3), "forward_backward": flag, "window": window_rule}
MAP_RULES = {**COMMON, **_BEAM_RULES, "velocity": optional(real(unit="m/s")), "combine": one_of(Combine),
             "velocity_gate": gate}  # of `range_azimuth`


@checked()
def virtual_array(radar: _core.Radar) -> _core.VirtualArray:
    """The virtual array of a radar's transmitters and receivers.

    Each pair receives the phase of one antenna at the sum of both positions, in m in the radar's frame: a far point at rest along
    the unit vector u has e^{-j 2 pi u . position / wavelength} in its cell of a range-Doppler map. Positions closer than
    0.01 wavelengths are one element (an overlap). Equal steps along a line, or along two perpendicular axes of a plane, are
    found as a grid, from a fifth of a wavelength on; its points without an element are gaps.
    radar: whose antennas count
    Returns a VirtualArray with positions [tx, rx, 3] in m. Raises TypeError naming the argument.
    """
    return _core.virtual_array(radar)


@checked(fold=count(-1000, 1000))
def compensate_tdm(spectrum: _core.RangeDoppler, radar: _core.Radar, fold: int = 0) -> _core.RangeDoppler:
    """A map without the phase that motion adds between transmit slots (TDM).

    Transmitter m sends a time t_m after the first, m chirp intervals and what extra_idle adds in the mean: a cell of velocity v
    (receding positive) is turned by e^{j 2 pi (2 v / wavelength) t_m}. M transmitters divide the unambiguous velocity by M;
    an echo of v + 2 fold v_max, with v_max = waveform.max_velocity(M), appears at v and needs its `fold`. Where transmitters
    have carriers of their own (frequency_steps and bandwidth_steps that repeat with them), the phase that the delay of a
    cell's range makes of the difference is taken out, too: an echo between two cells keeps up to pi f / bandwidth of it, with a
    carrier f above the first one, by which maps of angles show it aside (`estimate_angles` takes its `range`).
    spectrum: RangeDoppler of that radar, with values [tx, rx, velocity, range]
    radar: that of the spectrum
    fold: whole number; the velocities of the result are those assumed, v + 2 fold v_max in m/s
    Returns a RangeDoppler. The functions of angles do this themselves unless it is done. Raises TypeError or ValueError
    naming the argument.
    """
    return _core.compensate_tdm(spectrum, radar, fold)


@checked(overlaps=one_of(Overlaps), compensate=flag, window=window_rule)
def angle_fft(spectrum: _core.RangeDoppler, radar: _core.Radar, *, window: Window = "hann", zero_pad: int = 4,
              overlaps: Overlaps = "average", compensate: bool = True, progress: Progress = None) -> _core.AngleSpectrum:
    """Angle spectra of a uniform array: a Fourier transform over its rows and columns.

    spectrum: RangeDoppler with values [tx, rx, velocity, range] of that radar
    radar: that of the spectrum
    window: as in `range_doppler`, over rows and columns; here symmetric and nowhere zero
    zero_pad: 1 to 64, transforms of so many times the rows and columns
    overlaps: "average" of channels at one position, or the "first" of them; gaps count as zeros
    compensate: take out the phase between transmit slots (`compensate_tdm`)
    progress: callable (stage, fraction), True for bars, or None
    Returns an AngleSpectrum with values [elevation, azimuth, velocity, range] in sqrt(W). |value|^2 of a far point at its
    direction is its received power in W, averaged over channels; noise falls to 1/N for N elements without a window.
    Raises TypeError or ValueError naming the argument, also where the array is no grid of equal steps (`beamform` takes any)
    or the map is not the radar's.
    """
    warn_of_mixed_polarisations(radar, "angle_fft")
    return _core.angle_fft(spectrum, radar, window=window, zero_pad=zero_pad, overlaps=overlaps, compensate=compensate,
                           progress=progress)


@checked(**_BEAM_RULES, cells=optional(_CELLS))
def beamform(spectrum: _core.RangeDoppler, radar: _core.Radar, azimuth: ArrayLike | None = None,
             elevation: ArrayLike | None = 0.0, *, cells: ArrayLike | None = None, method: BeamMethod = "bartlett",
             window: Window = "rect", overlaps: Overlaps = "average", compensate: bool = True, diagonal_loading: float = 0.01,
             velocity_neighbours: int = 1, range_neighbours: int = 2, forward_backward: bool = False,
             progress: Progress = None) -> _core.BeamPower:
    """Power that beams toward a grid of directions pass, for any array.

    Steering vectors are plane waves at the exact element positions and the wavelength at the centre frequency. An echo from
    the steered direction passes unchanged: a far point gives its received power in W, averaged over channels.
    spectrum: RangeDoppler with values [tx, rx, velocity, range] of that radar
    radar: that of the spectrum
    azimuth: [A] or one in rad, ascending, in the radar's frame from +x to the left, -2 pi to 2 pi; None: those the array
        tells apart about where its antennas look (`VirtualArray.default_angles`)
    elevation: [E] or one in rad, up from the xy-plane; None likewise, at most 45 degrees up and down
    cells: [N, 2] (velocity, range) indices, or None: all
    method: "bartlett" (delay and sum) or "capon" (minimum variance: the weights that pass the least power from elsewhere;
        resolves echoes of different velocity or range within a beam; its peaks may be narrower than steps of the grid, and
        its powers are low, as it takes what noise adds to an echo for another one: of 12 channels by 3 to 6 dB at a ratio of
        30 dB in each, by 10 to 20 dB at 10 dB, with a diagonal_loading of 1 by less than 1 and 2 to 5 dB. Echoes of one
        velocity and range are one source to it and cancel each other: of two balls at rest, 20 m away and 10 degrees apart,
        it has 36 dB less than bartlett in 16 channels, with forward_backward 8 to 13 dB less)
    window: of bartlett, as in `angle_fft`; other than "rect" for grids of equal steps only
    overlaps: "average" of channels at one position, or the "first" of them
    compensate: take out the phase between transmit slots (`compensate_tdm`)
    diagonal_loading: of capon, added to the covariance relative to the mean power of the elements, 1e-9 to 1e3
    velocity_neighbours, range_neighbours: of capon, cells on each side whose vectors make the covariance, 0 to 64; the phase
        between transmit slots is that of the cell's velocity in all of them
    forward_backward: of capon, also average the covariance of the mirrored array (symmetric arrays)
    progress: callable (stage, fraction), True for bars, or None
    Returns a BeamPower with power [elevation, azimuth, velocity, range] in W, of cells [elevation, azimuth, cell].
    Raises TypeError, ValueError or IndexError naming the argument.
    """
    warn_of_mixed_polarisations(radar, "beamform")
    return _core.beamform(spectrum, radar, azimuth, elevation, cells=cells, method=method, window=window, overlaps=overlaps,
                          compensate=compensate, diagonal_loading=diagonal_loading, velocity_neighbours=velocity_neighbours,
                          range_neighbours=range_neighbours, forward_backward=forward_backward, progress=progress)


@checked(**MAP_RULES)
def range_azimuth(spectrum: _core.RangeDoppler, radar: _core.Radar, azimuth: ArrayLike | None = None,
                  elevation: ArrayLike | None = 0.0, *, velocity: float | None = None, combine: Combine = "sum",
                  velocity_gate: ArrayLike | None = None, method: BeamMethod = "bartlett", window: Window = "rect",
                  overlaps: Overlaps = "average", compensate: bool = True, diagonal_loading: float = 0.01,
                  velocity_neighbours: int = 1, range_neighbours: int = 2, forward_backward: bool = False,
                  progress: Progress = None) -> _core.RangeAzimuth:
    """Received power by range and azimuth.

    spectrum: RangeDoppler with values [tx, rx, velocity, range] of that radar
    radar: that of the spectrum
    azimuth: [A] or one in rad, ascending, in the radar's frame from +x to the left, -2 pi to 2 pi; None: those the array
        tells apart about where its antennas look (`VirtualArray.default_angles`)
    elevation: [E] or one in rad: the largest power over them is taken; None: those the array tells apart
    velocity: m/s, of the cells to take; None: all velocities. Nearer to the end of the axis than to its last cell it is that of
        the first one, to which it folds
    combine: of all velocities, their "sum", or "peak", the largest of them. A point gives its received power in W in every
        case, points of several velocities the sum or the largest. Noise of the sum is that of one chirp, noise of the peak
        about ln(num_chirps) times that of a cell.
    velocity_gate: (lowest, highest) in m/s of "all velocities", as the map has them; None: those of the map
    method, window, overlaps, compensate, diagonal_loading, velocity_neighbours, range_neighbours, forward_backward: of the
        beams, as in `beamform`
    progress: callable (stage, fraction), True for bars, or None
    Returns a RangeAzimuth with power [azimuth, range] in W. Raises TypeError or ValueError naming the argument. Warns
    (RuntimeWarning) where the antennas tell no azimuths apart.
    """
    warn_of_mixed_polarisations(radar, "range_azimuth")
    if velocity is not None:
        spectrum, velocity = _folded_to_first(spectrum, radar, velocity, compensate)
    return _core.range_azimuth(spectrum, radar, azimuth, elevation, velocity=velocity, combine=combine,
                               velocity_gate=velocity_gate, method=method, window=window, overlaps=overlaps,
                               compensate=compensate, diagonal_loading=diagonal_loading,
                               velocity_neighbours=velocity_neighbours, range_neighbours=range_neighbours,
                               forward_backward=forward_backward, progress=progress)


def _folded_to_first(spectrum, radar, velocity: float, compensate: bool) -> tuple:
    """The map and the velocity in m/s that is to be taken of it: of one between the last cell and the end of the axis, but nearer
    to the end, those in which the first cell has it, with the phase between transmit slots of this velocity."""
    axis = spectrum.velocity
    step = axis[1] - axis[0] if len(axis) > 1 else np.inf
    if not 0.5 < (velocity - axis[-1]) / step <= 1.0 + ROUNDING:
        return spectrum, velocity
    if compensate and not spectrum.is_tdm_compensated:
        return _core.compensate_tdm(spectrum, radar, 1), velocity
    return spectrum, velocity - len(axis) * step


@checked(**_BEAM_RULES, cells=_CELLS, velocity=_OF_CELLS, range=_OF_CELLS, peak_range_db=real(0.0, 200.0, unit="dB"),
         folds=count(0, LARGEST_COUNT))
def estimate_angles(spectrum: _core.RangeDoppler, radar: _core.Radar, azimuth: ArrayLike | None = None,
                    elevation: ArrayLike | None = None, *, cells: ArrayLike, velocity: ArrayLike | None = None,
                    range: ArrayLike | None = None, max_peaks: int = 1, peak_range_db: float = 10.0, folds: int = 0,
                    method: BeamMethod = "bartlett", window: Window = "rect", overlaps: Overlaps = "average",
                    compensate: bool = True, diagonal_loading: float = 0.01, velocity_neighbours: int = 1,
                    range_neighbours: int = 2, forward_backward: bool = False,
                    progress: Progress = None) -> _core.AngleEstimates:
    """Where the echoes of chosen cells come from: peaks of beam power, finer than the grid.

    spectrum: RangeDoppler with values [tx, rx, velocity, range] of that radar
    radar: that of the spectrum
    azimuth: [A] or one in rad, ascending, -2 pi to 2 pi, where to search; None: what the array tells apart about where its
        antennas look (`VirtualArray.default_angles`), a quarter of a beam each
    elevation: [E] or one in rad; None likewise, at most 45 degrees up and down: what is higher is given a direction at that
        end, unless this reaches it; 0 alone for an array without vertical extent
    cells: [N, 2] (velocity, range) indices
    velocity: [N] in m/s of the echoes in these cells, by which the phase between transmit slots is taken out, None: that of the
        middles of the cells, which is off by up to half a cell: by half a turn over the frame's number of chirps
    range: [N] in m of the echoes in these cells as the map shows them, by which the phases of transmitters with carriers of their
        own (`frequency_steps`, "tdm") are taken out, None: that of the middles of the cells, which is off by up to half a cell
    max_peaks: of a cell, the strongest, one of each beam
    peak_range_db: dB below the strongest of the cell, within which others count
    folds: K tries the velocities v + 2 k v_max, |k| <= K, and takes the one with the strongest peak, which transmit slots
        tell apart ("tdm"); less than half the number of transmitters. Those that stand in even steps, in the order of their
        turns, where receivers have no extent, as a column beside a row of receivers, or so many of which along their line that
        a turn of the map is a beam of the array, tell none: a fold looks like another direction, unless one is given here;
        another order of the transmitters tells them
    method, window, overlaps, compensate, diagonal_loading, velocity_neighbours, range_neighbours, forward_backward: of the
        beams, as in `beamform`
    progress: callable (stage, fraction), True for bars, or None
    Returns AngleEstimates, arrays [M], azimuths within +-pi: none for a cell without power. Raises TypeError, ValueError or
    IndexError naming the argument.
    """
    warn_of_mixed_polarisations(radar, "estimate_angles")
    if azimuth is None and elevation is None:
        require_told_folds(radar, folds)
    return _core.estimate_angles(spectrum, radar, azimuth, elevation, cells=cells, velocity=velocity, range=range,
                                 max_peaks=max_peaks, peak_range_db=peak_range_db, folds=folds, method=method, window=window,
                                 overlaps=overlaps, compensate=compensate, diagonal_loading=diagonal_loading,
                                 velocity_neighbours=velocity_neighbours, range_neighbours=range_neighbours,
                                 forward_backward=forward_backward, progress=progress)


def require_told_folds(radar: _core.Radar, folds: int) -> None:
    """Raises ValueError for folds where they look like other directions."""
    in_turns = radar.multiplexing == "tdm" and 0 < 2 * folds < len(radar.transmitters)
    if in_turns and turns_look_like_directions(radar):
        raise refused(ValueError, "folds", "0 where transmitters stand in even steps in the order of their turns, across the "
                      "line of the receivers or many of them along it: a fold looks like another direction, and another order "
                      "of the transmitters tells them apart", folds)
