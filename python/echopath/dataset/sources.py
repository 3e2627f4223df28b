"""Where the frames of a dataset come from when they are asked for: its files, or its template again."""
from __future__ import annotations

import tempfile
import warnings
from pathlib import Path
from typing import Protocol

from ..base.process.callers import warn_user
from ..frame.frame import Frame
from ..frame.maps import FrameMaps
from ..sequence import Sequence
from ..sequence.folder import NAME as CONTENTS, frame_path
from ..sequence.keep import Keep, read_frame, write_frame
from .folder import read_or_nothing, scene_folder
from .scene_work import differs_from
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

    def __init__(self, template: Template, folder: Path):
        self._template, self._folder = template, folder
        self._latest: tuple[int, Sequence] | None = None  # number of a scene, and its frames

    def _sequence_of(self, scene: int) -> Sequence:
        """The latest is kept, since frames are asked for scene by scene."""
        if self._latest is None or self._latest[0] != scene:
            sequence = self._template.sequence(scene)
            self._warn_of_another(sequence, scene)
            self._latest = scene, sequence
        return self._latest[1]

    def _warn_of_another(self, sequence: Sequence, scene: int) -> None:
        """Where files that the template names are not those of which the dataset was made, or echopath is not."""
        kept = read_or_nothing(scene_folder(self._folder, scene) / CONTENTS)
        if kept and (differing := differs_from(self._template, sequence, kept)):
            warn_user(f"scene {scene}: made again, it is another one than that of the dataset ({differing}): files that the "
                      "template names, or echopath, have changed since")

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
