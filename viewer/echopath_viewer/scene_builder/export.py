"""Rays and meshes as VTK files, for ParaView and its like."""
from __future__ import annotations

import pyvista as pv
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

from echopath.base.storage.files import written_whole
from echopath.base.storage.origin import origin_texts

from .joined import joined_meshes
from .polydata import lines_of, set_texts, triangles_of


def export_rays(session, path, rays=None) -> int:
    """Writes rays as VTK polydata (.vtp): one line cell for each leg, with what is known of it.

    rays: indices of paths, None: those that are drawn; path: of the file, written whole or not at all
    Cell data: path, bounce, num_bounces, mesh_id, power_dbm (dB re 1 mW), range (m), velocity (m/s). Field data:
    mesh_names, time (s), transmitter, receiver, software, seed. Returns the number of rays.
    """
    segments = session.segments(session.listed_rays() if rays is None else rays)
    poly = lines_of(segments.points, segments.ends)
    row, columns = segments.rays[segments.ray], session.columns
    values = {"path": row, "bounce": segments.bounce, "num_bounces": columns.num_bounces[row],
              "mesh_id": segments.mesh_id, "power_dbm": columns.power_dbm(row), "range": columns.range[row],
              "velocity": columns.velocity[row]}
    for name, column in values.items():
        poly.cell_data[name] = column
    set_texts(poly, "mesh_names", session.mesh_names)
    poly.field_data["time"] = [session.time]
    for name, number in zip(("transmitter", "receiver"), session.channel):
        poly.field_data[name] = [number]
    _write(poly, path, session)
    return len(segments.rays)


def export_meshes(session, path) -> int:
    """Writes all visible meshes at the time shown as one VTK polydata file (.vtp) with mesh_id by triangle.

    Returns the number of meshes.
    """
    shown = [mesh.id for mesh in session.scene.meshes if mesh.id not in session.hidden_meshes]
    joined = joined_meshes(session, shown)
    poly = triangles_of(joined.points, joined.triangles)
    poly.cell_data["mesh_id"] = joined.mesh_of_triangle
    set_texts(poly, "mesh_names", session.mesh_names)
    _write(poly, path, session)
    return len(shown)


def _write(poly: pv.PolyData, path, session) -> None:
    """With the version of the program and the seed of the rays among its field data."""
    path = str(path)
    if not path.endswith(".vtp"):
        raise ValueError(f"path: must end in .vtp, got {path}")
    for name, text in origin_texts(session.paths.frame.seed).items():
        set_texts(poly, name.lower(), [text])
    with written_whole(path) as temporary:
        temporary.write_bytes(_file_of(poly))


def _file_of(poly: pv.PolyData) -> bytes:
    """In memory: VTK prints what goes wrong with a disk, and goes on."""
    writer = vtkXMLPolyDataWriter()
    writer.SetInputData(poly)
    writer.SetDataModeToBinary()
    writer.WriteToOutputStringOn()
    writer.Write()
    return writer.GetOutputString().encode()
