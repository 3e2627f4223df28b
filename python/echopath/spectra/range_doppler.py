"""Range-Doppler maps of cubes, and the cells that stand out of their noise."""
from __future__ import annotations

from typing import Literal

import numpy as np

from .. import _core
from ..arguments.checks import (
    LARGEST_COUNT,
    ArrayLike,
    MapWindow,
    Progress,
    checked,
    count,
    flag,
    one_of,
    optional,
    real,
    refused,
)
from ..arguments.settings import SignalSettings
from ..transmit.code import is_coded, signal_shape
from .noise_shape import noise_shape

CfarMethod = Literal["ca", "os", "go", "so"]
_CELLS = optional(count(0, LARGEST_COUNT))

# Of `cfar` and of what detects by it.
CFAR_RULES = {"method": one_of(CfarMethod), "false_alarm_rate": real(1e-15, 0.5), "guard_velocity": _CELLS,
              "guard_range": _CELLS, "training_velocity": _CELLS, "training_range": _CELLS,
              "rank": real(above=0.0, high=1.0), "beams": flag}
FALSE_ALARM_RATE, RANK = 1e-6, 0.75


@checked()
def range_doppler(cube: ArrayLike, radar: _core.Radar, window: MapWindow = SignalSettings.window,
                  zero_pad: int = SignalSettings.zero_pad) -> _core.RangeDoppler:
    """Range-Doppler maps of a cube, calibrated so that |value|^2 of a peak is received power in W.

    cube: [tx, rx, chirp, sample] in sqrt(W), of that radar
    radar: that of the cube
    window: "rect", "hann", "hamming", "blackman", "blackman_harris", "chebyshev", "taylor", "kaiser", the last three also with
        their sidelobe level in dB, ("taylor", 30), which is 80, 35 and 60 if not given, on both axes; or a pair of these, that
        of range and that of velocity, such as ("hann", ("chebyshev", 60)). Fewer samples than it has dB may miss Taylor's
        level by up to 5 dB, fewer than a third as many by much more; Kaiser's, of the first sidelobe, is met to a dB by 48
        samples or more and to 3 dB by 16, up to 120 dB
    zero_pad: 1 to 64, transforms of so many times the samples and chirps
    Returns RangeDoppler with values [tx, rx, velocity, range]. The phase between transmit slots is left in.
    Raises TypeError or ValueError naming the argument, also where a sample is no finite number.
    """
    apart = (len(radar.transmitters), len(radar.receivers), radar.waveform.num_chirps, radar.waveform.num_samples)
    if is_coded(radar) and np.shape(cube) == signal_shape(radar) != apart:
        raise refused(ValueError, "cube", f"apart by transmitters, of the shape {apart}, as ep.demultiplex(cube, radar) gives it",
                      cube)
    found = _core.range_doppler(cube, radar, window, zero_pad)
    # A transform spreads what is no number to all cells of its channel, the first too.
    require_finite("cube", cube, found.values[:, :, 0, 0])
    return found


def require_finite(argument: str, cube: ArrayLike, told: np.ndarray) -> None:
    """Raises ValueError for a cube with what is no number. told: made of all samples, so that it is no number then either"""
    if not np.all(np.isfinite(told)):
        place = tuple(np.argwhere(~np.isfinite(cube))[0].tolist())
        raise ValueError(f"{argument}: must be finite, got {np.asarray(cube)[place]} at [tx, rx, chirp, sample] = {list(place)}")


def require_finite_samples(argument: str, cube: ArrayLike) -> None:
    """Raises ValueError for a cube with what is no number."""
    with np.errstate(invalid="ignore"):  # of infinities that take each other away
        require_finite(argument, cube, np.sum(cube))


