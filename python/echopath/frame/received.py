"""What the receiver of a frame makes of each of its parts."""
from __future__ import annotations

from ..arguments.settings import FRAME_KEYWORDS
from ..paths.subset import subset
from ..receiver.chain import transmitted_code
from ..receiver.parts import receive_parts
from ..signals.parts import ONLY_PARTITION
from ..transmit import coded_cube, is_coded


def received_parts(frame) -> dict:
    """{partition: {part: cube}} in sqrt(W), which add up to what the receiver gives (`Frame.received`)."""
    partitions = frame.parts or {ONLY_PARTITION: {"other": frame.cube}}
    rain = {} if frame.rain_cube is None else {"rain": frame.rain_cube}
    return {partition: receive_parts({**_arriving(frame, partition, parts), **rain}, frame.radar, seed=frame.noise_seed,
                                     start_time=frame.paths.frame.start_time, interference=frame.interference_cube)
            for partition, parts in partitions.items()}


def _arriving(frame, partition: str, parts: dict) -> dict:
    """{part: cube} as it comes to the receivers: of transmitters that send at once their sum."""
    if not is_coded(frame.radar):
        return parts
    settings = {name: getattr(frame, name) for name in FRAME_KEYWORDS}
    code = transmitted_code(frame.radar)
    return {name: coded_cube(_paths_of(frame, partition, index), frame.radar, cube, code=code, **settings)
            for index, (name, cube) in enumerate(parts.items())}


def _paths_of(frame, partition: str, index: int):
    if partition not in frame.part_of_path:
        return frame.paths
    return subset(frame.paths, frame.part_of_path[partition] == index)
