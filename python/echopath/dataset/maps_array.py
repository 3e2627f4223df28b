"""An array over the frames of a dataset, for xarray."""
from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from xarray.backends import BackendArray
from xarray.core import indexing

if TYPE_CHECKING:
    from .opened import Dataset, DatasetFrame


class MapsArray(BackendArray):
    """[F, V, R], which xarray indexes without reading more than the frames it asks for. It pickles, for workers of any kind."""

    def __init__(self, dataset: Dataset, read: Callable[[DatasetFrame], NDArray[Any]], shape: tuple[int, ...], dtype: str):
        """read: map of a frame, of type `dtype`"""
        self._dataset, self._read_frame = dataset, read
        self.shape, self.dtype = shape, np.dtype(dtype)

    def __getitem__(self, key: Any) -> Any:
        return indexing.explicit_indexing_adapter(key, self.shape, indexing.IndexingSupport.BASIC, self._read)

    def _read(self, key: tuple[Any, ...]) -> NDArray[Any]:
        places = np.arange(self.shape[0])[key[0]]
        if not np.ndim(places):
            return np.asarray(self._one(int(places))[key[1:]])
        empty = np.empty((0, *self.shape[1:]), self.dtype)[(slice(None), *key[1:])]
        return np.stack([self._one(int(place))[key[1:]] for place in places]) if len(places) else empty

    def _one(self, place: int) -> NDArray[Any]:
        values = self._read_frame(self._dataset[place])
        if values.shape != self.shape[1:]:
            raise ValueError(f"dataset: must have maps of one size, got {self.shape[1:]} and {values.shape} in frame "
                             f"{self._dataset.numbers[place]}")
        return values
