"""Changes of frame files as someone makes them who knows the layout: with check sums that fit."""
import zlib
from contextlib import contextmanager

import h5py
import numpy as np


def seal(dataset) -> None:
    """Gives a dataset the check sum of its values, as data/README.md has it, if it has values."""
    if dataset.dtype.kind == "O" or not dataset.shape or dataset.id.get_storage_size() == 0 < dataset.size:
        return
    dataset.attrs["crc32"] = np.uint32(zlib.crc32(np.ascontiguousarray(dataset[...]).tobytes()))


def seal_all(file) -> None:
    """Gives each dataset of a file its check sum."""
    file.visititems(lambda _, item: seal(item) if isinstance(item, h5py.Dataset) else None)


@contextmanager
def edited(path):
    """A frame file open for changes, which is valid again afterwards as far as check sums go."""
    with h5py.File(path, "r+") as file:
        yield file
        seal_all(file)
