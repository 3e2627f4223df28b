"""Frames in time: which there are, and each of them when it is shown."""
from __future__ import annotations

import dataclasses
import glob
import os
import re
from collections.abc import Callable
from pathlib import Path

import echopath as ep
from echopath.frame_file import KeptMeshes
from echopath.frame_file.container import SEQUENCE, kind_of, our_file
from echopath.frame_file.h5 import read_attribute, read_group
from echopath.frame_file.maps import load_maps
from echopath.sequence.folder import NAME as SEQUENCE_NAME, frame_path

from .inputs import ViewInput, from_file, from_frame
from .maps_input import from_maps

PATTERN_LETTERS = "*?["
FRAMES_OF_A_FOLDER = "*.h5"


@dataclasses.dataclass(frozen=True)
class Moment:
    """A frame of a time line.

    name: as it is shown; start_time: s; path: of its file; stored: StoredSequence that it belongs to, None: to none
    remake: callable () -> Frame, which is shown in place of what the file keeps; None: the file is shown
    """

    name: str
    start_time: float
    path: Path
    stored: object = dataclasses.field(default=None, compare=False)
    remake: Callable | None = dataclasses.field(default=None, compare=False)

    def read(self, meshes: KeptMeshes | None = None) -> ViewInput:
        """What is shown of it; meshes: of the frame before, to be shared, None: of none. Raises ep.FileError."""
        if self.remake is not None:
            return self._remade()
        if self.stored is None or self.stored.keep == "all":
            return from_file(self.path, meshes)
        return from_maps(load_maps(self.path), self.stored, title=str(self.path))

    def _remade(self) -> ViewInput:
        try:
            return from_frame(self.remake(), title=self.name)
        except ValueError as error:  # a file that the template names is no more
            raise ep.FileError(f"{self.name}: {error}") from None


class TimeLine:
    """The frames that are there, in order; `refresh` finds those that were written since.

    None is kept but for its meshes: reading them takes most of the time that reading a frame does, and a film has the same
    ones in all of its files.
    title: of what they are; moments: tuple of Moment; expected: how many there will be, None: nobody knows
    first: place of the frame that `read_first` has read; failure: what went wrong and has not been told yet, "": nothing
    """

    def __init__(self, title: str, find: Callable, expected: int | None = None):
        """find: callable () -> list of Moment that are there now"""
        self.title, self._find, self.expected = title, find, expected
        self.moments: tuple = ()
        self.first, self.failure = 0, ""
        self.meshes = KeptMeshes()
        self.refresh()

    def __len__(self) -> int:
        return len(self.moments)

    def refresh(self) -> bool:
        """Whether there are other frames now than there were."""
        found = tuple(self._find())
        is_other, self.moments = found != self.moments, found
        return is_other

    def read(self, place: int) -> ViewInput:
        """The frame at a place. Raises ep.FileError."""
        return self.moments[place].read(self.meshes)

    def read_first(self) -> ViewInput:
        """The first frame that can be read. Raises ep.FileError where none can: what is wrong with the first of all."""
        failures = []
        for place in range(len(self)):
            try:
                view_input = self.read(place)
            except ep.FileError as error:
                failures.append(error)
                continue
            self.first = place
            self.failure = str(failures[0]) if failures else self.failure
            return view_input
        raise failures[0]

    def close(self) -> None:
        """Ends whatever makes further frames."""


def time_line_of(what) -> TimeLine | None:
    """The time line of a folder, of a pattern such as "out/*.h5", of a list of files, of one file of a whole sequence, of a
    StoredSequence or of a Dataset.

    None for anything else, such as the file of one frame. Raises ep.FileError where there is no frame yet or a folder is damaged.
    """
    if isinstance(what, ep.StoredSequence):
        return _checked(_of_stored(what))
    if not isinstance(what, (str, os.PathLike, list, tuple)) and isinstance(what, ep.dataset.Dataset):  # which is slow to import
        return _checked(_of_dataset(what.folder, what))
    if isinstance(what, (list, tuple)):
        files = [Path(name) for name in what]
        return _checked(TimeLine(f"{len(files)} files", lambda: _moments_of(files)))
    path = Path(what)
    if path.is_dir():
        return _checked(_of_folder(path))
    if path.is_file() and kind_of(path) == SEQUENCE:
        return _checked(_of_stored(ep.load_sequence(path)))
    if not path.exists() and any(letter in str(what) for letter in PATTERN_LETTERS):
        return _checked(TimeLine(str(what), lambda: _moments_of(map(Path, glob.glob(str(what))))))
    return None


def _checked(line: TimeLine) -> TimeLine:
    if not len(line):
        raise ep.FileError(f"{line.title}: holds no frame that is done")
    return line


def _of_folder(folder: Path) -> TimeLine:
    if (folder / SEQUENCE_NAME).exists():
        return _of_stored(ep.load_sequence(folder))
    try:
        return _of_dataset(folder)
    except ep.FileError as error:
        if any(folder.glob(FRAMES_OF_A_FOLDER)):
            return TimeLine(str(folder), lambda: _moments_of(folder.glob(FRAMES_OF_A_FOLDER)))
        raise ep.FileError(f"{folder}: holds neither frames (*.h5) nor a sequence nor a dataset ({error})") from None


def _of_stored(stored) -> TimeLine:
    return TimeLine(str(stored.path), lambda: written_frames(stored), len(stored))


def written_frames(stored) -> list[Moment]:
    """The frames of a StoredSequence that are there."""
    frames = enumerate(zip(stored.times, stored.paths_of_files, stored.is_there))
    return [Moment(f"frame {place}", float(time), path, stored) for place, (time, path, is_there) in frames if is_there]


def _of_dataset(folder: Path, given=None) -> TimeLine:
    """Scene after scene; given: ep.dataset.Dataset whose frames are shown, None: all that are done, those to come too.

    Frames of one that was `remade` are simulated again when they are shown; the strip of all has what the files keep.
    """
    numbers = None if given is None else set(given.numbers)
    is_remade = given is not None and given.keep != given.template.settings.keep
    per_scene = ep.dataset.open(folder).template.settings.frames

    def find():
        dataset = ep.dataset.open(folder)
        shown = [number for number in dataset.numbers if numbers is None or number in numbers]
        stored = {scene: dataset.sequence(scene) for scene in sorted({number // per_scene for number in shown})}
        return [_moment_in(dataset, folder, number, stored) for number in shown]

    def _moment_in(dataset, folder, number, stored):
        from echopath.dataset.folder import scene_folder  # late: all of `echopath.dataset` comes with it

        scene, place = divmod(number, per_scene)
        name = f"scene {scene} ({dataset.template.split_of(scene)}), frame {place}"
        remake = (lambda: given[given.numbers.index(number)].frame) if is_remade else None
        path = frame_path(scene_folder(folder, scene), place)
        return Moment(name, float(stored[scene].times[place]), path, stored[scene], remake)

    return TimeLine(str(folder), find)


def _moments_of(files) -> list[Moment]:
    """The frame files among some, by start time and name; what is no frame file, or not yet, is left out."""
    found = []
    for path in files:
        try:
            found.append(Moment(path.name, start_time_of(path), path))
        except ep.FileError:
            continue
    return sorted(found, key=lambda one: (one.start_time, [int(word) if word.isdecimal() else word
                                                           for word in re.split(r"(\d+)", one.name)]))


def start_time_of(path) -> float:
    """Start in s of the frame in a file with paths, from its head alone. Raises ep.FileError."""
    with our_file(path) as file:
        return read_attribute(read_group(read_group(file, "record"), "frame"), "start_time", float)
