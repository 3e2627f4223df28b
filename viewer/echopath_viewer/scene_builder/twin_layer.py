"""Ghosts in the scene, as translucent twins of the objects that make them."""
from __future__ import annotations

from echopath.plots.labels import CLASSES

from ..model.maps.layers import TWINS
from .joined import joined_meshes
from .polydata import triangles_of

OPACITY = 0.28


class TwinLayer:
    """The object once more where its ghost seems to be, in the colour of the ghost's class, with the way as its name."""

    def __init__(self, plotter, set_names):
        """set_names: callable (layer, points [N, 3] m, texts)"""
        self._plotter, self._set_names, self._actors, self._shown = plotter, set_names, [], None

    def show(self, session) -> None:
        """What the session has switched on."""
        twins = session.known_data(TWINS) if TWINS in session.layers else None
        if twins is self._shown:
            return
        self._shown = twins
        for name in self._actors:
            self._plotter.remove_actor(name, render=False)
        self._actors = []
        tops, twins = [], twins or []
        for number, twin in enumerate(twins):
            joined = joined_meshes(session, twin.meshes)
            points = joined.points + twin.offset
            tops.append(points[points[:, 2].argmax()])
            self._add(f"twin {number}", triangles_of(points, joined.triangles), CLASSES[twin.ghost_type][1])
        self._set_names("twins", tops, [twin.name for twin in twins])

    def _add(self, name: str, poly, colour: str) -> None:
        self._actors.append(name)
        self._plotter.add_mesh(poly, name=name, color=colour, opacity=OPACITY, lighting=False, pickable=False,
                               show_scalar_bar=False, reset_camera=False, render=False)
