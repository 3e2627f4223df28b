"""What the exports of datasets share: folders that are there whole or not at all, and detections that have directions."""
from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..._core import Radar
from ...arguments import part_names
from ...arguments.checks import refused
from ...arguments.part_names import LEAKAGE
from ...base.storage.files import folder_written_whole, require_writable
from ...detections.detections import Detections
from ...frame.detections import detect_frame
from ...frame.frame import Frame
from ...truth.cross_section import cross_section_dbsm
from ..opened import Dataset, DatasetFrame


@contextmanager
def exported(dataset: Dataset, folder: str | os.PathLike[str], name: str) -> Iterator[Path]:
    """Yields a new folder that gets a name within `folder` when the block ends well; what a killed export left is removed.

    Raises ValueError naming `dataset` where that has no frames, and `folder` where it has a folder of that name; ep.FileError.
    """
    require_writable(folder, "folder")
    root = Path(folder) / name
    if root.exists():
        raise refused(ValueError, "folder", f"one that has no folder '{name}' yet", str(folder))
    if len(dataset) == 0:
        raise refused(ValueError, "dataset", "one with a frame at least", dataset)
    with folder_written_whole(root) as begun:
        yield begun


def are_echoes(found: Detections) -> NDArray[np.bool_]:
    """Which detections are echoes of the scene, [D]: neither noise nor what comes in beside them, as interference, rain,
    leakage and residues of codes do."""
    return ~(found.is_noise | np.isin(found.part, part_names.BESIDE))


def detections_of(dataset: Dataset, one: DatasetFrame) -> Detections:
    """The detections of a frame with signals or with detections. Raises ValueError naming `dataset` for any other, and where
    its antennas tell no azimuths apart."""
    found = one.frame.detections
    if found is None and isinstance(one.frame, Frame):
        found = detect_frame(one.frame)
    if not isinstance(found, Detections):
        raise refused(ValueError, "dataset", 'of a template with [detections] or keep = "all", or its remade()',
                      str(dataset.folder))
    if len(found) and np.isnan(found.azimuth).any():
        raise refused(ValueError, "dataset", "of a radar whose antennas tell azimuths apart", "directions that are not known")
    return found


def cross_sections_dbsm(found: Detections, radar: Radar, time: float) -> NDArray[np.float64]:
    """[D] dB re 1 m^2 of detections whose directions are known, by the radar equation with the gains of the first antennas.

    It does not hold of what leaks from antenna to antenna, nor nearer than a wavelength: NaN.
    radar: that the detections are of, as it stands at `time` in s
    """
    world = radar.world_from_radar(time)
    places = found.points @ world[:3, :3].T + world[:3, 3]
    holds = (found.range >= radar.waveform.wavelength) & (found.part != LEAKAGE)
    return np.where(holds, cross_section_dbsm(found.power, radar, places, time), np.nan)
