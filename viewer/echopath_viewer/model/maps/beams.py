"""Beams of a radar's virtual array, as weights of its channels, and which paths lie in one."""
from __future__ import annotations

import numpy as np

import echopath as ep
from echopath.paths.subset import subset

from ..frames.maps_input import with_values

LEAST_GAIN = 0.5  # of the amplitude, that a path in a beam keeps: half of the width at -6 dB on each side


def direction(azimuth: float, elevation: float):
    """[3], unit vector in the frame of the radar; rad, left and up positive."""
    return np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])


def beam_weights(spectrum, radar, range_index: int, azimuth: float, elevation: float):
    """Complex [tx, rx, V]: the beam of a cell is the sum of its channels times these; an echo from there passes unchanged.

    Model: plane waves at the positions of the virtual array (`ep.beamform`), the phase between transmit slots taken out
    (`ep.compensate_tdm`), channels at one position averaged.
    azimuth, elevation: rad
    """
    positions, wavelength = np.asarray(ep.virtual_array(radar).positions, float), radar.waveform.wavelength
    steering = np.exp(2j * np.pi / wavelength * positions @ direction(azimuth, elevation)) * _shares(positions, wavelength)
    ones = with_values(spectrum, np.ones(spectrum.values.shape[2:]), slice(1))  # of one receiver: slots are those of all
    slots = ep.compensate_tdm(ones, radar.replace(receivers=radar.receivers[:1])).values[..., range_index]
    return steering[:, :, None] * slots


def _shares(positions, wavelength: float):
    """Real [tx, rx], which add up to 1: channels closer than a hundredth of a wavelength share one place."""
    flat = positions.reshape(-1, 3)
    near = np.linalg.norm(flat[:, None] - flat, axis=2) < 0.01 * wavelength
    share = 1.0 / near.sum(axis=1)
    return (share / share.sum()).reshape(positions.shape[:2])


def beam_values(spectrum, radar, range_index: int, azimuth: float, elevation: float):
    """The beam at a range, complex [V] in sqrt(W)."""
    weights = beam_weights(spectrum, radar, range_index, azimuth, elevation)
    return np.einsum("trv,trv->v", weights, spectrum.values[:, :, :, range_index])


def paths_in_beam(paths, mask, time: float, azimuth: float, elevation: float):
    """Which of the paths `mask` [P] a beam passes with at least half of their amplitude: bool [P].

    Model: transmitters see the direction in which a path leaves, receivers that in which it arrives.
    """
    radar, world = paths.radar, np.asarray(paths.radar.world_from_radar(time))
    rows = np.flatnonzero(mask)
    found = np.zeros(len(mask), bool)
    if not len(rows):
        return found
    kept = subset(paths, np.asarray(mask))
    hits, first = np.asarray(kept.points(time)).reshape(-1, 3), np.asarray(kept.offsets)
    last = first + np.asarray(kept.num_bounces).astype(np.int64) - 1
    origin, turn = world[:3, 3], world[:3, :3]
    ways = ((hits[at] - origin) @ turn for at in (first, last))
    leaves, arrives = (way / np.linalg.norm(way, axis=1, keepdims=True) - direction(azimuth, elevation) for way in ways)
    sent, received = (np.array([antenna.position for antenna in antennas], float) for antennas in
                      (radar.transmitters, radar.receivers))
    turns = (leaves @ sent.T)[:, :, None] + (arrives @ received.T)[:, None, :]  # m, of each path and channel
    shares = _shares(np.asarray(ep.virtual_array(radar).positions, float), radar.waveform.wavelength)
    gain = np.einsum("ptr,tr->p", np.exp(2j * np.pi * turns / radar.waveform.wavelength), shares)
    found[rows] = np.abs(gain) >= LEAST_GAIN
    return found
