"""The radar equation: received power of a target of 1 m^2, and cross sections by it."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..base.numerics.rotations import matrices

_BORESIGHT = 1.0, 0.0, 0.0  # in an antenna's frame
_ROUNDING = 1e-9            # rad, of directions: what has no gain so much farther aside has none


def isotropic_power(radar, points, time: float):
    """Power in W that the first receiver would have from the first transmitter over a target of 1 m^2 at points [N, 3] in m.

    P = Pt Gt Gr lambda^2 / ((4 pi)^3 Rt^2 Rr^2) at the start frequency, to which the amplitudes of paths belong; gains are
    those of the antennas' patterns, polarisation is left out. points: in world axes at `time` in s. Returns [N], not
    finite at an antenna.
    """
    world = radar.world_from_radar(time)
    own = (points - world[:3, 3]) @ world[:3, :3]
    gain_out, distance_out = _leg(radar.transmitters[0], own)
    gain_in, distance_in = _leg(radar.receivers[0], own)
    wavelength = _core.speed_of_light / radar.waveform.start_frequency
    spread = (4.0 * np.pi) ** 3 * distance_out**2 * distance_in**2
    with np.errstate(divide="ignore", invalid="ignore"):
        return radar.transmit_power * gain_out * gain_in * wavelength**2 / spread


def cross_section_dbsm(power, radar, points, time: float):
    """The cross section in dBsm [N] of what sends so much power [N] in W back from points, as of `isotropic_power`.

    Minus infinity for no power, NaN where the antennas hear nothing, one of them at an antenna.
    """
    unit = isotropic_power(radar, points, time)
    with np.errstate(divide="ignore"):
        return 10.0 * np.log10(power / np.where(unit > 0.0, unit, np.nan))


def _leg(antenna, points) -> tuple:
    """(power gain, distance in m) [N] each, of an antenna toward points in the radar's frame; of itself that of boresight."""
    ways = (points - antenna.position) @ matrices(antenna.orientation)  # in the antenna's frame
    distance = np.linalg.norm(ways, axis=1)
    ways[distance == 0.0] = _BORESIGHT
    directions = ways / np.where(distance == 0.0, 1.0, distance)[:, None]
    return (_gains(antenna.pattern, directions) if len(points) else np.zeros(0)), distance


def _gains(pattern, directions):
    """Power gain [N] toward unit vectors [N, 3]: of what is right beside an antenna not what rounding makes of none."""
    aside = directions - np.multiply(_ROUNDING, _BORESIGHT)
    has_gain = pattern.field(aside / np.linalg.norm(aside, axis=1)[:, None]) != 0.0
    return np.where(has_gain, np.abs(pattern.field(directions)) ** 2, 0.0)
