"""xarray.open_dataset on what this program writes: entry point "xarray.backends" of the package (pyproject.toml).

Where no engine is named, netCDF4 comes first where it is installed, and takes each HDF5 file for itself; not folders.
"""
from __future__ import annotations

import os
from pathlib import Path

from xarray.backends import BackendEntrypoint

from ..frame_file.container import SEQUENCE, kind_of, our_file
from ..frame_file.maps import start_time_in_file
from ..frame_file.opening import SUFFIXES, file_and_group
from .arrays import dataset_of_files
from .folder import NAME
from .stored import StoredSequence


class Engine(BackendEntrypoint):
    """The maps of frames in time in a folder or one file, or of the file of one frame; see StoredSequence.to_xarray."""

    description = "Maps, labels and truth of frames that echopath simulated"
    open_dataset_parameters = ("filename_or_obj", "drop_variables")

    def open_dataset(self, filename_or_obj, *, drop_variables=None):
        """The Dataset of a path; drop_variables: a name or names that are left out. Raises ep.FileError."""
        dropped = [drop_variables] if isinstance(drop_variables, str) else drop_variables or []
        return _dataset(Path(os.fspath(filename_or_obj))).drop_vars(dropped, errors="ignore")

    def guess_can_open(self, filename_or_obj) -> bool:
        """Whether xarray may leave a path to this program, which then looks into it."""
        if not isinstance(filename_or_obj, (str, os.PathLike)) or "://" in str(filename_or_obj):
            return False
        path = Path(filename_or_obj)
        return (path / NAME).is_file() or (file_and_group(path)[0].suffix.lower() in SUFFIXES and kind_of(path) is not None)


def _dataset(path: Path):
    if path.is_dir() or kind_of(path) == SEQUENCE:
        return StoredSequence(path).to_xarray()
    with our_file(path) as file:
        time, has_truth = start_time_in_file(file), "truth" in file
    return dataset_of_files([path], [time], has_truth, {"path": str(path)})
