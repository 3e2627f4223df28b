"""Names that stand in the scene."""
from __future__ import annotations

import numpy as np

ACTOR = "scene names"
LOOK = {"font_size": 12, "text_color": "black", "shape_color": "white", "shape_opacity": 0.8, "show_points": False,
        "always_visible": True, "reset_camera": False, "render": False}


class SceneNames:
    """Names of all layers as one actor, which leaves out those that would stand on others; a name of two layers stands once."""

    def __init__(self, plotter):
        self._plotter, self._of_layer = plotter, {}

    def show(self, layer: str, points, texts: list) -> None:
        """The names of a layer in place of those that it had. points: [N, 3] m; texts: N; none: it has no names"""
        named = [(tuple(point), text) for point, text in zip(np.asarray(points, float).reshape(-1, 3), texts)]
        if named == self._of_layer.get(layer, []):
            return
        self._of_layer[layer] = named
        places = {}
        for named in self._of_layer.values():
            for point, text in named:
                places.setdefault(text, point)
        self._plotter.remove_actor(ACTOR, render=False)
        if places:
            self._plotter.add_point_labels(np.array(list(places.values())), list(places), name=ACTOR, **LOOK)
