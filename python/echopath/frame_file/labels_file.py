"""Labels of maps in HDF5 files of their own."""
from __future__ import annotations

import os
from collections.abc import Mapping

from ..arguments.checks import checked, refused, text
from ..base.process.interrupts import keeps_interrupts
from ..labels.labels import Labels
from .container import new_file, our_file
from .h5 import read_group
from .labels import read_all_labels, write_all_labels


def _labels(argument: str, value) -> dict:
    """{partition: Labels}"""
    if not isinstance(value, Mapping) or not all(isinstance(labels, Labels) for labels in value.values()):
        raise refused(TypeError, argument, "a dict {partition: Labels}", value)
    return {text(argument, name): labels for name, labels in value.items()}


@checked(labels=_labels)
@keeps_interrupts
def save_labels(labels: Mapping[str, Labels], path: str | os.PathLike[str]) -> None:
    """Writes labels to an HDF5 file of their own, as a frame file has them.

    labels: {partition: Labels}, of maps [V, R]; path: of the file, written whole or not at all. Raises ep.FileError.
    """
    with new_file(path) as file:
        write_all_labels(file.create_group("labels"), labels)


@checked()
@keeps_interrupts
def load_labels(path: str | os.PathLike[str]) -> dict[str, Labels]:
    """{partition: Labels} of a file of `save_labels` or of a frame file at `path`: the same bits. Raises ep.FileError."""
    with our_file(path) as file:
        return read_all_labels(read_group(file, "labels"))
