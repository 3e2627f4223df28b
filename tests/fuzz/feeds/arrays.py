"""Arrays for Paths.from_arrays."""
from __future__ import annotations

from random import Random

import numpy as np

import echopath as ep
from fuzz.seeds import frames

COLUMNS = ("hits", "offsets", "num_bounces", "diffuse", "weight", "stratum", "batch", "flags", "curved_cell", "jones")
ODD_NUMBERS = [0, 1, -1, 64, 65, 255, 65535, 2**31, 2**63 - 1, -2**63, 2**64 - 1, float("nan"), float("inf"), 1e30, -0.5, 1.5]
ODD_VALUES = [None, [], {}, "x", 1, [1, 2], np.zeros(3), np.zeros((2, 2)), np.array(5), np.array(["a"]), np.array([None]),
              object(), np.zeros(0), np.zeros(4, [("mesh_id", "u4")]), np.zeros(4, "V16"), np.zeros(4, "M8[s]"), b"abc", range(5)]


def feed_arrays():
    """Cases in which columns have other values, lengths or types: refused by name, or paths that can be used."""
    seeds = [_columns(frame.paths) for frame in frames()]

    def case(number: int) -> None:
        random = Random(f"arrays {number}")
        arguments = dict(random.choice(seeds))
        for _ in range(random.choice((1, 1, 2))):
            _change(arguments, random)
        try:
            made = ep.Paths.from_arrays(**arguments)
        except (ValueError, TypeError) as error:
            known = (*COLUMNS, "scene", "radar", "frame", "mesh_id", "triangle_id", "u and v", "paths", "from_arrays")
            assert any(name in str(error) for name in known), f"names no argument: {error}"
            return
        _use(made)

    return case


def _columns(paths) -> dict:
    """Keywords of Paths.from_arrays that give the same paths."""
    return {name: getattr(paths, name) for name in COLUMNS if len(getattr(paths, name))} | {
        name: getattr(paths, name) for name in ("scene", "radar", "frame")}


def _change(arguments: dict, random: Random) -> None:
    name = random.choice(list(arguments))
    if random.random() < 0.2 or not isinstance(arguments[name], np.ndarray) or not arguments[name].size:
        if random.random() < 0.2:
            del arguments[name]
        else:
            arguments[name] = random.choice(ODD_VALUES)
        return
    array = arguments[name].copy()
    kind = random.randrange(5)
    if kind <= 2 and array.dtype.kind in "biufcV":
        _put(array, random)
    elif kind == 3 and array.ndim:
        array = random.choice([array[1:], array[:0], array[::2], np.concatenate([array, array]), array[None], array[..., None],
                               np.asfortranarray(array), array[::-1]])
    elif array.dtype.kind in "biufc":
        with np.errstate(all="ignore"):
            array = array.astype(random.choice(["f4", "f8", "i1", "i4", "i8", "u1", "u8", "c16", "O", "S8", "b1", ">i8"]))
    arguments[name] = array


def _put(array, random: Random) -> None:
    target = array[random.choice(array.dtype.names)] if array.dtype.names else array
    value = random.choice(ODD_NUMBERS)
    try:
        with np.errstate(all="ignore"):
            target.flat[random.randrange(target.size)] = value
    except (ValueError, OverflowError, TypeError):
        target[np.unravel_index(random.randrange(target.size), target.shape)] = np.zeros((), target.dtype)[()]


def _use(paths) -> None:
    """What follows a trace must not crash, whatever the values are."""
    power = paths.power
    assert power.shape == (paths.num_paths,)
    paths.points(0.0)
    paths.lengths([0.0, 1e-4])
    paths.select("T .+ R")
    if paths.num_paths:
        paths.select(np.arange(paths.num_paths) % 2 == 0).partition({"a": "T . R"})
