"""VTK data and actors of our arrays."""
from __future__ import annotations

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonCore import vtkStringArray
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

from ..model.drawn_points import as_drawn

IN_FRONT = -66000.0  # units of depth resolution: in front of whatever else there is
# Shows the colours of points as they are. Most of the time of a software picture goes into what VTK does at each pixel of a ray.
OPAQUE_SHADER = """//VTK::System::Dec
//VTK::Output::Dec
in vec4 vertexColorVSOutput;
void main()
{
  gl_FragData[0] = vec4(vertexColorVSOutput.rgb, 1.0);
}
"""


def lines_of(points, ends) -> pv.PolyData:
    """Two-point segments: points [V, 3], ends [S, 2]."""
    poly = pv.PolyData()
    poly.points = as_drawn(points).reshape(-1, 3)
    poly.SetLines(pv.CellArray.from_regular_cells(np.ascontiguousarray(ends, np.int64).reshape(-1, 2)))
    poly.verts = np.empty(0, np.int64)  # pyvista makes vertex cells of bare points, which would shift the IDs of cells
    return poly


def loose_lines_of(points, ends) -> pv.PolyData:
    """The same, each segment with two points of its own, which may have other colours than those of its neighbours."""
    own = as_drawn(points)[np.asarray(ends)].reshape(-1, 3)
    return lines_of(own, np.arange(len(own)).reshape(-1, 2))


def vertices_of(points) -> pv.PolyData:
    """One vertex cell for each point [N, 3]."""
    poly = pv.PolyData()
    poly.points = as_drawn(points).reshape(-1, 3)
    poly.SetVerts(pv.CellArray.from_regular_cells(np.arange(poly.n_points, dtype=np.int64)[:, None]))
    return poly


def triangles_of(vertices, triangles, dtype=None) -> pv.PolyData:
    """vertices [V, 3] m, triangles [F, 3]; dtype: of the points, None: as they are drawn."""
    points = as_drawn(vertices) if dtype is None else np.asarray(vertices, dtype)
    return pv.PolyData.from_regular_faces(points, np.asarray(triangles, np.int64))


def set_texts(poly: pv.PolyData, name: str, texts) -> None:
    """Field data of texts in whatever letters: pyvista takes ASCII alone, VTK all of them."""
    array = vtkStringArray()
    array.SetName(name)
    for text in texts:
        array.InsertNextValue(text)
    poly.GetFieldData().AddArray(array)


def set_point_colours(poly: pv.PolyData, rgb) -> None:
    """rgb: u8 [points, 3]. Colours of cells would not do: Mesa's renderer without LLVM draws nothing where they are."""
    if poly.n_points == 0:
        return  # pyvista takes no empty arrays
    poly.point_data["rgb"] = np.ascontiguousarray(rgb, np.uint8).reshape(-1, 3)
    poly.GetPointData().SetActiveScalars("rgb")


def set_segment_colours(lines: pv.PolyData, rgb) -> None:
    """rgb: u8 [S, 3] of the segments of `loose_lines_of`."""
    set_point_colours(lines, np.repeat(np.ascontiguousarray(rgb, np.uint8).reshape(-1, 3), 2, axis=0))


def coloured_actor(*, in_front: bool = False, is_opaque: bool = False) -> vtkActor:
    """An actor that shows the colours of its points as they are, unlit.

    in_front: over everything else; is_opaque: in half of the time, but never translucent or in front
    """
    mapper = vtkPolyDataMapper()
    mapper.SetColorModeToDirectScalars()
    mapper.SetScalarModeToUsePointData()
    mapper.ScalarVisibilityOn()
    if in_front:
        mapper.SetResolveCoincidentTopologyToPolygonOffset()
        mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0.0, IN_FRONT)
        mapper.SetRelativeCoincidentTopologyPointOffsetParameter(IN_FRONT)
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().LightingOff()
    actor.PickableOff()
    if is_opaque:
        actor.GetShaderProperty().SetFragmentShaderCode(OPAQUE_SHADER)
    return actor


def plain_actor(poly: pv.PolyData, *, opacity: float = 1.0, ambient: float = 0.0, width: float = 1.0,
                is_lit: bool = True) -> vtkActor:
    """An actor of one colour, white at first; `Plotter.add_mesh` takes 30 times as long, seconds for a town.

    ambient: share of the light from everywhere; width: of lines in pixels
    """
    mapper = vtkPolyDataMapper()
    mapper.SetInputDataObject(poly)
    mapper.ScalarVisibilityOff()
    actor = vtkActor()
    actor.SetMapper(mapper)
    look = actor.GetProperty()
    look.SetInterpolationToFlat()
    look.SetOpacity(opacity)
    look.SetAmbient(ambient)
    look.SetDiffuse(1.0 - ambient)
    look.SetLighting(is_lit)
    look.SetLineWidth(width)
    return actor


def add_actors(plotter, actors: dict, *, is_picked: bool = False) -> None:
    """Adds actors {name: actor} in place of those of these names. One by one, pyvista would go through all actors for each.

    is_picked: whether a pick meets them
    """
    there = plotter.actors if actors else {}
    for name, actor in actors.items():
        if name in there:
            plotter.remove_actor(there[name], render=False)
        plotter.add_actor(actor, name=name, remove_existing_actor=False, reset_camera=False, pickable=is_picked, render=False)


def move_points(actor: vtkActor, points) -> None:
    """Puts the points of what an actor shows elsewhere: [V, 3] m."""
    actor.GetMapper().GetInput().SetPoints(pv.vtk_points(as_drawn(points)))
