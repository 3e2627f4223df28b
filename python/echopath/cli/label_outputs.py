"""Label maps for programs and pictures of labels for people."""
from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

import echopath as ep

from .. import plots
from ..signals.parts import ONLY_PARTITION

MAPS_FOLDER = "label_maps"


def write_labels(frame, folder: Path, selections: dict) -> Iterator[Path]:
    """Writes label maps and pictures of a frame's labels; yields the path of each PNG file that is written.

    selections: {partition: {part: selection}} of those partitions that are written, {} for a frame without any.
    """
    of_partitions = {name: labels for name, labels in frame.labels.items() if name in selections or not selections}
    names = label_names(of_partitions)

    def write(name: str, figure) -> Path:
        path = folder / f"{name}.png"
        plots.save_png(figure, path, seed=frame.paths.frame.seed)
        return path

    for index, (partition, labels) in enumerate(of_partitions.items()):
        yield from ep.save_label_images(labels, folder / MAPS_FOLDER, _map_names(partition, names[partition], index == 0))
        if index == 0:
            yield write("objects_and_ghosts", plots.plot_ghosts(labels))
        powers = _powers(frame, partition, selections.get(partition, {}))
        title = "Which part made each cell" + (f", by {partition}" if partition != ONLY_PARTITION else "")
        yield write(f"labels_{names[partition]}", plots.plot_labels(labels, title=title, powers=powers))


def label_maps_of(folder: Path, partitions: Iterable[str]) -> list[Path]:
    """The files of label maps that `write_labels` makes of partitions."""
    names = {name for partition, written in label_names(partitions).items()
             for name in _map_names(partition, written, is_first=True).values()}
    return [folder / MAPS_FOLDER / f"{name}{suffix}" for name in sorted(names) for suffix in (".png", ".json")]


def _map_names(partition: str, name: str, is_first: bool) -> dict:
    """File names of label maps; those of objects and ghosts are the same for all partitions."""
    names = {"parts": "parts" if partition == ONLY_PARTITION else f"parts_{name}"}
    return names | ({"objects": "objects", "ghosts": "ghosts"} if is_first else {})


def label_names(partitions: Iterable[str]) -> dict[str, str]:
    """{partition: what its files are called} behind labels_ and parts_."""
    return file_names(partitions, {"/": "_", " ": "_"})


def file_names(partitions: Iterable[str], instead: dict[str, str], taken: Iterable[str] = ()) -> dict[str, str]:
    """{partition: name of its file, without the suffix}: its own, unless another file has that, one for each.

    instead: {character: what stands in its place}; taken: names of other files
    """
    found, used = {}, set(taken)
    for partition in partitions:
        name = partition.translate(str.maketrans(instead))
        while name in used:
            name = f"parts_{name}"
        found[partition] = name
        used.add(name)
    return found


def _powers(frame, partition: str, selections: dict) -> dict:
    """Mean received power of each part {part: ep.ReceivedPower}; those of a frame's partitions are known."""
    if partition in frame.part_of_path:
        return frame.mean_part_powers[partition]
    return {name: ep.received_power(paths) for name, paths in frame.paths.partition(selections).items()}
