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
    behind the radar.

    radar: Radar; title: above the axes, "": that of axes with a title, else how many there are
    ax: axes to draw in, None: new ones
    Returns the axes: y to the left across and z up in the radar's frame, in wavelengths in the middle of the band. Raises
    TypeError naming radar or ax.
    """
    from ..spectra.angles import virtual_array

    require_drawable("radar", "a Radar", radar, "transmitters", "receivers", "waveform")
    found = virtual_array(radar)
    antennas = [np.array([antenna.position for antenna in some]) for some in (radar.transmitters, radar.receivers)]
    middle = 0.5 * (np.concatenate(antennas).min(axis=0) + np.concatenate(antennas).max(axis=0))
    virtual = found.elements - 0.5 * (found.elements.min(axis=0) + found.elements.max(axis=0))
    shown = *(places - middle for places in antennas), virtual
    with axes_or_new(ax, *ARRAY_SIZE) as ax:
        for (name, marker, size), places, colour in zip(MARKS, shown, CURVE_COLOURS):
            y, z = places[:, 1:].T / found.wavelength
            ax.scatter(y, z, s=size, marker=marker, color=colour, alpha=0.8, label=f"{name}: {len(places)}", zorder=3)
        ax.set(xlabel="y in wavelengths (left: +)", ylabel="z in wavelengths (up: +)",
               title=text("title", title) or ax.get_title() or counted(len(found.elements), "virtual element"))
        ax.margins(0.1)
        to_one_scale(ax)
        ax.grid(alpha=0.25)
        ax.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), frameon=False)
    return ax
