"""Names of the objects in the scene."""
from __future__ import annotations

import numpy as np

from ..model.maps.layers import NAMES
from ..model.palette import objects_of


class NameLayer:
    """Above each object that is not hidden, where it is at the time on display; planes, which reach out of the picture, where
    rays meet them."""

    def __init__(self, set_names, meshes_of):
        """set_names: callable (layer, points [N, 3] m, texts); meshes_of: callable () -> MeshLayer, which has the boxes."""
        self._set_names, self._meshes_of = set_names, meshes_of

    def show(self, session) -> None:
        """What the session has switched on."""
        self._set_names("objects", *(self._tops(session) if NAMES in session.layers else ([], [])))

    def _tops(self, session) -> tuple:
        """(places [N, 3] m, names) of what is not hidden."""
        names, object_of_mesh = objects_of(session.scene)
        tops, texts = [], []
        for number, name in enumerate(names):
            meshes = [int(mesh) for mesh in np.flatnonzero(object_of_mesh == number) if mesh not in session.hidden_meshes]
            if meshes:
                tops.append(self._place(session, meshes))
                texts.append(name)
        return tops, texts

    def _place(self, session, meshes: list):
        """[3] m, of the name of an object."""
        if all(session.scene.meshes[mesh].material.mirror for mesh in meshes):
            drawn = session.segments(session.shown_rays())
            hits = drawn.points[drawn.hits[np.isin(drawn.hit_mesh, meshes)]]
            if len(hits):
                return np.median(hits, axis=0)
        corners = np.concatenate(self._meshes_of().bounds_of(meshes))
        low, high = corners.min(axis=0), corners.max(axis=0)
        return np.array([*(0.5 * (low + high))[:2], high[2]])
