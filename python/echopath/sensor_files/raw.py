"""Raw data as the DCA1000 writes it (TI's SWRA581 and the readers that it lists).

Signed 16-bit words, least byte first: frame by frame, slot by slot in time, and then by the lanes of the sensor's serial port.
Two lanes (xWR16xx, xWR18xx, xWR68xx, AWR2243): receiver by receiver, sample by sample; of complex samples two real parts, then
two imaginary ones, I0 I1 Q0 Q1; of real ones one word each. Four lanes (xWR12xx, xWR14xx): sample by sample, the receivers side
by side; of complex samples the real parts of four receivers, then their imaginary ones; lanes without a receiver hold 0.
With Adc(q_first=True) imaginary parts stand before real ones, as of sensors that stream with SampleSwap 1 (adcbufCfg).
"""
from __future__ import annotations

import os
from collections.abc import Iterable, Iterator

import numpy as np

from .. import _core
from ..arguments.checks import checked, path, refused
from ..arguments.iterables import iterable
from ..base.process.callers import warn_user
from ..base.storage.files import require_readable, written_whole
from ..base.text.counts import counted
from ..frame.frame import Frame
from ..receiver.chain import Reception
from ..receiver.converter import converted, cube_of, step_of
from ..receiver.settings import Adc
from ..transmit import signal_shape

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
            if not isinstance(frame, Frame):
                raise refused(TypeError, "frames", "frames with their signals", frame)
            if frame.cube is None:
                raise refused(ValueError, "frames", "frames with their signals", frame)
            size += file.write(raw_bytes(frame.received, frame.radar))
    return size


@checked(path=path)
def load_raw(path: str | os.PathLike[str], radar: _core.Radar) -> Iterator[Reception]:
    """The frames of a file that a DCA1000 recorded, or `save_raw` wrote, each read when it is asked for.

    path: of the file; radar: that it is of, as `load_radar` sets it up, whose `adc` tells how the words are ordered
    Returns an iterator over Receptions, as `Frame.received` is one: the codes, and the cube that they stand for by the full scale
    and the `gain_db` of the `adc`, [tx, rx, chirp, sample] in sqrt(W) at the antenna, [1, rx, slots, sample] of transmitters
    that send at once. Raises ep.FileError when the file cannot be read or holds no whole frame, ValueError as `save_raw` does.
    Warns (RuntimeWarning) where the file ends within a frame, as one of another radar may, and of levels that nobody knows: a
    gain that was chosen for each frame, as without an `adc`, is not in the file.
    """
    shape, adc = _slot_shape(radar), _adc_of(radar)
    length = 2 * _num_words(shape, adc)
    require_readable(path)
    try:
        with open(path, "rb") as file:
            count, rest = divmod(os.fstat(file.fileno()).st_size, length)
    except OSError as error:
        raise _core.FileError(f"{path}: cannot be read ({error.strerror})") from None
    if count == 0:
        raise _core.FileError(f"{path}: must hold {length:,} bytes, a frame of that radar, got {rest:,}")
    if adc.automatic_gain:
        warn_user("radar.receiver.adc: has no gain of its own, and the one chosen for each frame is not in the file: cubes are "
                  f"scaled as if it were {adc.gain_db:g} dB; give the radar an adc with the gain_db of the sensor")
    if rest:
        warn_user(f"{path}: ends within a frame: {rest:,} of {length:,} bytes are left after {counted(count, 'frame')}")
    return (_reception_of(np.fromfile(path, "<i2", length // 2, offset=place * length), shape, radar) for place in range(count))


def raw_bytes(received: Reception, radar: _core.Radar) -> bytes:
    """The words of one frame; received: of `receive`, for that radar. Raises ValueError for an odd number of samples in two
    lanes, and for more receivers than lanes in four."""
    shape, adc, codes = _slot_shape(radar), _adc_of(radar), received.codes
    if codes is None:
        codes = converted(received.cube, radar.waveform, DEFAULT_ADC)[1]
    # [tx, rx, chirp, sample, branch] -> [slot, rx, sample, branch]
    by_slot = np.moveaxis(codes, (2, 0, 1), (0, 1, 2)).reshape(shape)
    if adc.q_first:
        by_slot = by_slot[..., ::-1]
    return (_to_four_lanes if adc.lanes == 4 else _to_two_lanes)(by_slot).astype("<i2").tobytes()


def _reception_of(words: np.ndarray, shape: tuple, radar) -> Reception:
    """The reverse of `raw_bytes`."""
    adc = _adc_of(radar)
    by_slot = (_from_four_lanes if adc.lanes == 4 else _from_two_lanes)(words, shape)
    if adc.q_first:
        by_slot = by_slot[..., ::-1]
    num_tx, num_rx, num_chirps, num_samples = signal_shape(radar)
    codes = np.moveaxis(by_slot.reshape(num_chirps, num_tx, num_rx, num_samples, -1), (0, 1, 2), (2, 0, 1))
    unused = 16 - adc.bits  # upper bits of a word, to which not every sensor extends the sign
    codes = np.ascontiguousarray(codes, np.int16) << unused >> unused
    return Reception(cube_of(codes, step_of(radar.waveform, adc, adc.gain_db)), codes, adc.gain_db)


def _adc_of(radar) -> Adc:
    return DEFAULT_ADC if radar.receiver is None or radar.receiver.adc is None else radar.receiver.adc


def _slot_shape(radar) -> tuple[int, int, int, int]:
    """[slot, rx, sample, branch] of a frame. Raises ValueError where the lanes of the `adc` do not take it."""
    num_tx, num_rx, num_chirps, num_samples = signal_shape(radar)
    lanes, branches = _adc_of(radar).lanes, 1 if radar.waveform.real else 2
    if lanes == 4 and num_rx > 4:
        raise refused(ValueError, "radar.receivers", "4 at most: each has a lane of its own", num_rx)
    if lanes == 2 and branches == 2 and num_samples % 2:
        raise refused(ValueError, "radar.waveform.num_samples", "even: samples are written in pairs", num_samples)
    return num_chirps * num_tx, num_rx, num_samples, branches


def _num_words(shape: tuple, adc: Adc) -> int:
    slots, num_rx, num_samples, branches = shape
    return slots * (4 if adc.lanes == 4 else num_rx) * num_samples * branches


def _to_two_lanes(codes):
    """Of codes [slot, rx, sample, branch]: pairs of samples, a branch after the other."""
    slots, num_rx, num_samples, branches = codes.shape
    if branches == 1:
        return codes
    return np.swapaxes(codes.reshape(slots, num_rx, num_samples // 2, 2, branches), 3, 4)


def _from_two_lanes(words, shape: tuple):
    slots, num_rx, num_samples, branches = shape
    if branches == 1:
        return words.reshape(shape)
    return np.swapaxes(words.reshape(slots, num_rx, num_samples // 2, branches, 2), 3, 4).reshape(shape)


def _to_four_lanes(codes):
    """Of codes [slot, rx, sample, branch]: [slot, sample, branch, lane]."""
    slots, num_rx, num_samples, branches = codes.shape
    lanes = np.zeros((slots, num_samples, branches, 4), codes.dtype)
    lanes[..., :num_rx] = np.moveaxis(codes, 1, 3)
    return lanes


def _from_four_lanes(words, shape: tuple):
    slots, num_rx, num_samples, branches = shape
    return np.moveaxis(words.reshape(slots, num_samples, branches, 4)[..., :num_rx], 3, 1)
