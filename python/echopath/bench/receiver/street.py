"""The signal of a street of some twenty objects before an array."""
from __future__ import annotations

from functools import cache

import numpy as np

import echopath as ep

from ..crowd import scenes as crowd_scenes
from ..physics.closed_forms import WAVELENGTH

NUM_TX, NUM_RX, NUM_CHIRPS = 3, 4, 128
NUM_RAYS, QUICK_NUM_RAYS = 100_000, 20_000


def radar(**settings) -> ep.Radar:
    """Three transmitters two wavelengths apart, four receivers; settings: of ep.Radar."""
    pattern, half = ep.CosinePower(4.0), 0.5 * WAVELENGTH
    antennas = {side: [ep.Antenna((0.0, step * i, crowd_scenes.RADAR_HEIGHT), pattern=pattern) for i in range(count)]
                for side, count, step in (("transmitters", NUM_TX, 4 * half), ("receivers", NUM_RX, half))}
    waveform = crowd_scenes.radar().waveform.replace(num_chirps=NUM_CHIRPS)
    return ep.Radar(waveform, **antennas, transmit_power=0.02, **settings)


def other() -> ep.Radar:
    """A radar that comes the other way; its chirps are a tenth flatter."""
    one = radar()
    return one.replace(waveform=one.waveform.replace(bandwidth=0.9 * one.waveform.bandwidth), position=(30.0, 1.5, 0.0),
                       yaw=np.pi, motion=ep.LinearMotion(velocity=(-8.0, 0.0, 0.0)))


@cache
def scene() -> ep.Scene:
    """Its twenty objects."""
    return crowd_scenes.street(mirrors=False)


@cache
def paths(num_rays: int) -> ep.Paths:
    """What its rays touch."""
    return ep.trace(scene(), radar(), num_rays=num_rays, start_time=0.1)


@cache
def cube(num_rays: int):
    """Its signal [tx, rx, chirp, sample] in sqrt(W) of transmitters that take turns."""
    return ep.synthesize(paths(num_rays))


def at_rest(paths: ep.Paths) -> ep.Paths:
    """Those of paths of the street that touch nothing that moves, which are its actors."""
    for one in crowd_scenes.street_objects():
        if not isinstance(one.parts, list):
            paths = paths.select(~ep.hits(one.name))
    return paths
