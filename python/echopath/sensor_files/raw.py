"""Raw data as the DCA1000 writes it (TI's SWRA581 and the readers that it lists).

Signed 16-bit words, least byte first: frame by frame, slot by slot in time, and then by the lanes of the sensor's serial port.
Two lanes (xWR16xx, xWR18xx, xWR68xx, AWR2243): receiver by receiver, sample by sample; of complex samples two real parts, then
two imaginary ones, I0 I1 Q0 Q1; of real ones one word each. Four lanes (xWR12xx, xWR14xx): sample by sample, the receivers side
by side; of complex samples the real parts of four receivers, then their imaginary ones; lanes without a receiver hold 0.
With Adc(q_first=True) imaginary parts stand before real ones, as of sensors that stream with SampleSwap 1 (adcbufCfg).
"""
from __future__ import annotations

import os
from collections.abc import Iterable

import numpy as np

from .. import _core
from ..arguments.checks import checked, path, refused
from ..arguments.iterables import iterable
from ..base.storage.files import written_whole
from ..frame.frame import Frame
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
    path: of the file, which is written whole or not at all; its words are ordered by the lanes of the `adc`
    Returns the number of bytes. Raises ep.FileError when the file cannot be written, ValueError for frames without signals,
    and for an odd number of complex samples in a chirp of two lanes.
    """
    size = 0
    with written_whole(path, suffix=".part") as temporary, open(temporary, "wb") as file:
        for frame in frames:
            if not isinstance(frame, Frame) or frame.cube is None:
                raise refused(TypeError, "frames", "frames with their signals", frame)
            size += file.write(raw_bytes(frame.received, frame.radar))
    return size


def raw_bytes(received: Reception, radar: _core.Radar) -> bytes:
    """The words of one frame; received: of `receive`, for that radar. Raises ValueError for an odd number of samples in two
    lanes, and for more receivers than lanes in four."""
    codes = received.codes
    if codes is None:
        codes = converted(received.cube, radar.waveform, DEFAULT_ADC)[1]
    # [tx, rx, chirp, sample, branch] -> [slot, rx, sample, branch]
    by_slot = np.moveaxis(codes, (2, 0, 1), (0, 1, 2)).reshape(-1, *codes.shape[1:2], *codes.shape[3:])
    adc = _adc_of(radar)
    if adc.q_first:
        by_slot = by_slot[..., ::-1]
    return (_of_four_lanes if adc.lanes == 4 else _of_two_lanes)(by_slot).astype("<i2").tobytes()


def _adc_of(radar) -> Adc:
    return DEFAULT_ADC if radar.receiver is None or radar.receiver.adc is None else radar.receiver.adc


def _of_two_lanes(codes):
    """Of codes [slot, rx, sample, branch]: pairs of samples, a branch after the other."""
    slots, num_rx, num_samples, branches = codes.shape
    if branches == 1:
        return codes
    if num_samples % 2:
        raise refused(ValueError, "radar.waveform.num_samples", "even: samples are written in pairs", num_samples)
    return np.swapaxes(codes.reshape(slots, num_rx, num_samples // 2, 2, branches), 3, 4)


def _of_four_lanes(codes):
    """Of codes [slot, rx, sample, branch]: [slot, sample, branch, lane]."""
    slots, num_rx, num_samples, branches = codes.shape
    if num_rx > 4:
        raise refused(ValueError, "radar.receivers", "4 at most: each has a lane of its own", num_rx)
    lanes = np.zeros((slots, num_samples, branches, 4), codes.dtype)
    lanes[..., :num_rx] = np.moveaxis(codes, 1, 3)
    return lanes
