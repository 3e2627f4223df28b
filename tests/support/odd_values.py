"""Values that are wrong for most arguments, and what an error must say of them."""
from __future__ import annotations

import decimal
import fractions

import numpy as np

import echopath as ep

EXPECTED = (TypeError, ValueError, IndexError, ep.FileError)
SURROGATE = "wall\ud800"


class Unprintable:
    """A value whose __repr__ raises."""

    def __repr__(self):
        raise RuntimeError("no words for it")


# Made anew for each call: some are used up.
ODD = {
    "None": lambda: None, "True": lambda: True, "NaN": lambda: float("nan"), "inf": lambda: float("inf"),
    "-inf": lambda: -float("inf"), "-1": lambda: -1, "0.5": lambda: 0.5, "-0.5": lambda: -0.5, "-1e9": lambda: -1e9,
    "1e300": lambda: 1e300, "2**70": lambda: 2**70, "10**400": lambda: 10**400, "1j": lambda: 1j, "empty text": lambda: "",
    "text": lambda: "nonsense", "number as text": lambda: "5", "lone surrogate": lambda: SURROGATE, "NUL": lambda: "a\0b",
    "bytes": lambda: b"bytes", "object": object, "class": lambda: int, "lambda": lambda: (lambda: None),
    "unprintable": Unprintable, "empty list": list, "empty tuple": tuple, "empty dict": dict, "empty set": set,
    "ragged": lambda: [[1.0, 2.0], [3.0]], "list of None": lambda: [None], "list of text": lambda: ["5", "6"],
    "list of surrogates": lambda: [SURROGATE], "[5]": lambda: [5.0], "wrong shape": lambda: np.zeros((2, 2, 2)),
    "many axes": lambda: np.zeros((1,) * 9), "no rows": lambda: np.zeros((0, 7)), "NaN [3]": lambda: np.full(3, np.nan),
    "text array": lambda: np.array(["a", "b"]), "object array": lambda: np.array([object(), None]),
    "array of dates": lambda: np.array(["2020-01-01"], "datetime64[D]"), "date": lambda: np.datetime64("2020-01-01"),
    "span of time": lambda: np.timedelta64(5, "ns"), "span in ms": lambda: np.timedelta64(5, "ms"),
    "NumPy NaN": lambda: np.float32("nan"), "NumPy -1": lambda: np.int8(-1), "array -1": lambda: np.array(-1),
    "array NaN": lambda: np.array(np.nan), "structured": lambda: np.zeros(2, "i4,f4"), "Decimal": lambda: decimal.Decimal("0.5"),
    "Fraction": lambda: fractions.Fraction(-1, 3), "range": lambda: range(-2, 0), "generator": lambda: (n for n in "ab"),
    "dict of numbers": lambda: {"one": 1.0}, "dict by numbers": lambda: {1: "T . R"},
    "dict by surrogates": lambda: {SURROGATE: "T . R"}, "dict of surrogates": lambda: {"one": SURROGATE},
    "dict of faults": lambda: {"one": "T ("}, "nested dict": lambda: {"one": {"two": {"three": "T . R"}}},
    "set of numbers": lambda: {1, 2}, "exception": lambda: ValueError("argument"), "module": lambda: np,
    "slice": lambda: slice(3), "ellipsis": lambda: ..., "memory": lambda: memoryview(b"ab"),
}


def make_radar() -> ep.Radar:
    waveform = ep.ChirpSequence(start_frequency=77e9, bandwidth=0.5e9, num_samples=16, sampling_rate=10e6, num_chirps=4,
                                chirp_interval=50e-6)
    receivers = [ep.Antenna((0.0, 0.5 * index * waveform.wavelength, 0.0)) for index in range(2)]
    return ep.Radar(waveform, transmitters=[ep.Antenna()], receivers=receivers)


def make_scene() -> ep.Scene:
    scene = ep.Scene()
    scene.add(ep.actors.plate(1.0, 1.0), name="plate", material="metal", position=(5.0, 0.0, 0.0))
    return scene


def is_named(argument: str, value, error: Exception) -> bool:
    """Whether an error names an argument, or of what is wrong with a file, the file; in text that can be printed."""
    message = str(error).encode("utf-8").decode("utf-8")
    return argument in message or (isinstance(error, ep.FileError) and str(value) in message)


def refusals(function, right: dict, arguments):
    """(argument, name in ODD, value, error) of each odd value that a function refuses in the place of one of its arguments.

    right: {argument: value} that it takes. Errors that are not EXPECTED go on to the caller.
    """
    for argument in arguments:
        for odd, make in ODD.items():
            value = make()
            try:
                function(**right | {argument: value})
            except EXPECTED as error:
                yield argument, odd, value, error
