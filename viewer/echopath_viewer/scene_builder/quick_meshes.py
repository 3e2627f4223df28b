"""All meshes in a few actors and with fewer triangles, for as long as the camera or the scene moves."""
from __future__ import annotations

import math

import numpy as np

from .polydata import coloured_actor, loose_lines_of, set_point_colours, set_segment_colours, triangles_of

ROUNDING = 1e-4  # of a cell's diagonal: in single precision a body that turns may seem to become longer by that

MOST_FINER = 10  # times a grid is halved for a thin body


class QuickMeshes:
    """Draws what a picture of this size can show of many triangles: software takes most of the time of a picture for triangles,
    many of them smaller than a pixel, and for going from one actor to the next."""

    def __init__(self, plotter, styles: dict):
        """styles: {name: (width of lines in pixels or None, opacity, share of light from everywhere)}, of the actors."""
        self._actors, self._coarse, self._drawn = {}, {}, {}
        for name, (width, opacity, ambient) in styles.items():
            is_lit = ambient < 1.0
            actor = coloured_actor(is_opaque=opacity == 1.0 and not is_lit)
            look = actor.GetProperty()
            look.SetOpacity(opacity)
            look.SetAmbient(ambient)
            look.SetDiffuse(1.0 - ambient)
            look.SetLighting(is_lit)
            look.SetLineWidth(width or 1.0)
            actor.VisibilityOff()
            plotter.add_actor(actor, name=f"quick {name}", reset_camera=False, pickable=False, render=False)
            self._actors[name] = actor

    def __iter__(self):
        return iter(self._actors.values())

    def hide(self) -> None:
        """Draws none of them."""
        for actor in self:
            actor.VisibilityOff()

    def show_bodies(self, name: str, meshes, vertices, triangles, colours, cells) -> None:
        """Draws meshes. meshes: IDs [N]; vertices, triangles: by ID, [V, 3] m and [F, 3]; colours: u8 [N, 3]

        cells: [N] m, of each mesh: vertices in the same cube of a grid of that spacing may be drawn at one place; 0: none may
        """
        shapes = [self._shape_of(mesh, vertices[mesh], triangles[mesh], cell) for mesh, cell in zip(meshes, cells)]
        points = [vertices[mesh][shape.rows] for mesh, shape in zip(meshes, shapes)]
        counts = [len(of_mesh) for of_mesh in points]
        drawn = self._drawn.get(name)
        if drawn is None or drawn[0] != shapes:
            begins = np.cumsum([0, *counts])
            faces = _joined([shape.triangles + begin for shape, begin in zip(shapes, begins)])
            drawn = shapes, triangles_of(_joined(points), faces), None
        elif points:
            drawn[1].points = _joined(points)
        self._paint(name, drawn, np.repeat(colours, counts, axis=0))

    def _paint(self, name: str, drawn, rgb) -> None:
        shapes, poly, before = drawn
        if before is None or not np.array_equal(before, rgb):
            set_point_colours(poly, rgb)
        self._drawn[name] = shapes, poly, rgb
        self._actors[name].GetMapper().SetInputDataObject(poly)
        self._actors[name].SetVisibility(poly.n_points > 0)

    def show_lines(self, name: str, points, colours) -> None:
        """Draws lines. points: of each mesh the ends [L, 2, 3] in m; colours: u8 [N, 3] of the meshes"""
        ends = np.concatenate(points) if len(points) else np.zeros((0, 2, 3), np.float32)
        lines = loose_lines_of(ends.reshape(-1, 3), np.arange(2 * len(ends)).reshape(-1, 2))
        set_segment_colours(lines, np.repeat(colours, [len(of_mesh) for of_mesh in points], axis=0))
        self._actors[name].GetMapper().SetInputDataObject(lines)
        self._actors[name].SetVisibility(len(ends) > 0)

    def _shape_of(self, mesh: int, vertices, triangles, cell: float) -> CoarseShape:
        """Kept until the cell is another octave or the body another one: one that only moves does not change its triangles."""
        octave = math.floor(math.log2(cell)) if 0.0 < cell < math.inf else None
        kept = self._coarse.get(mesh)
        if kept is None or kept[0] != octave or not kept[1].fits(vertices):
            self._coarse[mesh] = kept = octave, coarse_shape(vertices, triangles, 0.0 if octave is None else 2.0**octave)
        return kept[1]


class CoarseShape:
    """A body of few triangles: several vertices are drawn at the place of one.

    rows: [W] of the vertices that are drawn; triangles: [E, 3] between these
    """

    def __init__(self, vertices, rows, triangles, place, cell: float):
        """vertices: [V, 3] m, of which it was made; place: [V] of each vertex in rows; cell: m, 0: each has its own place"""
        self.rows, self.triangles = rows, triangles
        self._fitted, self._drawn_at, self._farthest = vertices, rows[place], math.sqrt(3.0) * cell * (1.0 + ROUNDING)

    def fits(self, vertices) -> bool:
        """Whether it may draw vertices [V, 3] in m, too: each is within a cell's diagonal of the place where it is drawn. That is
        so wherever a stiff body moves, but not where parts that lay in one cube part, or of a larger body."""
        if vertices is self._fitted:
            return True
        if len(vertices) != len(self._drawn_at):
            return False
        away = vertices - vertices[self._drawn_at]
        if len(away) and np.einsum("ij,ij->i", away, away).max() > self._farthest**2:
            return False
        self._fitted = vertices
        return True


def coarse_shape(vertices, triangles, cell: float) -> CoarseShape:
    """A body whose vertices in the same cube of a grid are drawn at one place, without triangles that become lines or points.

    vertices: [V, 3] m; triangles: [F, 3]; cell: m, spacing of the grid, 0: all as it is. A body longer than a cell of which
        nothing would be left, as a pole, has a finer grid: it is thin, but seen
    """
    triangles, each = np.asarray(triangles), np.arange(len(vertices))
    if cell == 0.0 or not len(vertices):
        return CoarseShape(vertices, each, triangles, each, 0.0)
    corner = np.asarray(vertices, np.float64)
    is_longer = np.ptp(corner, axis=0).max() > cell
    for finer in range(MOST_FINER + 1 if is_longer else 1):
        rows, faces, place = _clustered(corner, triangles, cell / 2.0**finer)
        if len(faces):
            break
    return CoarseShape(vertices, rows, faces, place, cell / 2.0**finer)


def _clustered(corner, triangles, cell: float) -> tuple:
    """(rows, triangles, place) of a CoarseShape."""
    at = np.floor((corner - corner.min(axis=0)) / cell).astype(np.int64)
    size = at.max(axis=0) + 1
    _, rows, place = np.unique((at[:, 0] * size[1] + at[:, 1]) * size[2] + at[:, 2], return_index=True, return_inverse=True)
    place = np.ravel(place)
    faces = place[triangles]
    is_face = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    return rows, faces[is_face], place


def _joined(arrays):
    return np.concatenate(arrays) if len(arrays) else np.zeros((0, 3), np.float32)
