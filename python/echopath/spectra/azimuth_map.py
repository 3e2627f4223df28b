"""Settings of the range-azimuth map of a frame."""
from __future__ import annotations

import copy
from collections.abc import Mapping, Set

import numpy as np

from .. import _core
from ..arguments.checks import keywords, optional, real, refused
from ..arguments.gates import gate, require_cell
from ..arguments.keywords import parameters_of
from ..base.radar.velocities import velocity_span_of
from .angles import MAP_RULES, range_azimuth

DEFAULTS = {"combine": "peak"}  # noise as low as in the cells of the range-Doppler map

_ARRAYS = ("azimuth", "elevation", "velocity_gate")
_OWN = ("spectrum", "radar", "progress")  # of the call, which no settings have
_OF_MAP = ("velocity", "combine", "velocity_gate")  # which the beams of a map have not
_KEYWORDS = keywords("range_azimuth", tuple(name for name in parameters_of(range_azimuth) if name not in _OWN))


def sees_azimuth(radar, settings) -> bool:
    """Whether the antennas of a radar tell azimuths apart, and how many to show is known.

    settings: keywords of `ep.range_azimuth`; arrays of tens of metres, for which a map of all angles is too large, need
        azimuths of their own
    """
    array = _core.virtual_array(radar)
    return array.tells_azimuths and (settings.get("azimuth") is not None or array.has_default_azimuths)


def checked_settings(radar, settings, velocity_gate=None, zero_pad: int | None = None) -> dict:
    """Keywords of `ep.range_azimuth` for a radar, DEFAULTS for None; raises what it would raise, before a long trace.

    velocity_gate: (lowest, highest) in m/s beside the settings, or None; zero_pad: of the maps of the radar's frames, None: a
        gate need not hold a cell of these
    """
    settings = dict(DEFAULTS) if settings is None else _kept(_KEYWORDS("angles", settings))
    if velocity_gate is not None:
        if settings.get("velocity_gate") is not None:
            raise refused(ValueError, "velocity_gate", "None where angles has one", velocity_gate)
        settings["velocity_gate"] = velocity_gate
    if gate("velocity_gate", settings.get("velocity_gate")) and settings.get("velocity") is not None:
        raise refused(ValueError, "velocity_gate", "None where a velocity is chosen", settings["velocity_gate"])
    velocity = optional(real(unit="m/s"))("velocity", settings.get("velocity"))
    if zero_pad is not None:
        count = radar.waveform.num_chirps * zero_pad
        require_cell("velocity_gate", velocity_span_of(radar) / count, count,
                     gate("velocity_gate", settings.get("velocity_gate")), "m/s")
    limit = radar.waveform.max_velocity(radar.num_slots)
    if velocity is not None and abs(velocity) > limit:
        raise ValueError(f"velocity: must be within +-{limit:.6g} m/s, got {velocity}")
    small = _with_one_sample(radar)
    checked = settings | {"velocity": None, "velocity_gate": None}
    if settings.get("azimuth") is None and not sees_azimuth(radar, settings):
        checked["azimuth"] = 0.0  # the radar gets no map: its default may be refused
    passed = {name: MAP_RULES[name](name, value) for name, value in checked.items()}
    cube = np.zeros((len(radar.transmitters), len(radar.receivers), 1, 1))
    beams = {name: value for name, value in passed.items() if name not in _OF_MAP}
    _core.beamform(_core.range_doppler(cube, small), small, **beams)  # warns of nothing, not of a radar that gets no map either
    return settings


def _kept(settings: dict) -> dict:
    """Settings that later changes of the caller's arrays and lists do not reach, and that files can tell."""
    return {name: _kept_array(value) if name in _ARRAYS else copy.copy(value) if isinstance(value, list) else value
            for name, value in settings.items()}


def _kept_array(value):
    """What else than lists and tuples holds numbers, as a range or a coordinate of xarray, becomes an array."""
    if isinstance(value, (np.ndarray, list)):
        return copy.copy(value)
    is_told = value is None or np.isscalar(value) or isinstance(value, (tuple, Mapping, Set))
    return value if is_told else np.array(value)


def _with_one_sample(radar):
    """A radar of the same antennas whose maps have one cell."""
    given = radar.waveform
    waveform = _core.ChirpSequence(start_frequency=given.start_frequency, bandwidth=given.bandwidth, num_samples=1,
                                   sampling_rate=given.sampling_rate, num_chirps=1, chirp_interval=given.chirp_interval)
    return radar.replace(waveform=waveform, multiplexing="tdm", code_phases=None)
