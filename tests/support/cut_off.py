"""HDF5 files of numbers, and changes of them that are cut off as by a kill, at a place that is known."""
from pathlib import Path

import numpy as np
import pytest

from echopath.frame_file import changing as changes
from echopath.frame_file.h5_items import library

OLD = {"old": 49995000.0}
NEW = OLD | {"new": 4999950000}


class Killed(BaseException):
    """In place of a signal."""


def numbers_in(path: Path) -> dict:
    with library().File(path) as file:
        return {name: file[name][()].sum() for name in file}


def write_old(path: Path, layout=changes.LAYOUT) -> None:
    """A file that holds OLD."""
    with library().File(path, "w", libver=layout) as file:
        file["old"] = np.arange(10000.0)


def cut_off(path: Path, step: str) -> None:
    """A change of OLD to NEW that does not come to a step of `changes`."""
    changes.work_folder(path).mkdir(exist_ok=True)

    def killed(*arguments):
        raise Killed

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(changes, step, killed)
        with pytest.raises(Killed), changes.changing(path) as file:
            file["new"] = np.arange(100000)
