"""What the linear faults of a receiver make of an echo where it stands in a map."""
from __future__ import annotations

import numpy as np

from .._core import speed_of_light
from ..arguments.part_names import INTERFERENCE, LEAKAGE, RESIDUE
from .channels import receiver_factors, require_channels, transmitter_factors
from .filters import NEGATIVE_SHARE, has_filters, response
from .imbalance import weights_of_imbalance
from .settings import Receiver
from .slots import SlotTimes

_WITHOUT_TRANSMITTERS = (INTERFERENCE, LEAKAGE, RESIDUE)  # the first has not their errors, the others have them already


class EchoGains:
    """By how much a receiver makes the amplitudes of echoes larger, by channels and by the range where they show in a map.

    Model: errors of the chains, with the phases that beams tell apart, of the receivers as the root of their mean square over the
    frame and in their mean phase; the size of what the filters pass at the beat frequency of the range, in the first half of a
    bin at its end, because an echo that shows there need not beat at 0, where high-passes let nothing through, and of leakage,
    whose sidelobes and what is left of it by a code reach far, at its own frequency everywhere; the share that the imbalance
    leaves where it was. Coupling, phase noise and compression count for nothing.
    radar: that has the receiver; ranges: [R] m, of the cells of the map or of its peaks, which stand between them; start_time: s,
        of the frame
    of_filters: [R], at these ranges, as that of noise
    """

    def __init__(self, radar, ranges, start_time: float = 0.0):
        receiver = Receiver() if radar.receiver is None else radar.receiver
        require_channels(receiver, radar)
        self.of_filters = _filter_gains(receiver, radar.waveform, ranges)
        half_bin = 0.5 * radar.waveform.range_resolution
        self._of_echoes = _filter_gains(receiver, radar.waveform, np.maximum(ranges, half_bin))
        leaked = np.full(len(ranges), 0.5 * speed_of_light * receiver.leakage_delay)
        self._of_leakage = _filter_gains(receiver, radar.waveform, leaked)
        self._is_real = radar.waveform.real
        self._of_receivers = _kept(receiver, radar.waveform) * _mean_of_receivers(receiver, radar, start_time)
        of_transmitters = transmitter_factors(receiver, radar)
        self._of_transmitters = np.ones(len(radar.transmitters), complex) if of_transmitters is None else of_transmitters

    def of(self, part: str, tx, rx, distance) -> np.ndarray:
        """The gains of a part of this name, complex.

        tx, rx, distance: indices of antennas and of the ranges, of shapes that broadcast to that of the result
        """
        of_filters = self._of_leakage if part == LEAKAGE else self._of_echoes
        of_transmitters = np.ones_like(self._of_transmitters) if part in _WITHOUT_TRANSMITTERS else self._of_transmitters
        has_phases = part == LEAKAGE and self._is_real  # of the receivers, already (`cubes_beside`)
        of_receivers = np.abs(self._of_receivers) if has_phases else self._of_receivers
        return of_receivers[rx] * of_filters[distance] * of_transmitters[tx]


def _filter_gains(receiver: Receiver, waveform, ranges) -> np.ndarray:
    if not has_filters(receiver):
        return np.ones(len(ranges))
    beat = np.asarray(ranges) / waveform.range_resolution * waveform.sampling_rate / waveform.num_samples
    is_negative = (not waveform.real) & (beat >= (1.0 - NEGATIVE_SHARE) * waveform.sampling_rate)
    return np.abs(response(receiver, beat - is_negative * waveform.sampling_rate))


def _kept(receiver: Receiver, waveform) -> float:
    """What is left of an echo beside its image: `unbalanced`."""
    return 1.0 if waveform.real else float(np.abs(weights_of_imbalance(receiver)[0]))


def _mean_of_receivers(receiver: Receiver, radar, start_time: float) -> np.ndarray:
    factors = receiver_factors(receiver, radar, SlotTimes(radar, start_time))
    if factors is None:
        return np.ones(len(radar.receivers), complex)
    phase = np.angle(np.mean(factors, axis=(0, 2, 3)))
    return np.sqrt(np.mean(np.abs(factors) ** 2, axis=(0, 2, 3))) * np.exp(1j * phase)
