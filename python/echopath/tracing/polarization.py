"""Whether a scene asks for field vectors, and why: what polarization="auto" chooses."""
from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from .. import _core
from ..arguments.names import MOST_NAMES, first_names
from ..base.antennas import are_crossed

COHERENT_SHARE = 0.01  # of the reflected power, below it a surface has no coherent echo
AUTO, SCALAR, FIELD_VECTORS = "auto", "scalar", "jones"
MODELS = (AUTO, SCALAR, FIELD_VECTORS)


def coherent_share(material, wavelength: float) -> float:
    """Share of the reflected power at normal incidence that keeps its phase (Ament for a roughness height).

    wavelength: m
    """
    return _core.coherent_share(material, wavelength)


def need_of_field_vectors(scene, wavelength: float, antennas: Iterable = ()) -> str:
    """What asks for field vectors, in words; "" where one coefficient a hit does.

    Scalar coefficients are TE or TM, whichever is nearer: right on average for what is rough, and on flagged mirrors, which
    are mostly met in one of both; off by some dB for coherent surfaces at any angle, and blind for cross-polar echoes.
    wavelength: m
    """
    coherent = _core.coherent_meshes(scene, wavelength, COHERENT_SHARE)
    if coherent:
        return "coherent surfaces that are no flagged mirrors: " + _named(scene, coherent)
    materials, of_mesh, *_ = _core.mesh_traits(scene)
    turns = [material.cross_polarization > 0.0 and coherent_share(material, wavelength) < 1.0 for material in materials]
    turning = np.flatnonzero(np.array(turns, bool)[of_mesh])
    if len(turning):
        return "rough surfaces that turn the polarisation: " + _named(scene, turning)
    return "antennas of other polarisation" if are_crossed(antennas) else ""


def _named(scene, mesh_ids) -> str:
    return first_names(_core.mesh_names(scene, mesh_ids[:MOST_NAMES]), len(mesh_ids))


def chosen_model(model: str, scene, wavelength: float, antennas: Iterable = (), *, argument: str) -> str:
    """"scalar" or "jones" for one of MODELS.

    wavelength: m; argument: what the model was given as. Raises ValueError for another word.
    """
    if model not in MODELS:
        raise ValueError(f"{argument}: must be 'auto', 'scalar' or 'jones', got {model!r}")
    if model != AUTO:
        return model
    if _core.coherent_meshes(scene, wavelength, COHERENT_SHARE):  # their names take longer
        return FIELD_VECTORS
    return FIELD_VECTORS if need_of_field_vectors(scene, wavelength, antennas) else SCALAR
