"""Arrays that a program has made of a frame file and keeps in it, so as not to make them again (layout: data/README.md).

They are never what a frame is: files without them hold the same frame, and what does not belong to it any more is not read.
"""
from __future__ import annotations

import functools
import hashlib
import os
import stat
from pathlib import Path

import numpy as np

from .. import _core
from ..base.storage.files import file_state, flush, written_whole
from .container import our_file
from .h5 import copy_items, read_array, read_attribute, read_group, reserve, write_array, write_attribute, writing
from .opening import reading

CORE = _core.__file__, file_state(_core.__file__)  # while this program was loaded: it may be built anew meanwhile
SOURCES = ("scene", "radar", "record")  # what all arrays are made of; of the map its axes and settings


def kept_arrays(path, state: tuple, name: str, version: int, dtypes: dict) -> dict | None:
    """The arrays [N] that `keep_arrays` wrote to a frame file; None where there are none, or none that belong to it.

    state: `file_state` from before the frame was read; a file that was written since holds arrays of another frame
    name: of their group; version: of how they are made; dtypes: {array: type, or types of which it has one}
    Arrays of another version, of another record, radar or map, and damaged ones are as if they were not there.
    """
    try:
        with our_file(path) as file:
            if name not in file:
                return None
            group = read_group(file, name)
            if read_attribute(group, "key", str) != _key(file, version):
                return None
            arrays = {array: _read(group, array, dtype) for array, dtype in dtypes.items()}
            return arrays if file_state(file.file.id.get_vfd_handle()) == state else None
    except _core.FileError:
        return None


def keep_arrays(path, state: tuple, name: str, version: int, arrays: dict) -> tuple | None:
    """Writes arrays into the group `name` of a frame file, in place of those that it has; returns the file's new `file_state`.

    state: `file_state` from before the frame was read that the arrays are made of
    The file is replaced whole or not at all, with the same frame. It stays as it is, and None is returned, where it cannot be
    written, has other names (hard links) or was written since it had `state`.
    """
    path = Path(os.path.realpath(path))
    try:
        if file_state(path) != state or not os.access(path, os.W_OK) or path.stat().st_nlink > 1:
            return None
        with written_whole(path) as temporary:
            _copy_with(path, temporary, name, version, arrays)
            os.chmod(temporary, stat.S_IMODE(path.stat().st_mode))
            flush(temporary)  # which takes seconds, and would leave them between the look at the file and its replacement
            written = file_state(temporary)
            if file_state(path) != state:
                raise _core.FileError(f"{path}: was written anew")
    except (OSError, _core.FileError):
        return None
    return written


def _copy_with(path, temporary, name: str, version: int, arrays: dict) -> None:
    with reading(path) as source, writing(temporary) as target:
        reserve(target, path.stat().st_size)
        copy_items(source, target, but=name)
        group = target.create_group(name)
        write_attribute(group, "key", _key(source, version))
        for array, values in arrays.items():
            write_array(group, array, values)


def _read(group, name: str, dtype):
    kinds = dtype if isinstance(dtype, tuple) else (dtype,)
    held = group[name].dtype if name in group else None
    return read_array(group, name, held if held in map(np.dtype, kinds) else kinds[0], (None,))


def _key(file, version: int) -> str:
    """Of all that arrays are made of: the check sums of its numbers, and its attributes."""
    digest = hashlib.sha256(f"{version} {_digest(*CORE)}".encode())
    for name in SOURCES:
        _add(digest, read_group(file, name))
    if "spectra" in file:
        spectra = read_group(file, "spectra")
        digest.update(read_attribute(spectra, "settings", str).encode())
        for axis in ("velocity", "range"):
            _add_attributes(digest, spectra[axis])
    return digest.hexdigest()


@functools.cache
def _digest(path: str, state: tuple) -> str:
    """Of the program's core, whose version stays the same from one change of its code to the next."""
    digest = hashlib.sha256(Path(path).read_bytes()).hexdigest()
    if file_state(path) != state:
        raise _core.FileError(f"{path}: was built anew since it was loaded")
    return digest


def _add(digest, item) -> None:
    """An item and what is below it, with their names."""
    digest.update(item.name.encode())
    _add_attributes(digest, item)
    if hasattr(item, "items"):
        for name in sorted(item):
            _add(digest, item[name])


def _add_attributes(digest, item) -> None:
    for name in sorted(item.attrs):
        digest.update(name.encode() + np.asarray(item.attrs[name]).tobytes())
