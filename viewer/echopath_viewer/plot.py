"""Pictures of rays without a window of our own: on the screen, in a notebook or in a file."""
from __future__ import annotations

import os

import numpy as np
import pyvista as pv

import echopath as ep
from echopath.base.process.callers import warn_user
from echopath.base.storage.origin import mark_png, origin_texts

from .model import Filters, PartSet, Session, Signals, ViewInput, from_frame, whole_part
from .model.frames.inputs import check_scene
from .off_screen import ASKED, lacking, needs_renderer, renderer
from .scene_builder import SceneBuilder
from .scene_builder.web_page import ScenePage

NUM_RAYS = 300
_FOLDER = os.path.dirname(__file__)


def plot_rays(scene, paths, *, selection="", num_rays=NUM_RAYS, color_by="bounces", cmap=None, clim=None, chirp=None,
              tx=0, rx=0, view="fit", show_hits=False, show_legend=True, hidden=(), plotter=None, off_screen=None,
              screenshot=None, window_size=(1200, 800), return_plotter=False):
    """Draws a scene with its strongest rays: what `echopath.plot_rays` does, which says what its arguments mean.

    Raises ValueError naming the argument.
    """
    _check_numbers(paths.radar, tx, rx, num_rays, chirp)
    if plotter is None and not return_plotter and screenshot is not None and needs_renderer(off_screen) and not renderer():
        return _draw_plainly(scene, paths, selection, num_rays, screenshot)
    session = _session_of(scene, paths)
    session.hides_rays = False  # what is hidden here stands in the way of rays that are meant to be seen
    session.set_sampling("strongest")
    session.set_max_rays(num_rays)
    session.set_color_by(color_by)
    if (tx, rx) != session.channel:
        session.set_channel(tx, rx)
    session.set_filters(Filters(expression=str(selection)))
    session.set_chirp(session.chirp if chirp is None else chirp)
    session.set_mesh_visible([mesh for mesh, name in enumerate(session.mesh_names)
                              if any(ep._core.glob_takes(glob, name) for glob in hidden)], False)
    target = plotter if plotter is not None else _new_plotter(off_screen, window_size)
    builder = SceneBuilder(target, session, show_hits=show_hits, show_legend=show_legend, cmap=cmap, clim=clim)
    builder.look(view)
    if plotter is None and return_plotter is False:
        target.show(screenshot=False if screenshot is None else str(screenshot), auto_close=True)
    elif screenshot is not None:
        target.screenshot(str(screenshot))
    if screenshot is not None:
        mark_png(screenshot, origin_texts(paths.frame.seed))
    return target if plotter is not None or return_plotter else None


def page_of(frame, *, selection="", num_rays=NUM_RAYS, color_by="bounces"):
    """What `Frame.show` returns, which says what its arguments mean. Raises ValueError naming the argument."""
    session = Session(from_frame(frame)) if frame.cube is not None else _session_of(frame.scene, frame.paths)
    session.set_color_by(color_by)
    session.set_max_rays(num_rays)
    session.set_filters(Filters(expression=str(selection)))
    return ScenePage(session)


def _check_numbers(radar, tx, rx, num_rays, chirp) -> None:
    for name, value, count in (("tx", tx, len(radar.transmitters)), ("rx", rx, len(radar.receivers)),
                               ("chirp", 0 if chirp is None else chirp, radar.waveform.num_chirps)):
        if not 0 <= value < count:
            raise ValueError(f"{name}: must lie in [0, {count - 1}], got {value}")
    if num_rays < 0:
        raise ValueError(f"num_rays: must not be negative, got {num_rays}")


def _new_plotter(off_screen, window_size):
    """Without a screen VTK would look for one first, and say aloud that it found none; without a renderer it would end the
    program."""
    if needs_renderer(off_screen):
        if not (window := renderer()):
            raise OSError(f"off_screen: {lacking()}")
        os.environ[ASKED] = window
    return pv.Plotter(off_screen=off_screen, window_size=list(window_size))


def _draw_plainly(scene, paths, selection, num_rays: int, screenshot) -> None:
    """The picture where nothing draws in OpenGL: of Matplotlib, with three views and the colours of the bounces."""
    warn_user(f"off_screen: drawn by Matplotlib, in its views and colours: {lacking()}", RuntimeWarning, _FOLDER)
    chosen = paths.select(selection) if str(selection) else paths
    figure = ep.plots.plot_scene(paths.scene if scene is None else scene, chosen, num_rays=num_rays)
    ep.plots.save_png(figure, screenshot, seed=paths.frame.seed)


def _session_of(scene, paths) -> Session:
    """A session without signals: of the maps only the axes."""
    check_scene(scene, paths)
    radar = paths.radar
    shape = len(radar.transmitters), len(radar.receivers), radar.waveform.num_chirps, radar.waveform.num_samples
    cube = np.zeros(shape, complex)
    signals = Signals(paths, {})
    return Session(ViewInput(paths, PartSet(whole_part(signals.map_of(cube))), signals, cube))
