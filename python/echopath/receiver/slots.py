"""The slots of what a receiver gets, when they begin and what they sweep, and random numbers of its faults."""
from __future__ import annotations

import numpy as np

from ..transmit import radar_of_noise


class SlotTimes:
    """The chirps of a cube before `demultiplex`.

    start_time: s, of the frame; begin: [T, C] s after it, T and C the first and third axis of the cube
    start_frequency, slope: [T, C] in Hz and Hz/s, [1, 1] where those of all chirps are alike
    """

    def __init__(self, radar, start_time: float):
        slots = radar_of_noise(radar)
        num_tx, num_chirps = len(slots.transmitters), slots.waveform.num_chirps
        self.start_time = start_time
        place = np.arange(num_chirps) * num_tx + np.arange(num_tx)[:, None]
        self.begin = np.vectorize(slots.waveform.slot_start, otypes=[float])(place)
        waveform = slots.waveform
        self.start_frequency = _stepped(waveform.start_frequency, waveform.frequency_steps, place)
        wider = waveform.sampling_rate / waveform.num_samples
        self.slope = _stepped(waveform.slope, np.multiply(wider, waveform.bandwidth_steps), place)

    def generator(self, seed: int | None, purpose: str) -> np.random.Generator | None:
        """Random numbers for a purpose, the same for the same seed and frame; None without a seed."""
        if seed is None:
            return None
        words = np.array([self.start_time]).view(np.uint32)
        return np.random.Generator(np.random.Philox(np.random.SeedSequence([seed, *words.tolist(), *purpose.encode()])))


def _stepped(value: float, steps, place) -> np.ndarray:
    """A value with the steps of the slots at places [T, C]; [1, 1] without steps."""
    return value + np.take(steps, place % len(steps)) if np.any(steps) else np.array([[value]])