@checked(**CFAR_RULES)
def cfar(spectrum: _core.RangeDoppler, radar: _core.Radar, *, method: CfarMethod = "ca",
         false_alarm_rate: float = FALSE_ALARM_RATE, guard_velocity: int | None = None, guard_range: int | None = None,
         training_velocity: int | None = None, training_range: int | None = None, rank: float = RANK, beams: bool = False,
         progress: Progress = None) -> _core.CfarResult:
    """Cells of a range-Doppler map that stand out of the noise about them, at a constant false-alarm rate.

    A cell is found where its power, summed over channels, exceeds what its training cells make of the rate. The threshold is
    right for the correlation that the map's window and zero padding make between neighbouring cells, and for any number of
    channels whose noise is independent. That of transmitters whose codes correlate ("cdm") is not: eight of random phases in 64
    chirps have 4 times the false alarms asked for at 1e-3, 7 times at 1e-4. Nor is that of "ddm" in maps of windows
    that have the ends of the frame: 50 times with "rect", 4 times with "taylor". Nor is it for all cells of real samples: at
    velocity 0 and at the end of the velocity axis the noise of the first cell of range is real, and one channel has some 8 times
    the false alarms asked for there at 1e-3, 200 times at 1e-6, in maps of one chirp 5 and 30 times. Other cells within the main
    lobe of range 0 have up to twice as many. Behind the filters of `radar.receiver` cells compare by their power over that of the
    noise at their range, which follows from the filters, the imbalance of the branches and, for what the converter adds, the
    quietest ranges of the map.
    Velocity is a circle; at the ends of the range axis training cells are taken from the other side.
    spectrum: RangeDoppler with values [tx, rx, velocity, range] of that radar, as its receiver gives it
    radar: that of the spectrum
    method: "ca" (cell averaging: mean of the training cells), "os" (ordered statistic: minds neighbouring targets less), "go" or
        "so": the greatest or the smallest of the means of their two halves, at nearer and farther ranges, or, without training
        cells along range, at lower and higher velocities. The greatest has fewer false alarms where clutter begins, the smallest
        finds targets beside others
    false_alarm_rate: probability that noise alone exceeds the threshold of a cell, 1e-15 to 0.5
    guard_velocity, guard_range: half widths in cells of the rectangle about a cell that tells nothing of its noise, at least
        the window's main lobe; None: just that
    training_velocity, training_range: cells beyond them on each side that do; None: 4 and 8 times zero_pad, fewer where the
        map is small
    rank: of "os", the share of the training cells that the statistic is not below, above 0 to 1
    beams: True tests each cell in beams toward all directions that the array tells apart, in steps of half a beam, instead of the
        sum of its channels. Noise and clutter are then those of the beam: an echo is found 1 dB lower with 8 channels, 2 dB with
        32 and 5 dB with 192, and clutter from other directions does not hide it. Between beams an echo loses at most 0.9 dB along
        each axis of the array. The false-alarm rate of a cell is at most the one asked for, and less since beams overlap: up to a
        fifth for filled arrays, by half for sparse rectangles; it is 1e-15 or more for each beam, of at most 131,072. For
        transmitters in turns echoes have to be within the axis of velocity, or beams spread. Takes two seconds for 192 channels,
        600 beams and 128 x 256 cells
    progress: callable (stage, fraction), True for bars, or None
    Thresholds of a design are computed once: a tenth of a second for the defaults, 3 s for 12 x 24 training cells on each
    side, other methods several times that; Ctrl-C is heard.
    Returns a CfarResult. Raises TypeError or ValueError naming the argument, also for windows of more than 2000 cells,
    counted without padding.
    """
    settings = {"method": method, "false_alarm_rate": false_alarm_rate, "rank": rank, "guard_velocity": guard_velocity,
                "guard_range": guard_range, "training_velocity": training_velocity, "training_range": training_range,
                "beams": beams}
    _core.check_cfar(spectrum, radar, **settings)  # `noise_shape` takes for granted that map and radar fit
    return _core.cfar(spectrum, radar, **settings, noise_shape=noise_shape(spectrum, radar), progress=progress)
