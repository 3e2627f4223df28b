"""The slots of what a receiver gets, and random numbers of its faults."""
from __future__ import annotations

import numpy as np

from ..transmit import radar_of_noise


class SlotTimes:
    """When each chirp of a cube before `demultiplex` begins.

    start_time: s, of the frame; begin: [T, C] s after it, T and C the first and third axis of the cube
    """

    def __init__(self, radar, start_time: float):
        slots = radar_of_noise(radar)
        num_tx, num_chirps = len(slots.transmitters), slots.waveform.num_chirps
        self.start_time = start_time
        place = np.arange(num_chirps) * num_tx + np.arange(num_tx)[:, None]
        self.begin = np.vectorize(slots.waveform.slot_start, otypes=[float])(place)

    def generator(self, seed: int | None, purpose: str) -> np.random.Generator | None:
        """Random numbers for a purpose, the same for the same seed and frame; None without a seed."""
        if seed is None:
            return None
        words = np.array([self.start_time]).view(np.uint32)
        return np.random.Generator(np.random.Philox(np.random.SeedSequence([seed, *words.tolist(), *purpose.encode()])))
