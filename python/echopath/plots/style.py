"""What all pictures have in common."""
from __future__ import annotations

import os
import textwrap
import unicodedata
from contextlib import contextmanager
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from ..arguments.checks import refused
from ..base.storage.files import written_whole
from ..base.storage.origin import origin_texts
from ..base.text.colours import colours_of

if TYPE_CHECKING:
    from ..base.classes.foreign_types import Axes, Figure, SubFigure

DPI = 160
_MOST_LAYOUTS, _SETTLED = 5, 1e-9  # of a figure that is saved; of its sides, by which nothing moves any more
MAP_COLOURS = "inferno"
# Okabe and Ito: told apart with any colour vision. By number of bounces, the last for all higher numbers.
BOUNCE_COLOURS = ("#009e73", "#0072b2", "#d55e00", "#cc79a7", "#8c6d1f")

CURVE_COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")  # of the same palette

RANGE_LABEL, VELOCITY_LABEL, TIME_LABEL = "Range in m", "Radial velocity in m/s (away: +)", "Time in s"
LEFT_LABEL, AHEAD_LABEL = "To the left in m (right: \N{MINUS SIGN})", "Ahead in m"
X_LABEL, Y_LABEL = "x in m (ahead)", "y in m (left: +)"
AZIMUTH_LABEL, ELEVATION_LABEL = "Azimuth in degrees (left: +)", "Elevation in degrees (up: +)"
AZIMUTH_ALONE_LABEL = f"{AZIMUTH_LABEL}, at elevation 0"
POWER_LABEL = "Received power in dBm"
_LABELS = (RANGE_LABEL, VELOCITY_LABEL, TIME_LABEL, LEFT_LABEL, AHEAD_LABEL, X_LABEL, Y_LABEL, AZIMUTH_LABEL,
           AZIMUTH_ALONE_LABEL, ELEVATION_LABEL, POWER_LABEL)
_FROM_ABOVE = (LEFT_LABEL, AHEAD_LABEL), (Y_LABEL, X_LABEL)

LETTER = 0.56  # width of a letter over the size of the font, more than the mean
LONGEST_NAME = 28  # letters, about, of an object in a picture

# Fonts with letters that Matplotlib's own has not, as names of objects may have in China, Japan and Korea.
_FURTHER_FONTS = ("Noto Sans CJK SC", "Noto Sans CJK JP", "Source Han Sans SC", "WenQuanYi Zen Hei", "WenQuanYi Micro Hei",
                  "Microsoft YaHei", "Yu Gothic", "Malgun Gothic", "PingFang SC", "Hiragino Sans", "Apple SD Gothic Neo",
                  "Arial Unicode MS", "NanumGothic", "Droid Sans Fallback")
_SETTINGS = {
    "font.size": 9, "axes.titlesize": 10, "axes.labelsize": 9, "legend.fontsize": 8,
    "xtick.labelsize": 8, "ytick.labelsize": 8, "axes.spines.top": False, "axes.spines.right": False,
    "figure.facecolor": "white", "savefig.facecolor": "white",
}


@cache
def _fonts() -> list[str]:
    """Families in whose order letters are looked for: those that the machine has in the weight that is asked for."""
    from matplotlib.font_manager import fontManager

    installed = {font.name for font in fontManager.ttflist if font.weight == 400}
    return ["sans-serif", *(name for name in _FURTHER_FONTS if name in installed)]


def _house_style():
    """Context in which pictures are made."""
    import matplotlib

    return matplotlib.rc_context(_SETTINGS | {"font.family": _fonts()})


def is_drawable(value, *attributes: str) -> bool:
    """Whether the value has the attributes that are drawn."""
    return all(hasattr(value, name) for name in attributes)


def require_drawable(argument: str, rule: str, value, *attributes: str) -> None:
    """Raises TypeError naming the argument and the rule unless the value is drawable by them."""
    if not is_drawable(value, *attributes):
        raise refused(TypeError, argument, rule, value)


