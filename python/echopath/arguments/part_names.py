"""Names of the parts of a signal that no path makes where they stand, which no part of the paths may take."""
from __future__ import annotations

from collections.abc import Iterable

INTERFERENCE, RAIN, LEAKAGE = "interference", "rain", "leakage"
RESIDUE = "residue"  # of the echoes of other transmitters, where `demultiplex` cannot tell codes apart
REST = "other"  # the part of all paths that no other part has
BESIDE = (INTERFERENCE, RAIN, LEAKAGE, RESIDUE)  # of which labels and detections have what stands in maps
NOISE, OFFSET, CONVERTER = "noise", "offset", "converter"
OF_RECEIVER = (INTERFERENCE, LEAKAGE, NOISE, OFFSET, CONVERTER)  # of which `receive_parts` adds what there is
_RESERVED = frozenset((*BESIDE, *OF_RECEIVER))


def require_free(names: Iterable[object], reserved: Iterable[str] = _RESERVED) -> None:
    """Raises ValueError for the name of a part that is one of those that stand for what no path makes."""
    for name in names:
        if name in reserved:
            raise ValueError(f"parts: must not be named {name!r}, as what no path makes is")


def require_names(partitions: dict) -> None:
    """Likewise of the parts of the paths in partitions {partition: {part: selection}}."""
    for parts in partitions.values():
        require_free(parts)
