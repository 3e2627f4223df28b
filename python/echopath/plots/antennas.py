"""Antennas of a radar: the gain of a pattern over its two cuts, and the places of an array."""
from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..arguments.checks import text
from ..base.numerics.decibels import SMALLEST_POWER
from ..base.text.counts import counted
from .style import CURVE_COLOURS, axes_or_new, require_drawable, to_one_scale

if TYPE_CHECKING:
    from .. import _core
    from ..base.classes.foreign_types import Axes

CUT_SIZE, ARRAY_SIZE = (7.0, 4.4), (6.6, 4.6)  # inches
STEP = 0.1             # degrees
SHOWN_DB = 60.0        # below the peak
CUTS = (("azimuth cut, left +", "-"), ("elevation cut, up +", "--"))
MARKS = (("transmitters", "^", 60), ("receivers", "v", 60), ("virtual elements", "o", 14))


def draw_pattern(pattern: _core.AntennaPattern, *, ax: Axes | None = None, title: str = "") -> Axes:
    """Gain of a pattern all around in its xy-plane and its xz-plane, down to SHOWN_DB below the peak of both.

    pattern: AntennaPattern, such as GaussianBeam or what ep.load_antenna returns; title: above the axes, "": that of
        axes with a title, else the largest gain
    ax: axes to draw in, None: new ones
    Returns the axes: degrees off the boresight across (+x of the antenna), gain in dBi up. Raises TypeError naming pattern or
    ax.
    """
    require_drawable("pattern", "an AntennaPattern, as antenna.pattern is", pattern, "field", "peak_gain")
    angle = np.arange(-180.0, 180.0 + 0.5 * STEP, STEP)
    ahead, aside, none = np.cos(np.radians(angle)), np.sin(np.radians(angle)), np.zeros(len(angle))
    gains = [10.0 * np.log10(np.maximum(np.abs(pattern.field(np.stack(cut, axis=-1))) ** 2, SMALLEST_POWER))
             for cut in ((ahead, aside, none), (ahead, none, aside))]
    peak = max(float(np.max(gain)) for gain in gains)
    with axes_or_new(ax, *CUT_SIZE) as ax:
        for (name, line), gain, colour in zip(CUTS, gains, CURVE_COLOURS):
            ax.plot(angle, np.maximum(gain, peak - 2.0 * SHOWN_DB), line, color=colour, linewidth=1.4, label=name)
        ax.set(xlim=(-180.0, 180.0), ylim=(peak - SHOWN_DB, peak + 3.0), xlabel="Angle off the boresight in degrees",
               ylabel="Gain in dBi", title=text("title", title) or ax.get_title() or f"{peak:.1f} dBi at most in the two cuts")
        ax.set_xticks(np.arange(-180, 181, 45))
        ax.grid(alpha=0.25)
        ax.legend(loc="upper right")
    return ax


def draw_array(radar: _core.Radar, *, ax: Axes | None = None, title: str = "") -> Axes:
    """Transmitters and receivers about their middle, and the virtual elements that they make together about theirs, as seen from
    behind the antennas: the row of a radar that looks aside in the frame of its car is a row.

    radar: Radar; title: above the axes, "": that of axes with a title, else how many there are
    ax: axes to draw in, None: new ones
    Returns the axes: to the left across, of the mean azimuth of where the antennas look, and z of the radar's frame up, in
    wavelengths in the middle of the band. Raises TypeError naming radar or ax.
    """
    from ..spectra.angles import virtual_array

    require_drawable("radar", "a Radar", radar, "transmitters", "receivers", "waveform")
    found = virtual_array(radar)
    axes = np.array([[-np.sin(found.boresight), np.cos(found.boresight), 0.0], [0.0, 0.0, 1.0]]) / found.wavelength
    antennas = [[antenna.position for antenna in some] @ axes.T for some in (radar.transmitters, radar.receivers)]
    virtual = found.elements @ axes.T
    shown = *(places - _middle(np.concatenate(antennas)) for places in antennas), virtual - _middle(virtual)
    with axes_or_new(ax, *ARRAY_SIZE) as ax:
        for (name, marker, size), places, colour in zip(MARKS, shown, CURVE_COLOURS):
            ax.scatter(*places.T, s=size, marker=marker, color=colour, alpha=0.8, label=f"{name}: {len(places)}", zorder=3)
        ax.set(xlabel="To the left in wavelengths (right: \N{MINUS SIGN})", ylabel="z in wavelengths (up: +)",
               title=text("title", title) or ax.get_title() or counted(len(found.elements), "virtual element"))
        ax.margins(0.1)
        to_one_scale(ax)
        ax.grid(alpha=0.25)
        ax.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), frameon=False)
    return ax


def _middle(places: np.ndarray) -> np.ndarray:
    return 0.5 * (places.min(axis=0) + places.max(axis=0))
