"""Where the antennas of a radar are, which of them look the same way, and how they are polarised."""
from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..numerics.rates import radar_rate
from ..numerics.rotations import matrices

NO_PART = 1e-9       # of a polarisation: what rounding leaves of its part across a way along it
CO_POLARISED = 0.99  # cosine between the polarisations of two antennas that count as equal
ALL_AROUND = 1e-6    # length of a mean of unit vectors that has no direction
LEAST_LENGTH = 1e-12  # m: a way that is shorter has no direction


def centre_of(radar):
    """[3] m, in the radar's frame: half-way between the mean transmitter and the mean receiver."""
    return 0.5 * sum(np.mean([antenna.position for antenna in antennas], axis=0)
                     for antennas in (radar.transmitters, radar.receivers))


def middle_of_antennas(radar, time: float):
    """[3] m, in the world at a time in s: `centre_of`."""
    world_from_radar = radar.world_from_radar(time)
    return world_from_radar[:3, :3] @ centre_of(radar) + world_from_radar[:3, 3]


def ahead_of(radar, time: float):
    """[3] unit vector in the world at a time in s along the mean boresight of the transmitters, zero for all around."""
    mean = np.mean([_turned(antenna.orientation, (1.0, 0.0, 0.0)) for antenna in radar.transmitters], axis=0)
    length = np.linalg.norm(mean)
    return radar.world_from_radar(time)[:3, :3] @ (mean / length if length > ALL_AROUND else np.zeros(3))


def velocity_of_antennas(radar, time: float):
    """[3] m/s, in the world at a time in s, of `centre_of`: with what the turning of the radar's frame adds."""
    rate = radar_rate(radar, time)
    return rate[:3, :3] @ centre_of(radar) + rate[:3, 3]


def field_toward(radar, antenna, points, time: float):
    """[N], complex: the root of an antenna's gain, with its phase, toward points [N, 3] in m in the world at a time in s."""
    world_from_radar = radar.world_from_radar(time)
    away = (points - world_from_radar[:3, 3]) @ world_from_radar[:3, :3] - antenna.position
    away /= np.maximum(np.linalg.norm(away, axis=1), LEAST_LENGTH)[:, None]
    return antenna.pattern.field(away @ matrices(antenna.orientation))


def look_of(antenna) -> tuple:
    """Pattern, orientation and polarisation: antennas of one look differ in their places alone."""
    return antenna.pattern, antenna.orientation.tolist(), np.asarray(antenna.polarization).tolist()


def one_of_each_look(antennas) -> list[int]:
    """Indices of one antenna of each pattern, orientation and polarisation."""
    looks = [look_of(one) for one in antennas]
    return [index for index, look in enumerate(looks) if look not in looks[:index]]


def antennas_of(radar) -> list:
    """Transmitters and receivers."""
    return [*radar.transmitters, *radar.receivers]


def are_crossed(antennas: Iterable) -> bool:
    """Whether one antenna has another polarisation, in the radar's frame, than the first."""
    polarizations = [polarization_of(antenna) for antenna in antennas]
    return any(abs(polarizations[0] @ other) < CO_POLARISED for other in polarizations[1:])


def mixes_polarisations(radar) -> bool:
    """Whether the channels of a radar are of several pairs of polarisations, such as HH beside VV."""
    return are_crossed(radar.transmitters) or are_crossed(radar.receivers)


def polarization_of(antenna) -> np.ndarray:
    """[3] unit vector in the radar's frame."""
    return _turned(antenna.orientation, antenna.polarization)


def polarization_across(polarizations, ways) -> np.ndarray:
    """Unit vectors [N, 3] of the parts of polarisations [N, 3] across ways, unit vectors [N, 3]; along the polarisation
    that of the vertical, or of x where the way is vertical."""
    across = _part_across(polarizations, ways)
    for instead in ((0.0, 0.0, 1.0), (1.0, 0.0, 0.0)):
        is_along = np.linalg.norm(across, axis=1) < NO_PART * np.linalg.norm(polarizations, axis=1)
        across[is_along] = _part_across(np.broadcast_to(instead, ways.shape), ways)[is_along]
    return across / np.linalg.norm(across, axis=1)[:, None]


def _part_across(vectors, ways) -> np.ndarray:
    return vectors - np.sum(vectors * ways, axis=1)[:, None] * ways


def _turned(orientation, vector) -> np.ndarray:
    """A vector [3] turned by a unit quaternion (w, x, y, z)."""
    return matrices(orientation) @ vector
