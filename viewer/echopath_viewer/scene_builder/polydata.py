"""VTK data and actors of our arrays."""
from __future__ import annotations

import numpy as np
import pyvista as pv
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

IN_FRONT = -66000.0  # units of depth resolution: in front of whatever else there is


def lines_of(points, ends) -> pv.PolyData:
    """Two-point segments: points [V, 3], ends [S, 2]."""
    poly = pv.PolyData()
    poly.points = np.asarray(points, np.float32).reshape(-1, 3)
    poly.SetLines(pv.CellArray.from_regular_cells(np.ascontiguousarray(ends, np.int64).reshape(-1, 2)))
    poly.verts = np.empty(0, np.int64)  # pyvista makes vertex cells of bare points, which would shift the IDs of cells
    return poly


def vertices_of(points) -> pv.PolyData:
    """One vertex cell for each point [N, 3]."""
    poly = pv.PolyData()
    poly.points = np.asarray(points, np.float32).reshape(-1, 3)
    poly.SetVerts(pv.CellArray.from_regular_cells(np.arange(poly.n_points, dtype=np.int64)[:, None]))
    return poly


def triangles_of(vertices, triangles, dtype=np.float32) -> pv.PolyData:
    """vertices [V, 3] m, triangles [F, 3]; dtype: of the points."""
    return pv.PolyData.from_regular_faces(np.asarray(vertices, dtype), np.asarray(triangles, np.int64))


def set_cell_colours(poly: pv.PolyData, rgb) -> None:
    """rgb: u8 [cells, 3]."""
    if poly.n_cells == 0:
        return  # pyvista takes no empty arrays
    poly.cell_data["rgb"] = np.ascontiguousarray(rgb, np.uint8).reshape(-1, 3)
    poly.GetCellData().SetActiveScalars("rgb")


def actor_in_cell_colours(*, in_front: bool = False) -> vtkActor:
    """An actor that shows the colours of its cells as they are, unlit; in_front: over everything else."""
    mapper = vtkPolyDataMapper()
    mapper.SetColorModeToDirectScalars()
    mapper.SetScalarModeToUseCellData()
    mapper.ScalarVisibilityOn()
    if in_front:
        mapper.SetResolveCoincidentTopologyToPolygonOffset()
        mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0.0, IN_FRONT)
        mapper.SetRelativeCoincidentTopologyPointOffsetParameter(IN_FRONT)
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().LightingOff()
    actor.PickableOff()
    return actor
