"""The meshes of a scene."""
from __future__ import annotations

from contextlib import contextmanager

import numpy as np
import pyvista as pv

from ..model.drawn_points import as_drawn
from .polydata import add_actors, lines_of, move_points, plain_actor, triangles_of
from .quick_meshes import QuickMeshes

BODY_OPACITY, MIRROR_OPACITY, CHOSEN_OPACITY = 0.65, 0.15, 0.9
AMBIENT = 0.4         # light from everywhere: surfaces seen at a grazing angle keep their colour
OUTLINE_WIDTH = 1.5   # pixels
CHOSEN_EDGE_WIDTH = 2.0
EDGE_SHADE = 0.55     # of a body's colour, that its edges have
MOST_TRIANGLES, MOST_EDGED = 200, 400  # of a body whose edges are drawn; meshes of such a scene
CHOSEN_COLOUR = "#d55e00"
LOOKS = {"bodies": (None, BODY_OPACITY, AMBIENT), "mirrors": (None, MIRROR_OPACITY, 1.0), "edges": (OUTLINE_WIDTH, 1.0, 1.0)}
CREASE = np.cos(np.radians(30.0))  # of the angle between two faces whose edge is drawn


class MeshLayer:
    """One actor for each mesh: coloured by mesh ID, translucent, at its place at some time; a few for all of them while
    something moves, which blend in the order of their triangles: to blend without one takes software a sixth of a picture."""

    def __init__(self, plotter, scene, palette, time: float):
        self._plotter, self._creases, self._hidden, self._chosen = plotter, {}, set(), set()
        self._quick, self._is_quick, self._moved = None, False, set()  # meshes whose actors are not where they were placed
        plotter.renderer.SetUseOIT(True)
        self._set_scene(scene)
        self._polys, self._placed, self.actors, self._outlines, self._edges = [], [], [], {}, {}
        self._colours, self._boxes = np.full((len(self._is_moving), 3), -1), np.zeros((2, len(self._is_moving), 3))
        self._triangles = [np.asarray(mesh.triangles) for mesh in scene.meshes]
        for mesh in scene.meshes:
            vertices = scene.world_vertices(mesh.id, time)
            self._polys.append(triangles_of(vertices, mesh.triangles))
            self._placed.append(as_drawn(vertices))
            self._box(mesh.id)
            self.actors.append(self._body(self._polys[-1], mesh.material.mirror))
            edges = self._edges_of(mesh, vertices)
            if len(edges):
                self._edges[mesh.id] = edges
                self._outlines[mesh.id] = plain_actor(lines_of(vertices, edges), width=OUTLINE_WIDTH, is_lit=False)
        add_actors(plotter, {f"mesh {mesh}": actor for mesh, actor in enumerate(self.actors)}, is_picked=True)
        add_actors(plotter, {f"outline {mesh}": actor for mesh, actor in self._outlines.items()})
        self.colour(palette)

    def _set_scene(self, scene) -> None:
        """Keeps what is asked for often: a scene makes the list of its meshes anew each time."""
        self._scene, meshes = scene, scene.meshes
        self._is_moving = [scene.is_moving(mesh.id) for mesh in meshes]
        self._is_mirror, self._names = [mesh.material.mirror for mesh in meshes], [mesh.name for mesh in meshes]

    @staticmethod
    def _body(poly, is_mirror: bool):
        return plain_actor(poly, opacity=MIRROR_OPACITY if is_mirror else BODY_OPACITY, ambient=AMBIENT, is_lit=not is_mirror)

    def _edges_of(self, mesh, vertices):
        """Those that are drawn, [E, 2]: rims of planes, which are hard to see otherwise, and creases of simple bodies: a box
        looks like a box then."""
        triangles = np.asarray(mesh.triangles)
        if mesh.material.mirror:
            return boundary_edges(triangles)
        is_simple = len(triangles) <= MOST_TRIANGLES and len(self._is_moving) <= MOST_EDGED
        return creases(vertices, triangles) if is_simple else np.zeros((0, 2), np.int64)

    def move(self, time: float) -> None:
        """Puts all meshes where they are at a time in s."""
        for mesh, is_moving in enumerate(self._is_moving):
            if is_moving:
                self._place(mesh, time)

    def _place(self, mesh: int, time: float) -> None:
        vertices = as_drawn(self._scene.world_vertices(mesh, time))
        if np.array_equal(vertices, self._placed[mesh]):
            return
        self._placed[mesh] = vertices
        self._box(mesh)
        self._moved.add(mesh)
        if not self._is_quick or mesh in self._chosen:
            self._put(mesh)

    def _box(self, mesh: int) -> None:
        self._boxes[:, mesh] = self._placed[mesh].min(axis=0), self._placed[mesh].max(axis=0)

    def _put(self, mesh: int) -> None:
        """Puts the actors of a mesh where it was placed."""
        self._moved.discard(mesh)
        self._polys[mesh].points = self._placed[mesh]
        for edges in (self._outlines, self._creases):
            if mesh in edges:
                move_points(edges[mesh], self._placed[mesh])

    def fits(self, scene) -> bool:
        """Whether another scene has the same meshes, maybe elsewhere."""
        theirs = scene.meshes
        return len(self._names) == len(theirs) and all(
            name == other.name and is_mirror == other.material.mirror and np.array_equal(triangles, other.triangles)
            for name, is_mirror, triangles, other in zip(self._names, self._is_mirror, self._triangles, theirs))

    def take(self, scene, palette, time: float) -> None:
        """Shows the meshes of a scene that `fits`, where they are at a time in s."""
        self._set_scene(scene)
        for mesh in range(len(self._polys)):
            self._place(mesh, time)
        self.colour(palette)

    def remove(self) -> None:
        """Takes all of it out of the picture."""
        for actor in (*self.actors, *self._outlines.values(), *self._creases.values(), *(self._quick or ())):
            self._plotter.remove_actor(actor, render=False)

    def colour(self, palette) -> None:
        """u8 [M, 3]; what has its colour already is left alone."""
        changed = np.flatnonzero((np.asarray(palette) != self._colours).any(axis=1))
        for mesh in changed:
            self.actors[mesh].GetProperty().SetColor(*(palette[mesh] / 255.0))
        self._colours = np.array(palette, int)
        for mesh in changed:
            if mesh in self._outlines:
                self._outlines[mesh].GetProperty().SetColor(*(self._edge_colour(mesh) / 255.0))

    def show(self, hidden: set, chosen) -> None:
        """hidden: mesh IDs; chosen: those whose edges are drawn."""
        self._hidden, self._chosen = set(hidden), set(chosen) - set(hidden)
        for mesh in self._chosen & self._moved:
            self._put(mesh)
        self._show_actors()
        self._choose(self._chosen)

    def _show_actors(self) -> None:
        """Those of meshes one by one, but for what is drawn together with others."""
        for mesh, actor in enumerate(self.actors):
            is_shown = mesh not in self._hidden and (not self._is_quick or mesh in self._chosen)
            actor.SetVisibility(is_shown)
            if mesh in self._outlines:
                self._outlines[mesh].SetVisibility(is_shown)

    def show_quick(self, cells) -> None:
        """Draws meshes together and with fewer triangles, until `show_each`.

        cells: callable (lowest corners [M, 3], highest [M, 3] of the boxes around meshes in m), [M] m, so that vertices in the
            same cube of a grid of that spacing may be drawn at one place; 0: none may
        """
        if not self._is_quick:
            self._is_quick = True
            self._plotter.renderer.SetUseOIT(False)
            self._show_actors()
        self._quick = self._quick or QuickMeshes(self._plotter, LOOKS)
        together, sizes = set(range(len(self.actors))) - self._hidden - self._chosen, cells(*self._boxes)
        for name, is_mirror in (("bodies", False), ("mirrors", True)):
            meshes = [mesh for mesh in sorted(together) if self._is_mirror[mesh] == is_mirror]
            self._quick.show_bodies(name, meshes, self._placed, self._triangles, self._colours[meshes], sizes[meshes])
        meshes = sorted(together & set(self._edges))
        self._quick.show_lines("edges", [self._placed[mesh][self._edges[mesh]] for mesh in meshes],
                               [self._edge_colour(mesh) for mesh in meshes])

    def _edge_colour(self, mesh: int):
        """[3] 0 to 255."""
        return (1.0 if self._is_mirror[mesh] else EDGE_SHADE) * self._colours[mesh]

    def show_each(self) -> None:
        """Draws each mesh by itself again, with all its triangles."""
        if not self._is_quick:
            return
        self._is_quick = False
        self._plotter.renderer.SetUseOIT(True)
        self._quick.hide()
        for mesh in list(self._moved):
            self._put(mesh)
        self._show_actors()

    @contextmanager
    def each(self):
        """Meanwhile each mesh that is shown has its actor in its place, to be looked for."""
        was_quick, self._is_quick = self._is_quick, False
        for mesh in list(self._moved):
            self._put(mesh)
        self._show_actors()
        try:
            yield self.actors
        finally:
            self._is_quick = was_quick
            self._show_actors()

    def _choose(self, chosen: set) -> None:
        """Draws rims and creases of chosen meshes: all edges of a dense one would cover it."""
        new = {mesh: self._crease_lines(mesh) for mesh in sorted(chosen - set(self._creases))}
        add_actors(self._plotter, {f"creases {mesh}": actor for mesh, actor in new.items()})
        self._creases |= new
        for mesh, actor in self._creases.items():
            actor.SetVisibility(mesh in chosen)
        for mesh, actor in enumerate(self.actors):
            actor.GetProperty().SetOpacity(self._opacity_of(mesh) if mesh not in chosen else CHOSEN_OPACITY)

    def _crease_lines(self, mesh: int):
        vertices = np.asarray(self._polys[mesh].points)
        actor = plain_actor(lines_of(vertices, creases(vertices, self._triangles[mesh])), width=CHOSEN_EDGE_WIDTH, is_lit=False)
        actor.GetProperty().SetColor(*pv.Color(CHOSEN_COLOUR).float_rgb)
        return actor

    def _opacity_of(self, mesh: int) -> float:
        return MIRROR_OPACITY if self._is_mirror[mesh] else BODY_OPACITY

    def bounds_of(self, meshes) -> list:
        """Corners [N, 3] in m of the boxes around meshes."""
        return list(self._boxes[:, list(meshes)].swapaxes(0, 1))


def boundary_edges(triangles):
    """Edges [E, 2] that belong to one of the triangles [F, 3] only."""
    edges = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2).astype(np.int64), axis=1)
    unique, counts = np.unique(edges, axis=0, return_counts=True)
    return unique[counts == 1]


def creases(vertices, triangles):
    """Edges [E, 2] of the triangles [F, 3] that only one of them has, or where two meet at an angle."""
    corners = np.asarray(vertices, float)[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    edges = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2).astype(np.int64), axis=1)
    unique, row, counts = np.unique(edges, axis=0, return_inverse=True, return_counts=True)
    totals = np.zeros((len(unique), 3))
    np.add.at(totals, np.ravel(row), np.repeat(normals, 3, axis=0))
    cosine = 0.5 * np.einsum("ij,ij->i", totals, totals) - 1.0  # of two unit normals, from the length of their sum
    return unique[(counts != 2) | (cosine < CREASE)]
