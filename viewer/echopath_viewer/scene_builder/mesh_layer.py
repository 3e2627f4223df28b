"""The meshes of a scene."""
from __future__ import annotations

import numpy as np

from .polydata import lines_of, triangles_of

BODY_OPACITY, MIRROR_OPACITY = 0.65, 0.15
AMBIENT = 0.4         # light from everywhere: surfaces seen at a grazing angle keep their colour
OUTLINE_WIDTH = 1.5   # pixels
CHOSEN_EDGE_WIDTH = 1.5


class MeshLayer:
    """One actor for each mesh: coloured by mesh ID, translucent, at its place at some time."""

    def __init__(self, plotter, scene, palette, time: float):
        self._scene = scene
        self._is_moving = [scene.is_moving(mesh.id) for mesh in scene.meshes]
        self._polys, self.actors, self._outlines = [], [], {}
        for mesh in scene.meshes:
            vertices = scene.world_vertices(mesh.id, time)
            self._polys.append(triangles_of(vertices, mesh.triangles))
            self.actors.append(self._add(plotter, f"mesh {mesh.id}", self._polys[-1], mesh.material.mirror))
            if mesh.material.mirror:  # hard to see otherwise
                self._outlines[mesh.id] = self._add_outline(plotter, mesh, vertices)
        self.colour(palette)

    @staticmethod
    def _add(plotter, name: str, poly, is_mirror: bool):
        return plotter.add_mesh(poly, name=name, opacity=MIRROR_OPACITY if is_mirror else BODY_OPACITY,
                                lighting=not is_mirror, ambient=AMBIENT, diffuse=1.0 - AMBIENT, show_scalar_bar=False,
                                reset_camera=False, render=False)

    @staticmethod
    def _add_outline(plotter, mesh, vertices):
        edges = lines_of(vertices, boundary_edges(np.asarray(mesh.triangles)))
        return plotter.add_mesh(edges, name=f"outline {mesh.id}", line_width=OUTLINE_WIDTH, lighting=False, pickable=False,
                                show_scalar_bar=False, reset_camera=False, render=False)

    def move(self, time: float) -> None:
        """Puts all meshes where they are at a time in s."""
        for mesh, poly in enumerate(self._polys):
            if self._is_moving[mesh]:
                vertices = self._scene.world_vertices(mesh, time).astype(np.float32)
                poly.points = vertices
                if mesh in self._outlines:
                    self._outlines[mesh].mapper.dataset.points = vertices

    def colour(self, palette) -> None:
        for mesh, actor in enumerate(self.actors):
            actor.prop.color = palette[mesh] / 255.0
            if mesh in self._outlines:
                self._outlines[mesh].prop.color = palette[mesh] / 255.0

    def show(self, hidden: set, chosen) -> None:
        """hidden: mesh IDs; chosen: those whose edges are drawn."""
        for mesh, actor in enumerate(self.actors):
            actor.SetVisibility(mesh not in hidden)
            if mesh in self._outlines:
                self._outlines[mesh].SetVisibility(mesh not in hidden)
            actor.prop.show_edges = mesh in chosen
            actor.prop.line_width = CHOSEN_EDGE_WIDTH

    def bounds_of(self, meshes) -> list:
        """Corners [N, 3] in m of the boxes around meshes."""
        return [np.reshape(self._polys[mesh].bounds, (3, 2)).T for mesh in meshes]


def boundary_edges(triangles):
    """Edges [E, 2] that belong to one of the triangles [F, 3] only."""
    edges = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2).astype(np.int64), axis=1)
    unique, counts = np.unique(edges, axis=0, return_counts=True)
    return unique[counts == 1]
