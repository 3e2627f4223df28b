"""What the receiver of a frame makes of each of its parts."""
from __future__ import annotations

from .._core import Grouping
from ..arguments.part_names import RAIN, REST
from ..arguments.settings import FRAME_KEYWORDS
from ..base.classes.by_partition import ByPartition
from ..receiver.chain import transmitted_code
from ..receiver.parts import receive_parts
from ..signals.parts import ONLY_PARTITION
from ..transmit import code_signal, is_coded, slots_radar
from ..transmit.code import num_frame_slots
from ..transmit.signals import decompose_slots


def received_parts(frame) -> dict:
    """{partition: {part: cube}} in sqrt(W), which add up to what the receiver gives (`Frame.received`)."""
    partitions = frame.parts or {ONLY_PARTITION: {REST: frame.cube}}
    rain = {} if frame.rain_cube is None else {RAIN: frame.rain_cube}
    return ByPartition({partition: receive_parts({**_arriving(frame, partition, parts), **rain}, frame.radar,
                                                 seed=frame.noise_seed, start_time=frame.paths.frame.start_time,
                                                 interference=frame.interference_cube)
                        for partition, parts in partitions.items()})


def _arriving(frame, partition: str, parts: dict) -> dict:
    """{part: cube} as it comes to the receivers: of transmitters that send at once their sum."""
    if not is_coded(frame.radar):
        return parts
    if frame.cube.shape[2] != num_frame_slots(frame.radar):
        parts = _in_every_slot(frame, partition)
    code, waveform = transmitted_code(frame.radar), frame.radar.waveform
    whole = sum(parts.values()) if waveform.real else None
    return {name: code_signal(cube, code, waveform, whole) for name, cube in parts.items()}


def _in_every_slot(frame, partition: str) -> dict:
    """{part: cube [tx, rx, slots, sample]}, of one pass over all paths: a record of some has no new traces."""
    settings = {name: getattr(frame, name) for name in FRAME_KEYWORDS}
    grouping = Grouping.selections(list(frame.selections.get(partition, {}).items()))
    parts, = decompose_slots(frame.paths, slots_radar(frame.radar), [grouping], **settings)
    return parts
