"""An array over the files of frames, for xarray."""
from __future__ import annotations

from pathlib import Path

import numpy as np
from xarray.backends import BackendArray
from xarray.core.indexing import IndexingSupport, explicit_indexing_adapter

from .. import _core
from ..frame_file.container import our_file


class FramesArray(BackendArray):
    """[T, ...], one frame after the other; a frame is read when some of it is asked for, and kept by nobody."""

    def __init__(self, paths: list[Path], map):
        """paths: of the files [T]; map: Map"""
        self._paths, self._map = paths, map
        self.dtype = map.dtype
        self.shape = len(paths), *(len(map.axes[name]) for name in map.dims)

    def __getitem__(self, key):
        return explicit_indexing_adapter(key, self.shape, IndexingSupport.OUTER, self._read)

    def _read(self, key: tuple) -> np.ndarray:
        places, rows, columns = key
        chosen = np.arange(len(self._paths))[places]
        found = [self._frame(int(place))[rows][..., columns] for place in np.atleast_1d(chosen)]
        if np.ndim(chosen) == 0:
            return found[0]
        return np.stack(found) if found else np.empty((0, *self.shape[1:]), self.dtype)[:, rows][..., columns]

    def _frame(self, place: int) -> np.ndarray:
        path = self._paths[place]
        with our_file(path) as file:
            values = self._map.read(file, place)
            if values.shape != self.shape[1:]:
                wanted, held = list(self.shape[1:]), list(values.shape)
                raise _core.FileError(f"must have maps of {wanted} cells, as the first frame, has {held}")
        return values
