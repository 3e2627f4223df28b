"""Tones through a receiver with faults."""

import numpy as np

import echopath as ep
from support.radars import build_radar

LEVEL = 0.2      # dB, promised for levels
RATE, COUNT = 20e6, 512


def one_channel(num_chirps=8, **settings):
    return build_radar(num_samples=COUNT, num_chirps=num_chirps, **settings)


def tone(cell, power=1.0, num_chirps=8):
    """An echo [1, 1, chirp, sample] of a beat frequency of so many cells, in W."""
    return np.sqrt(power) * np.exp(2j * np.pi * cell * np.arange(COUNT) / COUNT) * np.ones((1, 1, num_chirps, 1))


def received(cube, seed=None, num_chirps=8, **faults):
    radar = one_channel(num_chirps, receiver=ep.Receiver(**faults))
    return ep.receive(cube, radar, seed=seed)


def db(ratio):
    return 10.0 * np.log10(ratio)
