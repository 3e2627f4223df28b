"""Desktop viewer of Echopath: which rays made which cell.

It needs the packages of `pip install 'echopath[viewer]'`.

model: what is shown, in NumPy; scene_builder: fills any pyvista.Plotter; window: Qt. Each works without the next.
"""
from __future__ import annotations

import importlib
from contextlib import contextmanager

from .libraries import missing_library

_EXTRA = ("pyvista", "pyvistaqt", "PySide6", "qtpy", "vtk", "vtkmodules")


def view(*what, **keywords):
    """Opens the viewer and returns when its window is closed.

    what: a frame file, a Frame, `scene, paths` or `scene, paths, parts`; frames in time: a folder, a pattern, a list of files,
    a Sequence, a StoredSequence or a Dataset; a Live; nothing: an empty window
    keywords: state: file of a view saved before; picture: file of what it shows, whose window is closed then; scale: of a
    PNG; parts, window and zero_pad of the maps of paths; evaluate, retrace and keyframes of their signals; parts are those of
    `decompose` (with their cubes), or selections {name: selection}, one partition or {partition: {name: selection}}
    """
    with _told_what_to_install():
        from .window import view as open_window
    return open_window(*what, **keywords)


def require_window() -> None:
    """Raises ModuleNotFoundError or OSError where `view` could not open a window: before long work whose end it is."""
    with _told_what_to_install():
        from .window.app import require_screen
    require_screen()


def plot_rays(scene, paths, **keywords):
    """Draws a scene with its strongest rays, on a screen or without one; see `echopath_viewer.plot.plot_rays`."""
    with _told_what_to_install():
        from .plot import plot_rays as draw
    return draw(scene, paths, **keywords)


def page_of(frame, **keywords):
    """The scene of a frame with rays as a page for notebooks and files; see `echopath_viewer.plot.page_of`."""
    with _told_what_to_install():
        from .plot import page_of as made
    return made(frame, **keywords)


def blocks_of(scene, time: float):
    """The meshes of a scene at `time` in s as a pyvista.MultiBlock; see `Scene.to_pyvista`."""
    with _told_what_to_install():
        from .scene_builder.blocks import blocks_of as made
    return made(scene, time)


@contextmanager
def _told_what_to_install():
    try:
        try:
            yield
        except ImportError as error:
            if type(error).__name__ == "QtBindingsNotFoundError":  # of qtpy, which does not say why
                _import_qt()
            raise
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] not in _EXTRA:
            raise
        text = f"the viewer needs {error.name}, which is not installed: pip install 'echopath[viewer]'"
        raise ModuleNotFoundError(text, name=error.name) from None


def _import_qt() -> None:
    """Raises ModuleNotFoundError where PySide6 is not installed, and OSError where the system lacks a library of it."""
    try:
        importlib.import_module("PySide6.QtWidgets")
    except ModuleNotFoundError:
        raise
    except ImportError as error:
        raise missing_library(error) from None
