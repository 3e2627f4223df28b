"""Received power by part, with its interval."""
from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from ..arguments.checks import refused
from ..base.numerics.decibels import SMALLEST_POWER, in_dbm
from ..paths.resolution import RESOLVED_DB
from ..signals.measures import for_pictures, with_error
from .style import new_figure, part_colours, require_drawable

if TYPE_CHECKING:
    from .. import _core
    from ..base.classes.foreign_types import Figure

ROOM_BESIDE_DB = 6.0  # of the weakest and the strongest power
SMALL_PRINT = 0.45    # inches, below the axis


def plot_part_powers(powers: Mapping[str, _core.ReceivedPower], *, title: str = "Received power by part") -> Figure:
    """The mean received power of each part with its 95 % interval; hollow where it is not resolved.

    powers: {part: ep.ReceivedPower}; title: above them. Returns a matplotlib figure: power in dBm across.
    Raises TypeError naming `powers`.
    """
    require_powers(powers)
    with new_figure(6.0, 1.0 + 0.45 * len(powers) + (SMALL_PRINT if _is_hollow(powers) else 0.0)) as figure:
        draw_part_powers(figure.subplots(), powers, title)
    return figure


def require_powers(powers: Mapping[str, _core.ReceivedPower]) -> None:
    """Raises TypeError unless they are powers by the names of parts: those of one partition, not the partitions of a frame."""
    rule = "a dict of ReceivedPower, as frame.mean_part_powers['parts'] is one"
    if not isinstance(powers, Mapping):
        raise refused(TypeError, "powers", rule, powers)
    for power in powers.values():
        require_drawable("powers", rule, power, "interval_db")


def draw_part_powers(axes, powers: dict, title="Mean received power by part") -> None:
    """A dot for each part with its interval; levels in dB have no zero that a bar could begin at."""
    shown = {name: power for name, power in powers.items() if power.power > 0.0}
    levels = {name: float(in_dbm(power.power)) for name, power in shown.items()}
    names = list(powers)
    for place, (name, colour) in enumerate(zip(names, part_colours(names))):
        if name in shown:
            _draw_power(axes, place, shown[name], colour)
        else:
            axes.text(0.02, place, "no paths", transform=axes.get_yaxis_transform(), va="center", fontsize=8, color="0.4")
    axes.set_yticks(range(len(names)), names)
    axes.set_ylim(len(names) - 0.5, -0.8)  # with room for the numbers above the first
    lowest = min(levels.values(), default=0.0) - ROOM_BESIDE_DB
    axes.set_xlim(5.0 * np.floor(lowest / 5.0), 5.0 * np.ceil((max(levels.values(), default=lowest) + ROOM_BESIDE_DB) / 5.0))
    axes.grid(alpha=0.25)
    words = f"\nhollow, not resolved: interval\nwider than \N{PLUS-MINUS SIGN}{RESOLVED_DB:g} dB"
    axes.set_xlabel("Power in dBm" + (words if _is_hollow(powers) else ""))
    axes.set_title(title)


def _is_hollow(powers: Mapping[str, _core.ReceivedPower]) -> bool:
    """Whether a dot is hollow, which the small print explains."""
    return any(power.power > 0.0 and not power.resolved for power in powers.values())


def _draw_power(axes, place: int, power, colour) -> None:
    """A dot over its interval, which runs out of the picture where it is wider; the numbers above it, where they hit no edge."""
    low, high = _error_bar(power)
    level = float(in_dbm(power.power))
    if high > low:
        axes.plot([low, high], [place, place], color="black", linewidth=1.2, marker="|", markersize=6)
    axes.plot(level, place, "o", markersize=8, color=colour, markerfacecolor=colour if power.resolved else "white",
              markeredgewidth=1.8)
    text = with_error(power) if high > low else f"{level:.1f} dBm"
    axes.annotate(for_pictures(text), (0.5, place), xycoords=("axes fraction", "data"), xytext=(0, 9), ha="center",
                  textcoords="offset points", fontsize=8)


def _error_bar(power) -> tuple[float, float]:
    """Ends in dBm of the 95 % interval."""
    return tuple(float(in_dbm(end, SMALLEST_POWER)) for end in (power.low, power.high))
