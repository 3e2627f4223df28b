"""What the files of a sequence keep of a frame."""
from __future__ import annotations

from pathlib import Path
from typing import Literal

from ..frame.frame import Frame
from ..frame.maps import FrameMaps, maps_of
from ..frame_file import load_frame, min_power_of_budget, save_frame
from ..frame_file.maps import load_maps, save_maps

Keep = Literal["all", "maps", "labels"]


def write_frame(frame: Frame, path: Path, keep: Keep) -> None:
    """Writes the file of a frame, whole or not at all. Raises ep.FileError."""
    if keep == "all":
        save_frame(frame, path, min_power=min_power_of_budget(frame))
    else:
        save_maps(maps_of(frame, with_power=keep == "maps"), path)


def read_frame(path: Path, keep: Keep) -> Frame | FrameMaps:
    """Reads the file of a frame: the same bits. Raises ep.FileError."""
    return load_frame(path) if keep == "all" else load_maps(path)
