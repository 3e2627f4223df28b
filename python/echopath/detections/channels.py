"""Channels of a radar in which the fields of paths are made."""
from __future__ import annotations

from functools import cached_property

import numpy as np

from ..transmit import mixes_of_turns

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

    @cached_property
    def largest_shift(self) -> float:
        """Bins of range by which the length of a path may differ from that of the first channel, at most."""
        return float(self._apart(0).max())

    @cached_property
    def neighbours(self) -> list:
        """Lists of channels between which no path goes farther than SAME_LINE."""
        groups = []
        for channel in range(len(self.indices)):
            apart = self._apart(channel)
            near = next((group for group in groups if apart[group].max() <= SAME_LINE), None)
            if near is None:
                groups.append([channel])
            else:
                near.append(channel)
        return groups

    def gains_of(self, gains, count: int) -> np.ndarray:
        """By how much the receiver makes amplitudes of so many echoes larger, [N, C]; gains: EchoGains at their ranges"""
        return gains.of("", *self.indices.T[:, :, None], np.arange(count)).T

    def _apart(self, channel: int) -> np.ndarray:
        """Bins of range by which the length of a path may differ between a channel and each one, at most, [C]."""
        apart = sum(0.5 * np.linalg.norm(places - places[channel], axis=-1) for places in self._places)
        return apart / self._radar.waveform.range_resolution

    @cached_property
    def _places(self) -> list:
        """[C, 3] m of the transmitters and of the receivers."""
        antennas = self._radar.transmitters, self._radar.receivers
        return [np.array([some[index].position for index in indices]) for some, indices in zip(antennas, self.indices.T)]


def by_channel(beams):
    """Weights [N, C] of those [N, tx, rx] of beams, of all channels."""
    return beams.reshape(len(beams), beams.shape[1] * beams.shape[2])


def in_turns(beams, radar):
    """Weights [turns, N, tx, rx] that beams [N, tx, rx] give the signals of single transmitters, as `demultiplex` mixes them of
    echoes that are too fast for the map."""
    return np.einsum("kab,nar->knbr", mixes_of_turns(radar), beams)
