"""Pictures of a session in any size, drawn without a window."""
from __future__ import annotations

import numpy as np
import pyvista as pv

from .builder import SceneBuilder


def still_of(session, size, scale: int, *, camera=None, show_hits: bool = False, background="white", tracks=None, places=None):
    """A picture u8 [height, width, 3] of the scene and its rays, without a legend and names.

    size: (width, height) in pixels at scale 1; scale: 1 or more, of both, with lines and points as much thicker
    camera: pyvista.Camera that looks from the same place, None: at everything; tracks: ep.Tracks in the scene, or None
    places: [N, 3] m, of the rows of tracks
    """
    plotter = pv.Plotter(off_screen=True, window_size=[scale * int(length) for length in size])
    try:
        builder = SceneBuilder(plotter, session, show_hits=show_hits, show_legend=False, background=background)
        builder.update({"layers"})
        builder.show_tracks(tracks, places)
        for actor in plotter.renderer.GetActors():
            look = actor.GetProperty()
            look.SetLineWidth(scale * look.GetLineWidth())
            look.SetPointSize(scale * look.GetPointSize())
        if camera is None:
            builder.look("fit")
        else:
            plotter.camera.DeepCopy(camera)
            plotter.reset_camera_clipping_range()
        return np.asarray(plotter.screenshot(return_img=True))[..., :3]
    finally:
        plotter.close()
