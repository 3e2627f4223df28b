"""Datasets that are there, read when a frame is asked for."""

import json
import operator
import os
from collections.abc import Iterator, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, overload

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..arguments.checks import anything, array, checked, optional, path as folder_rule, refused
from ..base.text.counts import counted
from ..frame.frame import Frame
from ..frame.maps import FrameMaps
from ..sequence import StoredSequence, load_sequence
from ..sequence.contents import settings_of
from ..sequence.folder import NAME as CONTENTS, frame_path
from ..sequence.keep import Keep
from .address import is_address
from .arrays import lazy_arrays
from .classes import ClassName
from .folder import DRAWN, open_template, read_record, scene_folder
from .sources import Files, Remade, Source
from .template import Template

if TYPE_CHECKING:
    from ..base.classes.foreign_types import Dataset as XarrayDataset

_PLACES = array("[N]", kind="whole")


class DatasetFrame(NamedTuple):
    """A frame of a dataset.

    number: of the frame, from 0, the same in every run; scene: number of its scene; place: in the scene, from 0
    split: name of its split; frame: Frame where the dataset keeps all, else FrameMaps
    """

    number: int
    scene: int
    place: int
    split: str
    frame: Frame | FrameMaps


class Dataset:
    """The frames of a dataset that are done, made by `ep.dataset.open`: `len(dataset)`, `dataset[i]`, `for one in dataset`.

    Each is read when it is asked for, and kept by nobody; a slice is a Dataset, and so is `dataset[places]` of a list or an
    array of places, as of a shuffled batch.
    folder: Path; template: Template of it; numbers: of the frames, in their order here
    source: what reads or makes them, None: the files
    """

    def __init__(self, folder: Path, template: Template, numbers: list[int], source: Source | None = None):
        self.folder, self.template, self.numbers = folder, template, numbers
        self._source = source or Files(folder, template.settings.keep)

    @property
    def keep(self) -> Keep:
        """What a frame holds, "all", "maps" or "labels", as the template says it; "all" of `remade`."""
        return self._source.keep

    @checked(self=anything, folder=optional(folder_rule))
    def remade(self, folder: str | os.PathLike[str] | None = None) -> "Dataset":
        """The same frames, each simulated again from the template when it is asked for, with all that keep = "all" keeps.

        The bits are those of a dataset of this template with keep = "all". So a dataset that keeps maps or labels has exports
        that need the signals of all antennas, and any frame can be made again alone: `dataset.remade()[137]`.
        folder: of the files that the template names, None: that in which it was when the dataset was made, or where there
            is none (any more) that of the dataset. Raises TypeError naming it; frames ep.FileError where files are not there.
        Frames warn (RuntimeWarning) of scenes that are others now, since such files, or echopath, have changed.
        """
        template = self.template if folder is None else Template(self.template.path, Path(folder))
        return self._with(self.numbers, Remade(template, self.folder))

    def _with(self, numbers: list[int], source: Source | None = None) -> "Dataset":
        return Dataset(self.folder, self.template, numbers, source or self._source)

    def __len__(self) -> int:
        return len(self.numbers)

    @overload
    def __getitem__(self, place: int) -> DatasetFrame: ...
    @overload
    def __getitem__(self, place: slice | Sequence[int] | NDArray[np.integer[Any]]) -> "Dataset": ...

    def __getitem__(self, place: int | slice | Sequence[int] | NDArray[np.integer[Any]]) -> "DatasetFrame | Dataset":
        """The DatasetFrame at a place, or a Dataset of a slice or of places [N].

        Raises IndexError, TypeError naming `place` for what is neither, ep.FileError for a damaged file.
        """
        if isinstance(place, slice):
            return self._with(self.numbers[place])
        if isinstance(place, (list, tuple, np.ndarray)) and np.ndim(place):
            return self._with([self._number(one) for one in _PLACES("place", place).tolist()])
        number = self._number(_whole("place", "a whole number, a slice or places [N]", place))
        scene, at = divmod(number, self.template.settings.frames)
        return DatasetFrame(number, scene, at, self.template.split_of(scene), self._source.frame(scene, at))

    def _number(self, place: int) -> int:
        """Of the frame at a place."""
        if not -len(self) <= place < len(self):
            raise IndexError(f"a dataset of {len(self)} frames has no frame {place}")
        return self.numbers[place]

    def __iter__(self) -> Iterator[DatasetFrame]:
        return (self[place] for place in range(len(self)))

    def split(self, name: str) -> "Dataset":
        """The frames of a split. Raises ValueError naming `name` for one that the template has not."""
        if name not in self.template.settings.split:
            names = " or ".join(f"'{one}'" for one in self.template.settings.split)
            raise refused(ValueError, "name", names, name)
        per_scene = self.template.settings.frames
        return self._with([number for number in self.numbers if self.template.split_of(number // per_scene) == name])

    def of_scene(self, scene: int) -> "Dataset":
        """The frames here of the scene with that number; none where there are none. Raises nothing."""
        per_scene = self.template.settings.frames
        return self._with([number for number in self.numbers if number // per_scene == scene])

    @cached_property
    def scenes(self) -> list[int]:
        """The numbers of the scenes that have a frame here."""
        return sorted({number // self.template.settings.frames for number in self.numbers})

    @cached_property
    def paths_of_files(self) -> list[Path]:
        """The files of the frames, in their order here, for loops that read some arrays alone; also of `remade`."""
        places = [divmod(number, self.template.settings.frames) for number in self.numbers]
        return [frame_path(scene_folder(self.folder, scene), at) for scene, at in places]

    def sequence(self, scene: int) -> StoredSequence:
        """The frames of a scene in time, with all of its meshes. Raises IndexError for a scene that the template has not,
        ep.FileError where its frames are not there."""
        self._check_scene(scene)
        return load_sequence(scene_folder(self.folder, scene))

    def drawn(self, scene: int) -> dict[str, Any]:
        """{dotted path: value} of what the template drew for a scene.

        Raises IndexError for a scene that the template has not, ep.FileError where its file is not there.
        """
        self._check_scene(scene)
        path = scene_folder(self.folder, scene) / DRAWN
        try:
            values: dict[str, Any] = json.loads(path.read_bytes())
        except (OSError, ValueError, RecursionError) as error:
            raise _core.FileError(f"{path}: cannot be read ({error})") from None
        if not isinstance(values, dict):
            raise _core.FileError(f"{path}: must hold an object of JSON, {{path: value}}")
        return values

    def classes(self, scene: int) -> dict[str, ClassName]:
        """{name of an object: class} of a scene, as the template's `classes` say, else by actors, "static" for all else.

        The names are those of the scene's objects and, behind them, those that truth, labels and detections have besides, as of
        `objects` of the template's [labels], once a frame is made. Raises IndexError for a scene that the template has not.
        """
        self._check_scene(scene)
        contents = scene_folder(self.folder, scene) / CONTENTS
        settings = settings_of(contents) if contents.is_file() else {}
        asked = [settings.get(table) or {} for table in ("labels", "detections", "truth")]
        return self.template.classes(scene, tuple(pair for one in asked for pair in one.get("objects") or ()))

    def _check_scene(self, scene: int) -> None:
        if not 0 <= _whole("scene", "a whole number", scene) < self.template.settings.scenes:
            raise IndexError(f"scene: must be from 0 to {self.template.settings.scenes - 1}, got {scene}")

    def to_xarray(self) -> "XarrayDataset":
        """The maps of all frames as an xarray.Dataset that reads a frame when a value of it is asked for.

        power: f32 [frame, velocity, range] W, mean over channels, with noise; not with keep="labels"
        cell: i8, nothing, object or ghost; kind: i8, class of the object or of the ghost's object, -1: none; indices of the
            coordinates cell_names and kind_names, where there are labels
        For labels of the plane "range_azimuth", cell and kind are [frame, azimuth, range], as azimuth_power is: f32 W, with noise
        Coordinates: frame, the numbers; scene and split of each; velocity (m/s), range (m) and azimuth (rad, left positive) of
        the first frame. Needs xarray, raises ModuleNotFoundError without it, IndexError without frames, ValueError on reading a
        map of another size.
        """
        return lazy_arrays(self)

    def __repr__(self) -> str:
        frames, scenes = counted(len(self), "frame"), counted(len(self.scenes), "scene")
        return f"Dataset('{self.folder}', {frames} of {scenes}, keep='{self.keep}')"


def dataset_rule(argument: str, value: Any) -> Dataset:
    """A Dataset, for `checked`. Raises TypeError naming the argument for anything else."""
    if not isinstance(value, Dataset):
        raise refused(TypeError, argument, "a Dataset of ep.dataset.open", value)
    return value


def _whole(argument: str, rule: str, value: Any) -> int:
    """A whole number. Raises TypeError naming the argument and the rule for anything else."""
    try:
        return operator.index(value)
    except TypeError:
        raise refused(TypeError, argument, rule, value) from None


@checked(folder=folder_rule)
def open(folder: str | os.PathLike[str]) -> Dataset:
    """The dataset that `ep.dataset.make` or `echopath dataset` wrote to a folder, or has written so far.

    folder: of the dataset, in the file system. Returns a Dataset of all frames of the scenes that are done. Raises ep.FileError
    where it is none, or an address, whose files are to be copied to a folder first.
    """
    if is_address(os.fspath(folder)):
        raise _core.FileError(f"{folder}: is an address; copy it to a folder first, as `get` of fsspec.core.url_to_fs does")
    folder = Path(folder).absolute()  # frames are read later, maybe in another working folder
    template = open_template(folder)
    frames = template.settings.frames
    done = [scene for scene in range(template.settings.scenes) if read_record(folder, scene).state == "done"]
    return Dataset(folder, template, [scene * frames + place for scene in done for place in range(frames)])
