"""Frame files: damaged bytes, and changes of their structure."""
from __future__ import annotations

import contextlib
import pickle
from collections.abc import Callable
from pathlib import Path
from random import Random
from typing import NamedTuple

import h5py
import numpy as np

import echopath as ep
from echopath.frame.maps import maps_of
from echopath.frame_file.maps import load_maps, save_maps
from fuzz.folder import memory_folder
from fuzz.mutate import damaged
from fuzz.seeds import frames
from support.files.frame_edits import seal

ODD_VALUES = [0, -1, 1, 2**31, 2**63 - 1, -2**63, 255, 65535, 0.0, -0.1, float("nan"), float("inf"), 1e308, 1e19, 1 + 2j, True,
              "", "x", "linear", "T . R", "{}", "[]",
              "null", '{"zero_pad": 1000000}', '{"window": "hann", "zero_pad": 1}', "a" * 70000]
ODD_ATTRIBUTES = [*ODD_VALUES, np.zeros(3), np.array([[1, 2]]), h5py.Empty("f8"), ["a", "b"], np.bytes_(b"\xff\xfe"),
                  np.void(b"abc")]
ODD_TYPES = ["f4", "f8", ">f8", "i1", "i4", "i8", "u1", "u2", "u4", "u8", "c8", "c16", "S3", "V5", h5py.string_dtype(), "b1",
             h5py.vlen_dtype("i4"), h5py.ref_dtype, [("a", "f8"), ("b", "i4")]]


class _Seed(NamedTuple):
    """A file: its bytes, the names of its items, what reads and writes it, and the bytes of what it gives."""

    content: bytes
    names: list
    load: Callable
    save: Callable
    expected: bytes


class _Seeds:
    """Files of frames: whole, their records alone, and the small files of sequences, which have maps and labels alone."""

    def __init__(self):
        self._folder = memory_folder()
        self.folder = Path(self._folder.name)
        made = frames()
        maps = [maps_of(frame, with_power) for frame in made for with_power in (True, False)]
        self._kinds = [[self._seed(one, load, save) for one in several] for several, load, save in (
            (made, ep.load_frame, ep.save_frame), (made, ep.load_frame, _save_record), (maps, load_maps, save_maps))]

    def _seed(self, one, load, save) -> _Seed:
        path, again = self.folder / "seed.h5", self.folder / "again.h5"
        save(one, path)
        content, found = path.read_bytes(), load(path)
        expected = pickle.dumps(found)
        save(found, again)
        assert again.read_bytes() == content, "what is read back is written as it was"
        return _Seed(content, _names_in(path), load, save, expected)

    def choose(self, random: Random) -> _Seed:
        """One in eight is whole, half are of maps: what a case costs goes by the items of its file."""
        return random.choice(random.choice((self._kinds[0],) + 3 * (self._kinds[1],) + 4 * (self._kinds[2],)))

    def check(self, path: Path, seed: _Seed, *, may_differ: bool, is_written: bool = False) -> None:
        """Holds what a damaged file gives to what it must be: an error that names it, or the frame as it was.

        is_written: also saves a frame that may differ
        """
        try:
            frame = seed.load(path)
        except ep.FileError as error:
            assert str(error).startswith(f"{path}: ") and len(str(error)) > len(str(path)) + 8, f"says little: {error}"
            return
        assert may_differ or pickle.dumps(frame) == seed.expected, "loads as another frame"
        if is_written:
            with contextlib.suppress(ValueError, ep.FileError):
                seed.save(frame, self.folder / "again.h5")


def _save_record(frame, path) -> None:
    frame.paths.save(path)


def _names_in(path) -> list:
    names: list = []
    with h5py.File(path) as file:
        file.visit(names.append)
    return names


def feed_frame_bytes():
    """Cases in which bytes of a file are damaged: it is refused, or loads with all its values."""
    seeds = _Seeds()
    path = seeds.folder / "frame.h5"

    def case(number: int) -> None:
        random = Random(f"frame_bytes {number}")
        seed = seeds.choose(random)
        path.write_bytes(damaged(seed.content, random))
        seeds.check(path, seed, may_differ=False)

    return case


