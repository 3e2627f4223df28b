"""Whether a scene asks for field vectors, and why: what polarization="auto" chooses."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..arguments.names import MOST_NAMES, first_names
from ..arguments.settings import Polarization
from ..base.radar.antennas import antennas_of, are_crossed, polarization_of

COHERENT_SHARE = 0.01  # of the reflected power, below it a surface has no coherent echo
ALONG_NORMAL = 0.3     # of a polarisation, above it a tenth of the power is TM where a mirror is met
AUTO, SCALAR, FIELD_VECTORS = "auto", "scalar", "jones"


def coherent_share(material, wavelength: float) -> float:
    """Share of the reflected power at normal incidence that keeps its phase (Ament for a roughness height).

    wavelength: m
    """
    return _core.coherent_share(material, wavelength)


def need_of_field_vectors(scene, wavelength: float, radar=None, time: float = 0.0) -> str:
    """What asks for field vectors, in words; "" where one coefficient a hit does.

    Scalar coefficients are TE or TM, whichever is nearer: right on average for what is rough, and on flagged mirrors, which
    are mostly met in one of both; off by some dB for coherent surfaces at any angle, and blind for cross-polar echoes. Their
    conductors are TE alone, -1 where the TM of a metal floor is +1.
    wavelength: m; radar: whose antennas count, as it stands at a time in s; None: none
    """
    coherent = _core.coherent_meshes(scene, wavelength, COHERENT_SHARE)
    if coherent:
        return "coherent surfaces that are no flagged mirrors: " + _named(scene, coherent)
    materials, of_mesh, *_ = _core.mesh_traits(scene)
    turns = [material.cross_polarization > 0.0 and coherent_share(material, wavelength) < 1.0 for material in materials]
    turning = np.flatnonzero(np.array(turns, bool)[of_mesh])
    if len(turning):
        return "rough surfaces that turn the polarisation: " + _named(scene, turning)
    if radar is None:
        return ""
    floors = _conductors_met_in_tm(scene, radar, time)
    if floors:
        return "flagged mirrors of metal whose normals lie along the polarisation: " + _named(scene, floors)
    return "antennas of other polarisation" if are_crossed(antennas_of(radar)) else ""


def _conductors_met_in_tm(scene, radar, time: float) -> list[int]:
    """IDs of the flagged mirrors of perfect conductors whose normals have much of the polarisation of an antenna."""
    materials, of_mesh, *_ = _core.mesh_traits(scene)
    found = np.flatnonzero(np.array([one.mirror and one.conductor for one in materials], bool)[of_mesh])
    if len(found) == 0:
        return []
    fields = np.array([polarization_of(antenna) for antenna in antennas_of(radar)]) @ radar.world_from_radar(time)[:3, :3].T
    meshes = scene.meshes
    return [index for index in found if np.max(np.abs(_normals(scene, meshes[index], time) @ fields.T)) > ALONG_NORMAL]


def _normals(scene, mesh, time: float) -> np.ndarray:
    """Unit normals [F, 3] of a SceneMesh in the world at a time in s."""
    corners = np.asarray(scene.world_vertices(mesh.id, time))[mesh.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return normals / np.linalg.norm(normals, axis=1)[:, None]


def _named(scene, mesh_ids) -> str:
    return first_names(_core.mesh_names(scene, mesh_ids[:MOST_NAMES]), len(mesh_ids))


def chosen_model(model: Polarization, scene, wavelength: float, radar=None, time: float = 0.0) -> str:
    """"scalar" or "jones", as asked for, or as the scene asks for.

    wavelength: m; radar: whose antennas count, as it stands at a time in s, None: none
    """
    if model != AUTO:
        return model
    if _core.coherent_meshes(scene, wavelength, COHERENT_SHARE):  # their names take longer
        return FIELD_VECTORS
    return FIELD_VECTORS if need_of_field_vectors(scene, wavelength, radar, time) else SCALAR
