"""Datasets in the layout of CARRADA, which the training code of its authors reads (Ouaknine et al. 2021)."""
from __future__ import annotations

import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...arguments.checks import checked, path as folder_rule, refused
from ...arguments.settings import LabelSettings
from ...base.storage.files import write_texts, written_whole
from ...frame.frame import Frame
from ..opened import Dataset, dataset_rule
from . import exported
from .carrada_views import NUM_ANGLES, NUM_RANGES, NUM_VELOCITIES, Instance, instances_of, one_hot, views_of

FOLDER = "Carrada"
_SPLITS = {"train": "Train", "val": "Validation", "validation": "Validation", "test": "Test"}
_SHAPES = {"range_doppler": (NUM_RANGES, NUM_VELOCITIES), "range_angle": (NUM_RANGES, NUM_ANGLES)}

_MARGINS = ("noise", "noise_margin_db", "dynamic_range_db")  # of a template's [labels], which hold here too

_Annotations = dict[str, dict[str, Any]]  # {instance: {view: its cells}} of one frame


@checked(dataset=dataset_rule, folder=folder_rule)
def write_carrada(dataset: Dataset, folder: str | os.PathLike[str]) -> None:
    """Writes views and masks of a dataset as CARRADA has them, into the folder Carrada of `folder`.

    dataset: as of `open`, of a template with keep = "all", else its `remade()`, whose frames are simulated again; its splits are
        train, val (or validation) and test alone; its radar has maps of 256 ranges and 64 velocities and antennas that tell
        azimuths apart (`data/datasets/carrada.toml`)
    folder: new or empty, the `warehouse` of MVRSS; it gets the folder Carrada, whole or not at all: after a kill, the same call
        writes it anew.
    For each scene, a folder scene_000000 and so on with frames 000000 and so on:
    range_doppler_processed/FRAME.npy: f32 [256, 64] dB, nearest range first, approaching positive about column 32
    range_angle_processed/FRAME.npy: f32 [256, 256] dB, farthest range first, right positive about column 128, pi / 256 rad each
    angle_doppler_processed/FRAME.npy: f32 [256, 64] dB, rows as the columns of range_angle, columns those of range_doppler
    annotations/dense/FRAME/range_doppler.npy and range_angle.npy: u8 [4, 256, 64 or 256], one-hot over background, pedestrian,
        cyclist (with motorcycles) and car (with vans, trucks and buses): all cells that an object has, in range_angle down to
        half the power of its strongest at that range. annotations/sparse has its strongest cell alone. Ghosts are background.
        noise, noise_margin_db and dynamic_range_db are those of the template's [labels], for both views.
    The mean thermal noise of each view has the mean level of that view in CARRADA, and values end at its lowest and highest, from
    which training code scales: the input of a network lies within 0 and 1.
    data_seq_ref.json: split, instances and labels of each sequence; light_dataset_frame_oriented.json: the frames of each;
    annotations_frame_oriented.json and annotations_instance_oriented.json: sparse and dense cells, box and label of each
    instance; validated_seqs.txt: names of the sequences.
    Raises ValueError naming `dataset` where it has no frames or is not of such a template, and naming `folder` where that has a
    folder Carrada; ep.FileError where files cannot be written.
    """
    _require(dataset)
    with exported(dataset, folder, FOLDER) as root:
        _write(dataset, root)


def _write(dataset: Dataset, root: Path) -> None:
    sequences, frames = {}, {}
    for scene in dataset.scenes:
        name = f"scene_{scene:06d}"
        frames[name] = dict(_written_frames(dataset, scene, root / name))
        sequences[name] = _sequence(_SPLITS[dataset.template.split_of(scene)], frames[name])
    write_texts(root, {"data_seq_ref.json": json.dumps(sequences, indent=1) + "\n",
                       "light_dataset_frame_oriented.json": json.dumps({name: list(one) for name, one in frames.items()}) + "\n",
                       "annotations_frame_oriented.json": json.dumps(frames) + "\n",
                       "annotations_instance_oriented.json": json.dumps(_by_instance(frames)) + "\n",
                       "validated_seqs.txt": "\n".join(frames) + "\n"})


def _require(dataset: Dataset) -> None:
    if dataset.keep != "all":
        raise refused(ValueError, "dataset", 'of a template with keep = "all", or its remade(), for the signals of all antennas',
                      f"one that keeps {dataset.keep}")
    if unknown := [name for name in dataset.template.settings.split if name not in _SPLITS]:
        raise refused(ValueError, "dataset", f"of a template with splits {', '.join(_SPLITS)} alone", unknown[0])


def _written_frames(dataset: Dataset, scene: int, folder: Path) -> Iterator[tuple[str, _Annotations]]:
    """Writes the arrays of a scene's frames; yields the name and the annotations of each."""
    kinds = dataset.template.classes(scene)
    told = dataset.sequence(scene).settings["labels"] or {}
    margins = LabelSettings(**{name: told[name] for name in _MARGINS if name in told})
    for one in dataset.of_scene(scene):
        assert isinstance(one.frame, Frame)  # which all files have of keep = "all"
        name = f"{one.place:06d}"
        for view, values in views_of(one.frame).items():
            _save(folder / f"{view}_processed" / f"{name}.npy", values)
        found = instances_of(one.frame, kinds, margins)
        for view, instances in found.items():
            dense = one_hot([(one.label, one.cells) for one in instances], _SHAPES[view])
            sparse = one_hot([(one.label, one.peak[None]) for one in instances], _SHAPES[view])
            _save(folder / "annotations" / "dense" / name / f"{view}.npy", dense)
            _save(folder / "annotations" / "sparse" / name / f"{view}.npy", sparse)
        yield name, _annotations(found)


def _save(path: Path, values: NDArray[Any]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with written_whole(path) as temporary:
        with open(temporary, "wb") as file:
            np.save(file, values)


def _annotations(found: dict[str, list[Instance]]) -> _Annotations:
    """{instance: {view: its cells, box and label}}, box: [[lowest row, lowest column], [highest row, highest column]]."""
    annotations: _Annotations = {}
    for view, instances in found.items():
        for one in instances:
            annotations.setdefault(one.name, {})[view] = {
                "sparse": [one.peak.tolist()], "box": [one.cells.min(axis=0).tolist(), one.cells.max(axis=0).tolist()],
                "dense": one.cells.tolist(), "label": one.label}
    return annotations


def _sequence(split: str, frames: dict[str, _Annotations]) -> dict[str, Any]:
    """What data_seq_ref.json says of a sequence."""
    labels = {name: next(iter(views.values()))["label"] for one in frames.values() for name, views in one.items()}
    return {"split": split, "instances": list(labels), "labels": list(labels.values())}


def _by_instance(sequences: dict[str, dict[str, _Annotations]]) -> dict[str, dict[str, _Annotations]]:
    """{sequence: {instance: {frame: views}}} of {sequence: {frame: {instance: views}}}."""
    turned: dict[str, dict[str, _Annotations]] = {}
    for sequence, frames in sequences.items():
        turned[sequence] = {}
        for frame, instances in frames.items():
            for name, views in instances.items():
                turned[sequence].setdefault(name, {})[frame] = views
    return turned
