"""The noise of a radar whose transmitters send at once."""
from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .. import _core
from .code import is_coded, num_frame_slots, signal_shape
from .demultiplex import demultiplex


def radar_of_noise(radar: _core.Radar) -> _core.Radar:
    """The radar that has the noise of what a radar receives before `demultiplex`: of its shape, too."""
    if not is_coded(radar):
        return radar
    waveform = radar.waveform.replace(num_chirps=num_frame_slots(radar))
    return radar.replace(waveform=waveform, transmitters=radar.transmitters[:1], multiplexing="tdm", code_phases=None)


def noise_apart(radar: _core.Radar, seed: int) -> NDArray[np.complex128]:
    """The noise of a frame that starts at 0 s as `demultiplex` takes it apart, [tx, rx, chirp, sample] in sqrt(W): what undoes a
    code leaves noise that the channels have in common, and more of it near the ends of a frame."""
    nothing = np.zeros(signal_shape(radar), np.complex128)
    return demultiplex(_core.add_noise(nothing, radar_of_noise(radar), seed=seed, start_time=0.0), radar)
