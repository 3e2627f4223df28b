"""A radar at a place of its own, and the same radar whose antennas are placed and turned in the world by hand."""
import numpy as np

import echopath as ep
from support.radars import WAVEFORM


def turn(yaw, pitch):
    """World from radar [3, 3], its columns ahead, left and up: to the left by yaw, then up by pitch; rad."""
    ahead = [np.cos(pitch) * np.cos(yaw), np.cos(pitch) * np.sin(yaw), np.sin(pitch)]
    left = [-np.sin(yaw), np.cos(yaw), 0.0]
    return np.column_stack([ahead, left, np.cross(ahead, left)])


def quaternion(yaw, pitch):
    """(w, x, y, z) of the same turn: the product of a turn about z and one about -y."""
    c, s, cos, sin = np.cos(yaw / 2), np.sin(yaw / 2), np.cos(pitch / 2), np.sin(pitch / 2)
    return np.array([c * cos, s * sin, -c * sin, s * cos])


def product(p, q):
    """Of two quaternions (w, x, y, z)."""
    return np.concatenate([[p[0] * q[0] - p[1:] @ q[1:]], p[0] * q[1:] + q[0] * p[1:] + np.cross(p[1:], q[1:])])


def antennas_in_world(antennas, position, yaw, pitch):
    """Antennas of a radar with that place, as antennas of a radar at the origin."""
    return [ep.Antenna(np.asarray(position) + turn(yaw, pitch) @ antenna.position, pattern=antenna.pattern,
                       orientation=product(quaternion(yaw, pitch), antenna.orientation), polarization=antenna.polarization)
            for antenna in antennas]


def local_antennas():
    """(transmitters, receivers) of several directions, patterns and polarisations, about half a wavelength apart."""
    half = 0.5 * ep.speed_of_light / 77e9
    aside = np.array([np.cos(0.15), 0.0, 0.0, np.sin(0.15)])
    return ([ep.Antenna((0.02, 0.0, 0.1), pattern=ep.CosinePower(2.0)),
             ep.Antenna((0.02, 2 * half, 0.1), pattern=ep.CosinePower(1.0), orientation=aside)],
            [ep.Antenna((0.0, -0.03, 0.0), pattern=ep.CosinePower(2.0), polarization=(0.0, 0.6, 0.8)),
             ep.Antenna((0.0, half - 0.03, 0.0))])


def make_radars(position, yaw, pitch, motion=None, motion_in_world=None, **waveform):
    """(placed, by hand): two radars that must receive the same.

    motion: of the placed radar; motion_in_world: of the one at the origin whose antennas stand at `position`, None: the same
    """
    chirps = ep.ChirpSequence(**{**WAVEFORM, "num_chirps": 8, "chirp_interval": 1e-4, **waveform})
    transmitters, receivers = local_antennas()
    placed = ep.Radar(chirps, transmitters=transmitters, receivers=receivers, position=position, yaw=yaw, pitch=pitch,
                      motion=motion)
    by_hand = ep.Radar(chirps, transmitters=antennas_in_world(transmitters, position, yaw, pitch),
                       receivers=antennas_in_world(receivers, position, yaw, pitch), motion=motion_in_world or motion)
    return placed, by_hand
