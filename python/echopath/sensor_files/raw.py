"""Raw data as the DCA1000 writes it behind sensors of two lanes (xWR16xx, xWR18xx, xWR68xx, AWR2243).

Signed 16-bit words, least byte first: frame by frame, slot by slot in time, receiver by receiver, sample by sample; of complex
samples two real parts, then two imaginary ones: I0 I1 Q0 Q1 (SWRA581, figure 12); of real ones one word each.
"""
from __future__ import annotations

import os
from collections.abc import Iterable

import numpy as np

from .. import _core
from ..checks import checked, path, refused
from ..files import written_whole
from ..frame import Frame
from ..iterables import iterable
from ..receiver.chain import Reception
from ..receiver.converter import converted
from ..receiver.settings import Adc

# Of sensors without one in their Receiver: nothing but rounding to 16 bits, 6 dB below full scale.
DEFAULT_ADC = Adc(bits=16, automatic_gain=True)


def _frames_rule(argument: str, value):
    return [value] if isinstance(value, Frame) else iterable(argument, value, "a Frame, or some of them")


@checked(frames=_frames_rule, path=path)
def save_raw(frames: Frame | Iterable[Frame], path: str | os.PathLike[str]) -> int:
    """Writes what the converter of a sensor gives as the DCA1000 would, frame after frame (see `sensor_files/raw.py`).

    Without an `adc` in the Receiver of the radar, 16 bits that the largest sample of each frame fills but for 6 dB.
    frames: a Frame with its signal, or some: they are written as they come
    path: of the file, which is written whole or not at all
    Returns the number of bytes. Raises ep.FileError when the file cannot be written, ValueError for frames without signals,
    and for an odd number of complex samples in a chirp.
    """
    size = 0
    with written_whole(path) as temporary, open(temporary, "wb") as file:
        for frame in frames:
            if not isinstance(frame, Frame) or frame.cube is None:
                raise refused(TypeError, "frames", "frames with their signals", frame)
            size += file.write(raw_bytes(frame.received, frame.radar))
    return size


def raw_bytes(received: Reception, radar: _core.Radar) -> bytes:
    """The words of one frame; received: of `receive`, for that radar. Raises ValueError for an odd number of samples."""
    codes = received.codes
    if codes is None:
        codes = converted(received.cube, radar.waveform, DEFAULT_ADC, None)[1]
    # [tx, rx, chirp, sample, branch] -> [slot, rx, sample, branch]
    by_slot = np.moveaxis(codes, (2, 0, 1), (0, 1, 2)).reshape(-1, *codes.shape[1:2], *codes.shape[3:])
    if radar.waveform.real:
        return by_slot.astype("<i2").tobytes()
    num_samples = by_slot.shape[2]
    if num_samples % 2:
        raise refused(ValueError, "radar.waveform.num_samples", "even: samples are written in pairs", num_samples)
    pairs = by_slot.reshape(*by_slot.shape[:2], num_samples // 2, 2, 2)
    return np.swapaxes(pairs, 3, 4).astype("<i2").tobytes()
