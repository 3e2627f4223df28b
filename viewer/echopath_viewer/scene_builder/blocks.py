"""Scenes as data of pyvista, for whoever goes on with it."""
from __future__ import annotations

import numpy as np
import pyvista as pv

from echopath.scene.lifetimes import scene_at

from .polydata import triangles_of

_NUMBERS = ("conductivity", "reflectivity", "roughness_height", "scattering", "cross_polarization")


def blocks_of(scene, time: float) -> pv.MultiBlock:
    """The meshes of a scene at `time` in s as a MultiBlock by their full names, in the order of their IDs; points in m, double.

    What is absent then by its lifetime has no block, and no ID.
    Field data of a block: mesh_id; of its material material (name, "" without one), conductor and mirror (0 or 1),
    permittivity (real, imaginary), conductivity (S/m), reflectivity, roughness_height (m), scattering and
    cross_polarization, those that it has.
    """
    blocks = pv.MultiBlock()
    scene = scene_at(scene, time)
    for mesh in scene.meshes:
        poly = triangles_of(scene.world_vertices(mesh.id, time), mesh.triangles, np.float64)
        for name, values in _fields_of(mesh).items():
            poly.field_data[name] = values
        blocks.append(poly, mesh.name)
    return blocks


def _fields_of(mesh) -> dict:
    material = mesh.material
    fields = {"mesh_id": [mesh.id], "material": [mesh.material_name], "conductor": [int(material.conductor)],
              "mirror": [int(material.mirror)]}
    if material.permittivity is not None:
        fields["permittivity"] = [material.permittivity.real, material.permittivity.imag]
    return fields | {name: [getattr(material, name)] for name in _NUMBERS if getattr(material, name) is not None}
