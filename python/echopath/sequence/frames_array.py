"""An array over the files of frames, for xarray."""
from __future__ import annotations

from pathlib import Path

import numpy as np
from xarray.backends import BackendArray
from xarray.core.indexing import IndexingSupport, explicit_indexing_adapter


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
        found = [self._map.read_file(self._paths[place], int(place))[rows][..., columns] for place in np.atleast_1d(chosen)]
        if np.ndim(chosen) == 0:
            return found[0]
        return np.stack(found) if found else np.empty((0, *self.shape[1:]), self.dtype)[:, rows][..., columns]
