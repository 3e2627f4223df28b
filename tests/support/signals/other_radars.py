"""A radar and others that it hears."""
import numpy as np

import echopath as ep
from support.radars import build_radar

C = ep.speed_of_light
RATE, COUNT, BANDWIDTH = 20e6, 512, 1e9
SLOPE = BANDWIDTH * RATE / COUNT


def victim(**settings):
    return build_radar(num_samples=COUNT, **settings)


def other(slope_ratio=0.9, crossing=12.8e-6, distance=20.0, **settings):
    """A radar that looks back from a distance, whose chirps cross those of the victim at a time (s) in the chirp."""
    late = crossing - distance / C
    start = 77e9 + SLOPE * crossing - slope_ratio * SLOPE * late
    return build_radar(num_samples=COUNT, bandwidth=slope_ratio * BANDWIDTH, start_frequency=start, transmit_power=0.05,
                       position=(distance, 0, 0), yaw=np.pi, **settings)


TONE = build_radar(num_samples=COUNT, position=(40, 3, 0), num_chirps=32)  # parallel chirps: one line at half the distance