@contextmanager
def new_figure(width: float, height: float):
    """Yields an empty figure of that size in inches that needs no window."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    with _house_style():
        figure = Figure(figsize=(width, height), layout="constrained")
        FigureCanvasAgg(figure)
        yield figure


@contextmanager
def axes_or_new(ax, width: float, height: float, labels: tuple[str, str] | None = None):
    """Yields `ax`, or where it is None the axes of a new figure of pyplot of that size in inches, which notebooks show.

    labels: of what is drawn, across and up; None: those of no other picture. Raises TypeError for what are no axes, ValueError
    for axes with another picture in them, whose places are not those of what is drawn.
    """
    from matplotlib.axes import Axes

    if ax is not None and not isinstance(ax, Axes):
        raise TypeError(f"ax: must be Matplotlib axes or None, got {type(ax).__name__}")
    if ax is not None and labels is not None:
        _require_plane(ax, labels)
    with _house_style():
        if ax is None:
            from matplotlib import pyplot

            ax = pyplot.figure(figsize=(width, height), layout="constrained").subplots()
        yield ax


def _require_plane(ax, labels: tuple[str, str]) -> None:
    """Raises ValueError for axes that hold a picture of this package with other axes; all those from above go together."""
    across, up = (label.partition("\n")[0] for label in (ax.get_xlabel(), ax.get_ylabel()))
    is_same = (across, up) == labels or {(across, up), labels} <= {*_FROM_ABOVE}
    if ax.has_data() and {across, up} <= {*_LABELS} and not is_same:
        raise ValueError(f"ax: must be empty or have {labels[0]!r} across and {labels[1]!r} up, got axes with {across!r} across "
                         f"and {up!r} up")


def to_one_scale(ax) -> None:
    """Gives axes one scale for both directions and left on the left. Those that are so already, with a map from above or other
    points in them, keep their frame: turned around once more they would show what is left on the right."""
    if ax.get_aspect() != 1.0:
        ax.set_aspect("equal", adjustable="datalim")
    ax.xaxis.set_inverted(True)


def short_name(name: str) -> str:
    """The name of an object as pictures write it: of a long one both ends, by which those of foreign files differ. Where letters
    are twice as wide, as Chinese ones, half as many are long."""
    is_wide = any(unicodedata.east_asian_width(letter) in "WF" for letter in name)
    longest = LONGEST_NAME // 2 if is_wide else LONGEST_NAME
    if len(name) <= longest:
        return name
    return f"{name[:longest // 2].rstrip()}\N{HORIZONTAL ELLIPSIS}{name[1 - longest // 2:].lstrip()}"


def part_colours(names) -> list:
    """The colours (red, green, blue), 0 to 1, of parts or objects by their names."""
    return [tuple(value / 255.0 for value in colour) for colour in colours_of(list(names))]


def colour_bar(figure, image, panels, *, aspect: float = 30.0) -> None:
    """Adds the scale of the colours of an image of powers beside some axes. aspect: its height over its width"""
    figure.colorbar(image, ax=panels, label=POWER_LABEL, extend="both", pad=0.02, aspect=aspect)


def cell_edges(centres) -> np.ndarray:
    """Edges [N + 1] of the cells about the values of an axis [N]: half-way between them, and as far beyond the outermost."""
    centres = np.asarray(centres)
    if len(centres) == 1:
        return centres[0] + np.array([-0.5, 0.5])
    middle = 0.5 * (centres[1:] + centres[:-1])
    return np.concatenate([[2.0 * centres[0] - middle[0]], middle, [2.0 * centres[-1] - middle[-1]]])


def set_title(figure, text: str, size: float) -> None:
    """Sets the title of a figure or of its part, in as many lines as its width asks for. size: of its letters in points"""
    width = 72.0 * figure.bbox.width / figure.dpi  # points
    lines = [_filled(line, max(int(width / (LETTER * size)), 20)) for line in text.splitlines()]
    figure.suptitle("\n".join(lines), fontsize=size)


def _filled(line: str, width: int) -> str:
    """In as few lines of `width` letters at most as it takes, about equally long."""
    lines = textwrap.wrap(line, width)
    if len(lines) > 1:
        narrower = (textwrap.wrap(line, one) for one in range(len(line) // len(lines), width + 1))
        lines = next(found for found in narrower if len(found) == len(lines))
    return "\n".join(lines)


def save_png(figure: Figure | SubFigure | Axes, path: str | os.PathLike[str], *, seed: int | None = None,
             noise_seed: int | None = None) -> None:
    """Writes a figure as PNG, whole or not at all, with what made it as text chunks.

    A figure gives the same bytes whether it is made anew or saved again.
    figure: of matplotlib, or axes in it; path: of the file; seed: of the rays, noise_seed: of the thermal noise; None: there
        are none
    Raises OSError where the file cannot be written, TypeError naming the argument.
    """
    whole = _whole(figure)
    with _house_style(), written_whole(path) as temporary, _settled(whole):
        whole.savefig(temporary, format="png", dpi=DPI, metadata=origin_texts(seed, noise_seed))


def show(figure: Figure | SubFigure | Axes) -> None:
    """Shows a figure that plot_* has made in a window, or in a notebook below the cell, with all that pyplot has to show.

    figure: of matplotlib, or axes in it
    Returns as `matplotlib.pyplot.show` does: from a script, when the windows are closed. Raises TypeError naming the argument.
    """
    from matplotlib import pyplot

    whole = _whole(figure)
    if whole.canvas.manager is None:  # a window of pyplot takes it in the place of its own
        canvas = pyplot.figure(figsize=whole.get_size_inches()).canvas
        canvas.figure = whole
        whole.set_canvas(canvas)
    pyplot.show()


def _whole(figure) -> Figure:
    """The figure that axes or a part of one belong to."""
    from matplotlib.axes import Axes
    from matplotlib.figure import FigureBase

    drawn = figure.figure if isinstance(figure, Axes) else figure
    if not isinstance(drawn, FigureBase):
        raise refused(TypeError, "figure", "a figure of matplotlib, or axes in it", figure)
    return drawn.figure


@contextmanager
def _settled(figure: Figure):
    """Lays a figure out until nothing moves any more, each time going on from the last, and keeps it so meanwhile: saving would
    lay it out and draw it once more before it draws it."""
    import matplotlib

    engine, dpi = figure.get_layout_engine(), figure.dpi
    if engine is None or not figure.get_axes():
        yield
        return
    figure.dpi = DPI
    try:
        figure.set_layout_engine("none")
        figure.draw_without_rendering()  # what has never been drawn does not know all of its sides
        figure.set_layout_engine(engine)
        engine.execute(figure)
        before = _places(figure)
        for _ in range(_MOST_LAYOUTS - 1):
            engine.execute(figure)
            after = _places(figure)
            if np.allclose(after, before, rtol=0.0, atol=_SETTLED):
                break
            before = after
    finally:
        figure.dpi = dpi
    with matplotlib.rc_context({"figure.autolayout": False, "figure.constrained_layout.use": False}):
        figure.set_layout_engine(None)
    try:
        yield
    finally:
        figure.set_layout_engine(engine)


def _places(figure: Figure) -> list:
    return [axes.get_position().bounds for axes in figure.get_axes()]
