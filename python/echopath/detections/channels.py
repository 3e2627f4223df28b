"""Channels of a radar in which the fields of paths are made."""
from __future__ import annotations

from functools import cached_property

import numpy as np

SAME_LINE = 0.1  # bins of range, over which a response is a straight line: 0.4 % of the peak


class Channels:
    """Some channels of a radar, spread evenly over all.

    count: how many at most, None: all
    indices: of (transmitter, receiver), [C, 2]; the first is that of the first antennas
    """

    def __init__(self, radar, count: int | None = None):
        self._radar = radar
        num_receivers = len(radar.receivers)
        num_channels = len(radar.transmitters) * num_receivers
        taken = np.linspace(0, num_channels - 1, num_channels if count is None else min(count, num_channels)).astype(int)
        self.indices = np.stack(np.divmod(taken, num_receivers), axis=-1)

    @cached_property
    def of_transmitters(self) -> dict:
        """{transmitter: its channels, [K] ascending}."""
        return {int(tx): np.flatnonzero(self.indices[:, 0] == tx) for tx in np.unique(self.indices[:, 0])}

    @property
    def largest_shift(self) -> float:
        """Bins of range by which the length of a path may differ from that of the first channel, at most."""
        return float(self._apart[0].max())

    @cached_property
    def neighbours(self) -> list:
        """Lists of channels between which no path goes farther than SAME_LINE."""
        groups = []
        for channel, apart in enumerate(self._apart):
            near = next((group for group in groups if apart[group].max() <= SAME_LINE), None)
            if near is None:
                groups.append([channel])
            else:
                near.append(channel)
        return groups

    @cached_property
    def _apart(self) -> np.ndarray:
        """Bins of range by which the length of a path may differ between two channels, at most, [C, C]."""
        tx, rx = (np.array([antennas[index].position for index in indices]) for antennas, indices in zip(
            (self._radar.transmitters, self._radar.receivers), self.indices.T))
        apart = sum(0.5 * np.linalg.norm(places[:, None] - places, axis=-1) for places in (tx, rx))
        return apart / self._radar.waveform.range_resolution


def by_channel(beams):
    """Weights [N, C] of those [N, tx, rx] of beams, of all channels."""
    return beams.reshape(len(beams), beams.shape[1] * beams.shape[2])
