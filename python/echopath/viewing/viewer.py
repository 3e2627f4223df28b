"""The viewer, where its packages are installed."""
from __future__ import annotations

import os
import sys
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Literal, Union

from .. import _core
from ..arguments.checks import (
    MapWindow,
    an,
    anything,
    array,
    checked,
    count,
    flag,
    map_window,
    one_of,
    optional,
    path,
    refused,
    text,
)
from ..arguments.objects import listed
from ..arguments.settings import Evaluate, Retrace, SignalSettings
from ..frame.frame import Frame
from ..live import Live
from ..sequence import Sequence, StoredSequence
from ..signals.parts import Views, selection_rule

if TYPE_CHECKING:
    from ..base.classes.foreign_types import Colormap, Plotter, QMainWindow
    from ..dataset import Dataset  # takes its time to import

ColorBy = Literal["bounces", "mesh", "power", "range", "speed"]
Viewed = Union[str, os.PathLike[str], list[str], list[os.PathLike[str]], tuple[str | os.PathLike[str], ...], Frame, Sequence,
               StoredSequence, Live, "Dataset"]
View = Literal["fit", "radar", "top", "side"]
_REPLAY = {name: optional(SignalSettings.RULES[name]) for name in ("zero_pad", "evaluate", "retrace", "keyframes")}


def _what(argument: str, value):
    """A frame file, a Frame, a scene, frames in time or None."""
    if value is None or isinstance(value, (_core.Scene, Frame, Live, Sequence, StoredSequence)) or _is_dataset(value):
        return value
    if isinstance(value, (str, os.PathLike)):
        return path(argument, value)
    if isinstance(value, (list, tuple)) and value and all(isinstance(one, (str, os.PathLike)) for one in value):
        return [path(argument, one) for one in value]
    raise refused(TypeError, argument, "a frame file, a Frame, frames in time or a list of files to view, or the scene of paths",
                  value)


def _is_dataset(value) -> bool:
    dataset = sys.modules.get("echopath.dataset")  # where nobody imported it, there is none of it
    return dataset is not None and isinstance(value, dataset.Dataset)


@checked(what=_what, paths=optional(an(_core.Paths)), parts=optional(an(Mapping, called="a dict")), window=optional(map_window),
         **_REPLAY, state=optional(path), picture=optional(path),
         scale=count(1, 8), block=flag)
def view(what: Viewed | _core.Scene | None = None, paths: _core.Paths | None = None,
         parts: Views = None, *, window: MapWindow | None = None, zero_pad: int | None = None, evaluate: Evaluate | None = None,
         retrace: Retrace | None = None, keyframes: int | None = None, state: str | os.PathLike[str] | None = None,
         picture: str | os.PathLike[str] | None = None, scale: int = 1, block: bool = True) -> QMainWindow | None:
    """Opens the viewer: view(scene, paths, parts), view(frame) or view("frame.h5"); view() is an empty window.

    It needs the packages of `pip install 'echopath[viewer]'`.
    what: a frame file, a Frame, or the scene of the paths (None: theirs); or frames in time, which open as one time line: a
        Sequence (frames appear as they are simulated), a StoredSequence, a Dataset, a folder of one of these or of frame files,
        a pattern such as "out/frame_*.h5", or a list of files; or a Live, whose objects are then dragged (Shift)
    paths: of `trace`
    parts: of `decompose` (with their cubes), or selections {name: selection}, one partition or {partition: {name: selection}}
    window, zero_pad: of the maps of paths, as in `range_doppler`; evaluate, retrace, keyframes: of their signals, as in
        `synthesize`; None: as there
    state: file of a view saved before
    picture: file of what it shows, whose window is closed then: .png the window, .svg or .pdf its maps, .gif or .mp4 a film
        through its frames or, of one frame, its chirps (MP4 needs imageio-ffmpeg), .html its scene with rays to be picked
        (needs plotly); scale: 1 to 8, times the pixels of a PNG along each axis
    block: True returns when the window is closed, False at once with the window
    Returns None, or the window with block=False. Raises TypeError or ValueError naming the argument, ep.FileError for a file
    that cannot be shown, OSError without a screen, ModuleNotFoundError where the viewer is not installed.
    """
    given = {"window": window, "zero_pad": zero_pad, "evaluate": evaluate, "retrace": retrace, "keyframes": keyframes}
    given = {name: value for name, value in given.items() if value is not None}
    if paths is not None:
        return _viewer().view(what, paths, parts=parts, **given, state=state, picture=picture, scale=scale, block=block)
    if parts is not None:
        given["parts"] = parts
    if given:
        raise TypeError(f"{next(iter(given))}: belongs to a scene and paths, view(scene, paths, parts), got no paths")
    return _viewer().view(*([] if what is None else [what]), state=state, picture=picture, scale=scale, block=block)


