"""Rows of files of trajectories: what a file says of everybody, whoever is asked for."""
from __future__ import annotations

from array import array
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ... import _core
from ...base.storage.files import file_state
from ...base.storage.lines import refuse
from ...base.storage.markup import PACKED
from .fcd import read_fcd
from .gpx import read_gpx
from .samples import Samples
from .table import read_table

MOST_SECONDS = 1e6     # from which on times are taken to count from some day long ago
LEAST_STEP = 1e-6      # s, from row to row of an object
SUFFIXES = (".csv", ".txt", ".tsv", ".xml", ".xml.gz", ".gpx")


@dataclass(frozen=True)
class Rows:
    """{name: Samples} of a file, in its order; is_geographic: whether places are latitudes, longitudes and heights."""

    tracks: dict[str, Samples]
    is_geographic: bool


def read_rows(path: Path) -> Rows:
    """Those of a file by its suffix, each object's in ascending order of times. Raises FileError."""
    suffix = path.suffix.lower()
    if suffix == ".xml" or path.name.lower().endswith(".xml" + PACKED):
        rows = Rows(read_fcd(path), False)
    elif suffix == ".gpx":
        rows = Rows(read_gpx(path), True)
    elif suffix in SUFFIXES:
        rows = Rows(*read_table(path))
    else:
        raise _core.FileError(f"{path}: must end in {', '.join(SUFFIXES)}")
    if not rows.tracks:
        raise _core.FileError(f"{path}: holds no positions")
    for samples in rows.tracks.values():
        _check_order(path, samples)
        samples.fill_heights()
    earliest = min(samples.times[0] for samples in rows.tracks.values())
    if earliest > MOST_SECONDS:
        for samples in rows.tracks.values():
            samples.times = array("d", [time - earliest for time in samples.times])
    return rows


def _check_order(path: Path, samples: Samples) -> None:
    """Raises FileError where the times of an object do not ascend."""
    wrong = np.flatnonzero(np.diff(samples.times) < LEAST_STEP)
    if len(wrong):
        before, after = samples.times[wrong[0]], samples.times[wrong[0] + 1]
        refuse(path, samples.lines[wrong[0] + 1], f"time: must be later than the {before:.12g} s of the row before of the same "
               f"object, got {after:.12g}")


class KeptRows:
    """Rows of files that are read again and again, as for the scenes of a dataset: each once, until it changes."""

    def __init__(self):
        self._kept: dict[Path, tuple[tuple | None, Rows]] = {}

    def of(self, path: Path) -> Rows:
        """Those of a file. Raises FileError."""
        state = file_state(path)
        if path not in self._kept or self._kept[path][0] != state:
            self._kept[path] = state, read_rows(path)
        return self._kept[path][1]

    def __getstate__(self) -> dict:
        return {"_kept": {}}  # another process reads them itself
