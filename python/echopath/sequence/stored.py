"""Frames in time, read from a folder or a file when they are asked for."""
from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..arguments.checks import checked, count, path as path_rule
from ..base.text.counts import counted
from ..frame.frame import Frame
from ..frame.maps import FrameMaps
from ..frame_file.frame import without_lists
from ..scene.scene import Scene
from ..truth import Truth
from ..weather import Weather
from .arrays import dataset_of, truth_of_files
from .keep import Keep, read_frame
from .lazy_maps import power_of
from .one_file import store_of
from .row import Row
from .starts import LONGEST, starts_in

if TYPE_CHECKING:
    from ..base.classes.foreign_types import Dataset


class StoredSequence(Row[Frame | FrameMaps]):
    """The frames of a folder or a file of `Sequence.save`, read when they are asked for; made by `load_sequence`.

    None is kept. `for frame in stored`, `stored[k]`, `len(stored)`; a slice is a StoredSequence. A frame is a Frame where the
    files keep all, else FrameMaps. One that has not been simulated yet raises ep.FileError.
    path: Path of the folder or the file; keep: "all", "maps" or "labels", what the files keep; scene, radar: what was simulated
    settings: {keyword: value} of `Sequence`, with those that it was not given; beside them `first_number` and `number_step`,
        which frames of the sequence these are, `keep` of `save`, and `weather`, that of the scene
    times: starts of the frames, [K] in s; interval: s, from start to start, None where `times` were given
    """

    def __init__(self, path: Path):
        path = path_rule("path", path)
        self.path = store_of(path).path
        self._store = store_of(Path(path).absolute())  # frames are read later, maybe in another working folder
        contents = self._store.contents()
        self.radar, self.settings = contents.radar, contents.settings
        self._scene = contents.scene
        self._take(self.settings)

    def _take(self, settings: dict[str, Any]) -> None:
        """Times and kind of the files; raises ep.FileError for settings that are none."""
        try:
            self.keep: Keep = settings["keep"]
            frames, first, step = (count(least, LONGEST)(name, settings[name]) for name, least in (
                ("frames", 0), ("first_number", 0), ("number_step", -LONGEST)))
            self._starts = starts_in(settings)
            self._of_place = range(first, first + step * frames, step)
            self._starts.require(self._of_place)
            if self.keep not in get_args(Keep):
                raise ValueError(f"keep {self.keep!r}")
            weather = settings.get("weather")
            self._weather = None if weather is None else Weather(**weather)
        except (KeyError, TypeError, ValueError) as error:
            raise _core.FileError(f"{self._store.head}: damaged settings ({error})") from None
        self._numbers = range(len(self._of_place))

    def _time_of(self, number: int) -> float:
        return super()._time_of(self._of_place[number])

    @property
    def interval(self) -> float | None:
        """From the start of one frame to that of the next in s, negative for a slice in reverse; None where `times` were
        given."""
        interval = super().interval
        return None if interval is None else interval * self._of_place.step

    @property
    def scene(self) -> Scene:
        """A copy of the scene that was simulated, in its weather and with its other radars."""
        return Scene(self._scene, weather=self._weather)

    @property
    def paths_of_files(self) -> list[Path]:
        """The files of the frames, [K], whether they are there or not.

        In one file of all they are its groups, `drive.h5/frames/000012`, which functions that read frame files take, too.
        """
        return [self._store.frame_path(number) for number in self._numbers]

    @property
    def is_done(self) -> NDArray[np.bool_]:
        """Whether each frame is there, with a file that is as long as it was written, [K]."""
        return np.array(self._store.are_whole(self._numbers), bool)

    @property
    def is_there(self) -> NDArray[np.bool_]:
        """Whether each frame has a file, [K], whole or not; who reads one that is damaged is told so."""
        return np.array(self._store.are_there(self._numbers), bool)

    def _item(self, place: int) -> Frame | FrameMaps:
        number = self._numbers[place]
        path = self._store.frame_path(number)
        if not self._store.is_there(number):
            self._refuse_removed()
            raise _core.FileError(f"{path}: has not been simulated yet; the run that made {self.path} goes on when it is "
                                  "called again")
        return read_frame(path, self.keep)

    def _refuse_removed(self) -> None:
        if not self._store.head.exists():
            raise _core.FileError(f"{self._store.head}: no such file any more: it was removed or renamed after the sequence had "
                                  "been opened")

    def _maps(self) -> tuple[int, Iterator[tuple], dict]:
        there = np.flatnonzero(self.is_there)
        if not there.size:
            self._refuse_removed()
        files, times = self.paths_of_files, self.times[there]
        paths = [files[place] for place in there]
        found = power_of(paths[0]) if paths else None
        if paths and found is None:
            raise ValueError(f"{self.path}: must keep maps to be drawn, keeps labels alone")
        levels = ((float(time), found.read_file(path).T, found.axes["velocity"], found.axes["range"])
                  for path, time in zip(paths, times))
        return len(paths), levels, {"window": without_lists(self.settings["window"]), "zero_pad": self.settings["zero_pad"]}

    @property
    def truth(self) -> Truth:
        """ep.Truth of all frames that are there, `frame` their places: read from the files, without their paths and signals.

        Raises ValueError where they keep none (`truth=True` of `Sequence` asks for it), ep.FileError for a damaged file.
        """
        return truth_of_files(self, np.flatnonzero(self.is_there))

    def to_xarray(self) -> Dataset:
        """The maps of all frames that are there as an xarray.Dataset, with names and units on every axis.

        power: f32 [time, range, velocity] in dBm, mean over channels, with noise; not of files of keep="labels"
        dominant, or dominant_NAME for each of several partitions: i16, index of the part; object, ghost: i16; indices of the
            coordinates dominant_names, object_names and ghost_names, the same in all frames; mask: bool; all
            [time, range, velocity] (or azimuth), -1: none; where there are labels
        truth_position [time, truth_object, truth_axis] and so on: the fields of Truth, where the files keep it
        Times are the starts of the frames in s. Nothing is held: `maps.power[3]` reads one file, `maps.power.mean("time")` all,
        `maps.load()` keeps them, 11 bytes for each cell of each frame, and `maps.chunk(time=1)` hands them to dask.
        `xarray.open_dataset(path, engine="echopath")` gives the same; without `engine` netCDF4, where it is installed, takes
        each HDF5 file for itself, and only a folder is safe. Needs xarray, raises ModuleNotFoundError without it, ep.FileError
        for a damaged file, here or where it is read, ValueError where no frame is there.
        """
        return dataset_of(self, np.flatnonzero(self.is_there))

    def __repr__(self) -> str:
        return (f"StoredSequence('{self.path}', {counted(len(self), 'frame')} {self._span()}, {int(self.is_done.sum())} done, "
                f"keep='{self.keep}')")

    def _repr_html_(self) -> str:
        from ..presentation.notebook import sequence_html

        facts = {"path": self.path, "kept": self.keep, "done": int(self.is_done.sum())}
        return sequence_html(self, "StoredSequence", facts)


@checked(path=path_rule)
def load_sequence(path: str | os.PathLike[str]) -> StoredSequence:
    """The frames that `Sequence.save` or `echopath run --frames` wrote to a folder or a file, or has written so far.

    path: of the folder, or of the file (.h5) of all frames
    Returns a StoredSequence. Raises ep.FileError where the folder has no sequence.h5, the file is no sequence, or is damaged.
    """
    return StoredSequence(Path(path))