def _selection(argument: str, value):
    return value if isinstance(value, str) and not value else selection_rule(argument, value)


def _hidden(argument: str, value) -> list[str]:
    if isinstance(value, str) or not isinstance(found := listed(value), list):
        raise refused(TypeError, argument, "a list of globs", value)
    return [text(argument, glob) for glob in found]


_NUMBER = count(0)


@checked(scene=optional(an(_core.Scene)), selection=_selection, num_rays=_NUMBER, color_by=one_of(ColorBy), cmap=anything,
         clim=optional(array("[2]", finite=True)), chirp=optional(_NUMBER), view=one_of(View), show_hits=flag,
         show_legend=flag, hidden=_hidden, plotter=anything, off_screen=optional(flag), screenshot=optional(path),
         window_size=array("[2]", kind="whole"), return_plotter=flag)
def plot_rays(scene: _core.Scene | None, paths: _core.Paths, *, selection: str | _core.Selection = "", num_rays: int = 300,
              color_by: ColorBy = "bounces", cmap: str | Colormap | None = None, clim: tuple[float, float] | None = None,
              chirp: int | None = None, tx: int = 0, rx: int = 0, view: View = "fit", show_hits: bool = False,
              show_legend: bool = True, hidden: Iterable[str] = (), plotter: Plotter | None = None,
              off_screen: bool | None = None, screenshot: str | os.PathLike[str] | None = None,
              window_size: tuple[int, int] = (1200, 800), return_plotter: bool = False) -> Plotter | None:
    """Draws a scene with its strongest rays: plot_rays(scene, paths, off_screen=True, screenshot="rays.png").

    Needs no screen, but the packages of `pip install 'echopath[viewer]'`.
    scene: that of the paths, or None; paths: of `trace`
    selection: path expression or Selection of the rays that are drawn, "": all; num_rays: at most, the strongest
    color_by: "bounces", "mesh", "power", "range" or "speed"; cmap, clim: colour map and (low, high) of the last three, in
        dBm, m or m/s
    chirp: index of the one at whose middle scene and rays are shown, None: that of the middle of the frame
    tx, rx: indices of the channel's antennas; hidden: globs of meshes that are not drawn
    view: "fit", "radar", "top" or "side"; show_hits: with a dot at each hit; show_legend: with the names of the colours
    plotter: a pyvista.Plotter to draw into, which is then not shown; window_size: (width, height) in pixels
    off_screen: True: without a screen, None: as pyvista.OFF_SCREEN says; screenshot: PNG file to be written
    return_plotter: instead of None
    Returns the pyvista.Plotter where one was given or asked for, else None. Raises TypeError or ValueError naming the
    argument, ModuleNotFoundError where the viewer is not installed. Where nothing draws without a screen (wheels bring
    what does, elsewhere OpenGL with EGL does, Debian's libgl1 and libegl1), Matplotlib draws the screenshot, in views
    and colours of its own, with a RuntimeWarning; a plotter raises OSError.
    """
    return _viewer().plot_rays(scene, paths, selection=selection, num_rays=num_rays, color_by=color_by, cmap=cmap, clim=clim,
                               chirp=chirp, tx=tx, rx=rx, view=view, show_hits=show_hits, show_legend=show_legend,
                               hidden=hidden, plotter=plotter, off_screen=off_screen, screenshot=screenshot,
                               window_size=window_size, return_plotter=return_plotter)


def _viewer():
    import echopath_viewer

    return echopath_viewer