def feed_frame_structure():
    """Cases in which somebody edits a file: it is refused by ep.FileError, or loads; without its check sum as it was.

    Three in five get check sums that fit, so that the readers behind them see what was changed; one in eight is saved again.
    """
    seeds = _Seeds()
    path = seeds.folder / "frame.h5"

    def case(number: int) -> None:
        random = Random(f"frame_structure {number}")
        seed, is_sealed = seeds.choose(random), random.random() < 0.6
        path.write_bytes(seed.content)
        with h5py.File(path, "r+") as file:
            values_only = [_edit(file, random.choice(seed.names), is_sealed, seed.names, random)
                           for _ in range(random.choice((1, 1, 2)))]
        seeds.check(path, seed, may_differ=is_sealed or not all(values_only), is_written=random.random() < 1 / 8)

    return case


def _edit(file, name: str, is_sealed: bool, others: list, random: Random) -> bool:
    """Changes the item `name`, if it is still there; returns whether that was no more than values of a dataset."""
    try:
        item = file[name]
    except (KeyError, RuntimeError):  # gone, or a link that leads nowhere
        return False
    kind = random.randrange(10)
    values_only = kind <= 3 and isinstance(item, h5py.Dataset)
    if values_only:
        values_only = _change_value(item, random)
    elif kind <= 5:
        _change_attribute(random.choice((item, item.parent)), random)
    elif kind == 6:
        del file[name]
    elif kind == 7:
        file.move(name, name + random.choice("x0 "))
    elif kind == 8 and isinstance(item, h5py.Dataset):
        _retype(file, name, random)
    else:
        _put_other(file, name, random.choice(others), random)
    if is_sealed and item and kind in (0, 1, 2, 3, 4, 5, 8) and isinstance(item, h5py.Dataset):
        seal(file[name])
    return values_only


def _change_value(dataset, random: Random) -> bool:
    if not dataset.size or dataset.size > 1 << 20 or dataset.dtype.kind not in "iufcbS":
        return False
    values = dataset[...]
    at = random.randrange(values.size)
    value = random.choice(ODD_VALUES)
    try:
        with np.errstate(all="ignore"):
            values.flat[at] = value.encode() if isinstance(value, str) else value
    except (ValueError, OverflowError, TypeError):
        values.flat[at] = values.flat[random.randrange(values.size)]
    dataset[...] = values
    return True


def _change_attribute(item, random: Random) -> None:
    names = list(item.attrs) or ["new"]
    name = random.choice(names)
    if random.random() < 0.15 and name in item.attrs:
        del item.attrs[name]
        return
    value = random.choice(ODD_ATTRIBUTES)
    if isinstance(value, str) and random.random() < 0.8:
        value = np.bytes_(value.encode() or b" ")
    with contextlib.suppress(OSError):  # HDF5 itself refuses what is too large for it
        item.attrs[name] = value


def _retype(file, name: str, random: Random) -> None:
    shape, attributes = file[name].shape or (), dict(file[name].attrs)
    del file[name]
    dtype = random.choice(ODD_TYPES)
    shape = random.choice([shape, (0,), (1,), (), (3, 2), shape[1:], (*shape, 1), tuple(2 * size for size in shape), (1 << 40,)])
    is_huge = shape == (1 << 40,)
    dataset = file.create_dataset(name, shape, dtype, chunks=(1 << 20,) if is_huge else None)
    with contextlib.suppress(OSError):  # as above
        for key, value in attributes.items():
            dataset.attrs[key] = value


def _put_other(file, name: str, other: str, random: Random) -> None:
    """Something else stands where `name` was: another item, a link, an empty group."""
    del file[name]
    kind = random.randrange(5)
    if kind == 0 or other not in file:
        file.create_group(name)
    elif kind == 1:
        file[name] = file[other]
    elif kind == 2:
        file[name] = h5py.SoftLink("/" + random.choice((other, name, "nowhere")))
    elif kind == 3:
        file[name] = h5py.ExternalLink(random.choice(("nowhere.h5", "seed.h5")), "/" + other)
    else:
        file.create_dataset(name, data=h5py.Empty("f8"))
