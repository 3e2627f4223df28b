"""Traces and cross sections as scripts ask for them: the model of polarisation chosen, what is wrong with the scene said."""
from __future__ import annotations

import math

import numpy as np

from . import _core
from .lost_rays import warn_of_lost_rays, warn_of_unaimed, warn_of_unfollowed_beams
from .polarization import AUTO, FIELD_VECTORS, SCALAR, antennas_of, chosen_model
from .tessellation import warn_of_coarse_meshes


def trace(scene, radar, *, polarization=AUTO, **settings):
    warn_of_coarse_meshes(scene, radar.waveform.start_frequency, stacklevel=2)
    wavelength = _core.speed_of_light / radar.waveform.start_frequency
    model = chosen_model(polarization, scene, wavelength, antennas_of(radar), argument="polarization")
    paths = _core.trace(scene, radar, kept=_geometry_of(scene), polarization=model, **settings)
    warn_of_lost_rays(paths.frame.statistics, stacklevel=2)
    warn_of_unfollowed_beams(paths.frame.statistics, stacklevel=2)
    warn_of_unaimed(paths.frame.statistics, stacklevel=2)
    return paths


def rcs(scene, *, polarization=(0.0, 0.0, 1.0), model=AUTO, **settings):
    frequency = _positive(settings.get("frequency"))
    if frequency:  # the core says what is wrong with others
        warn_of_coarse_meshes(scene, frequency, stacklevel=2)
    chosen = chosen_model(model, scene, _core.speed_of_light / (frequency or 1.0), argument="model")
    is_one = _is_one_vector(polarization)
    if not is_one and model == SCALAR:
        raise ValueError(f"model: 'scalar' takes one vector for both antennas as polarization, got {polarization!r}")
    both = [polarization, polarization] if is_one and chosen == FIELD_VECTORS else polarization
    return _core.rcs(scene, polarization=both, **settings)


def _positive(frequency) -> float | None:
    """A frequency as a number, None where it is none above zero."""
    try:
        number = float(frequency)
    except (TypeError, ValueError):
        return None
    return number if 0.0 < number < math.inf else None


def _is_one_vector(polarization) -> bool:
    try:
        return np.asarray(polarization, np.float64).shape == (3,)
    except (TypeError, ValueError):  # names of channels, ragged rows
        return False


def _geometry_of(scene):
    """Where the geometry of a scene's traces is kept; None for its first trace: one that is traced once keeps nothing."""
    state = getattr(scene, "__dict__", None)  # plain scenes of the core have none
    if state is None:
        return None
    if not state.setdefault("_was_traced", False):
        state["_was_traced"] = True
        return None
    return state.setdefault("_geometry", _core.KeptGeometry())


for _function, _of_core in ((trace, _core.trace), (rcs, _core.rcs)):
    _function.__doc__ = (_of_core.__doc__ + "\nWarns (TessellationWarning) of curved meshes that err by more than 0.3 dB, "
                         "with the edge length in m that would do.")
trace.__doc__ += (" Warns (RuntimeWarning) where over 1 % of the rays are lost to a surface that the radar touches, or not "
                  "every sequence of mirrors was tried.")
