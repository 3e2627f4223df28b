"""The receiver of a radar whose transmitters send at once."""
from __future__ import annotations

from .. import _core
from .code import is_coded, num_frame_slots


def radar_of_noise(radar: _core.Radar) -> _core.Radar:
    """The radar that has the noise of what a radar receives before `demultiplex`: of its shape, too."""
    if not is_coded(radar):
        return radar
    waveform = radar.waveform.replace(num_chirps=num_frame_slots(radar))
    return radar.replace(waveform=waveform, transmitters=radar.transmitters[:1], multiplexing="tdm", code_phases=None)
