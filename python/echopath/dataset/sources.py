"""Where the frames of a dataset come from when they are asked for: its files, or its template again."""
from __future__ import annotations

import tempfile
import warnings
from pathlib import Path
from typing import Protocol

from ..frame.frame import Frame
from ..frame.maps import FrameMaps
from ..sequence import Sequence
from ..sequence.folder import frame_path
from ..sequence.keep import Keep, read_frame, write_frame
from .folder import scene_folder
from .template import Template


class Source(Protocol):
    """Gives frames; keep: what they hold, as `Sequence.save` says it."""

    keep: Keep

    def frame(self, scene: int, place: int) -> Frame | FrameMaps:
        """The frame at a place of a scene. Raises ep.FileError."""


class Files:
    """The files of frames in the folder of a dataset."""

    def __init__(self, folder: Path, keep: Keep):
        self.keep, self._folder = keep, folder

    def frame(self, scene: int, place: int) -> Frame | FrameMaps:
        """Read from its file; ep.FileError for a damaged one."""
        return read_frame(frame_path(scene_folder(self._folder, scene), place), self.keep)


class Remade:
    """Frames that are simulated again, as a dataset of the same template with keep = "all" has them: the same bits."""

    keep: Keep = "all"

    def __init__(self, template: Template):
        self._template = template
        self._latest: tuple[int, Sequence] | None = None  # number of a scene, and its frames

    def _sequence_of(self, scene: int) -> Sequence:
        """The latest is kept, since frames are asked for scene by scene."""
        if self._latest is None or self._latest[0] != scene:
            self._latest = scene, self._template.sequence(scene)
        return self._latest[1]

    def frame(self, scene: int, place: int) -> Frame | FrameMaps:
        """Simulated, then written and read: files leave out paths that carry next to nothing."""
        sequence = self._sequence_of(scene)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # as when it was made; what a frame warns of is in its checks
            made = sequence[place]
        with tempfile.TemporaryDirectory(prefix="echopath-") as folder:
            path = frame_path(Path(folder), place)
            write_frame(made, path, self.keep)
            return read_frame(path, self.keep)
