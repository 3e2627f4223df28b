"""Simulates a scene file and writes the frame and its pictures."""
from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import echopath as ep

from .. import plots
from ..arguments.part_names import LEAKAGE, REST
from ..base.process.stages import StageClock
from ..base.text.counts import counted
from ..frame.frame import Frame
from ..frame.simulate import simulate
from ..frame_file import LeftOut, min_power_of_budget, save_frame
from ..frame_file.frame import partition_names
from ..frame_file.opening import SUFFIXES as FRAME_SUFFIXES, reading
from ..paths.families import families
from ..paths.resolution import RESOLVED_DB
from ..plots.frames import limits_of_frame, noise_words, title_of
from ..scene_file import SceneFile
from ..signals.measures import for_pictures, with_error
from ..signals.parts import parts_of_options
from ..truth.places import true_places
from .label_outputs import MAPS_FOLDER, file_names, label_maps_of, label_names, write_labels
from .warned import pictures_warned

FRAME_NAME, TRUTH_NAME, DETECTIONS_NAME = "frame.h5", "truth.csv", "detections.csv"
_NOT_RAW = (*FRAME_SUFFIXES, ".toml", ".csv", ".png", ".json", ".gif")
_PICTURES = ("scene", "map", "overview", "range_azimuth", "objects_and_ghosts")  # beside those of partitions


@dataclasses.dataclass(frozen=True)
class Written:
    """What a run wrote: frame_path, left_out of it, pictures (paths of PNG files)."""

    frame_path: Path
    left_out: LeftOut
    pictures: list


def simulate_file(scene_file: SceneFile, *, num_rays=None, seed=None, batches=None, extra_parts=None,
                  labels=None, truth=None, progress=None) -> Frame:
    """The frame that a scene file describes.

    num_rays, seed, batches, labels: instead of those of the file; labels as in `ep.simulate`
    truth: True: also where the file does not ask for it, whose own [truth] says of which objects
    extra_parts: {partition: {part: selection}} beside those of the file.
    """
    keywords = keywords_of(scene_file, num_rays=num_rays, seed=seed, batches=batches, truth=truth, extra_parts=extra_parts)
    return simulate(scene_file.scene, scene_file.radar, **keywords | ({} if labels is None else {"labels": labels}),
                    progress=progress)


def keywords_of(scene_file: SceneFile, *, num_rays=None, seed=None, batches=None, truth=None, extra_parts=None) -> dict:
    """Keywords of `ep.simulate` and `ep.Sequence`; arguments as in `simulate_file`."""
    instead = {"num_rays": num_rays, "seed": seed, "batches": batches, "truth": truth if scene_file.truth is None else None}
    keywords = scene_file.keywords() | {name: value for name, value in instead.items() if value is not None}
    return keywords | {"parts": keywords["parts"] | (extra_parts or {})}


def chosen_partition(texts, taken) -> dict:
    """{"choice": {name: Selection}} of texts NAME=SELECTION from the command line; {} of none.

    taken: names of other partitions, beside which it is called "choice 2", "choice 3" and so on
    """
    if not texts:
        return {}
    names = itertools.chain(["choice"], (f"choice {number}" for number in itertools.count(2)))
    return {next(name for name in names if name not in taken): parts_of_options(texts)}


def certify(frame: Frame, *, progress=None):
    """The ep.Validity of a frame's replay; adds its stage to those of the frame."""
    clock = StageClock()
    with clock("validity"):
        certificate = ep.validity(frame.paths, frame.radar, replay=frame.replay, progress=progress)
    frame.stages += clock.stages
    return certificate


def write_outputs(frame: Frame, folder, partitions, objects=None) -> Written:
    """Writes frame.h5, detections.csv and truth.csv where they were asked for, and pictures; adds its stages to the frame's.

    The pictures: scene.png, map.png, a PNG for each of `partitions` (NAME.png, or parts_map.png of one that is called "map", and
    the like), overview.png (map and first partition) and, where the radar tells azimuths apart, range_azimuth.png (the whole and
    the first partition from above); with labels also objects_and_ghosts.png, labels_NAME.png for each partition and label_maps/
    for programs.
    objects: that pictures name, as in `families`; None: the children of the scene's root
    Files of an earlier run in the folder go when the frame is written. The frame is there whatever becomes of its pictures: what
    keeps these from being made is a warning.
    """
    folder = Path(folder)
    clock = StageClock()
    earlier = outputs_of_run(folder)
    with clock("frame file"):
        frame_path = folder / FRAME_NAME
        left_out = save_frame(frame, frame_path, min_power=min_power_of_budget(frame))
        _remove(earlier, folder / MAPS_FOLDER)
        if frame.detections is not None:
            frame.detections.to_csv(folder / DETECTIONS_NAME)
        if frame.kept_truth is not None:
            frame.kept_truth.to_csv(folder / TRUTH_NAME)
    pictures: list = []
    with clock("pictures"):
        with pictures_warned("the frame is written, but not all of its pictures"):
            pictures.extend(_write_pictures(frame, folder, partitions, objects))
            if frame.labels:
                pictures.extend(write_labels(frame, folder, {name: frame.selections[name] for name in partitions}))
    frame.stages += clock.stages
    return Written(frame_path, left_out, pictures)


def outputs_of_run(folder: Path) -> list[Path]:
    """The files beside frame.h5 that the run which made it may have written, by the partitions that it keeps; [] without it."""
    try:
        with reading(folder / FRAME_NAME) as file:
            partitions = partition_names(file)
    except ep.FileError:
        return []
    names = [*_PICTURES, *_picture_names(partitions).values(), *(f"labels_{name}" for name in label_names(partitions).values())]
    return [folder / DETECTIONS_NAME, folder / TRUTH_NAME, *(folder / f"{name}.png" for name in names),
            *label_maps_of(folder, partitions)]


def _remove(files: list[Path], folder: Path) -> None:
    """Removes files, and a folder if nothing else is in it."""
    for path in files:
        path.unlink(missing_ok=True)
    with suppress(OSError):
        folder.rmdir()


def require_raw_name(path) -> None:
    """Raises ValueError where raw data would be written to a file of a kind that the run reads or writes, in whose place it would
    be."""
    if Path(path).suffix.lower() in _NOT_RAW:
        kinds = ", ".join(_NOT_RAW)
        rule = f"must be a file of raw data (.bin), of no kind that a run reads or writes ({kinds})"
        raise ValueError(f"--raw: {rule}, got '{path}'")


def raw_line(path, num_bytes: int) -> str:
    """What to say of a file of raw data."""
    return f"wrote {path}: {counted(num_bytes, 'byte')} of raw data"


def _picture_names(partitions) -> dict[str, str]:
    """{partition: name of its picture}, as no other file has it."""
    return file_names(partitions, {"/": "_"}, [*_PICTURES, *(f"labels_{name}" for name in label_names(partitions).values())])


def _write_pictures(frame: Frame, folder: Path, partitions, objects=None) -> Iterator[Path]:
    """Yields the path of each PNG file that is written."""
    def write(name: str, figure) -> Path:
        plots.save_png(figure, folder / f"{name}.png", seed=frame.paths.frame.seed, noise_seed=frame.noise_seed)
        return folder / f"{name}.png"

    yield write("scene", plots.plot_scene(frame.scene, frame.paths, power=frame.path_power, objects=objects))
    vmin, vmax = limits_of_frame(frame)
    title = title_of(frame)
    mean = for_pictures(f"; mean power {with_error(frame.mean_power)}")
    yield write("map", plots.plot_range_doppler(frame.spectrum, title=title + mean, vmin=vmin, vmax=vmax))
    names = _picture_names(partitions)
    for index, partition in enumerate(partitions):
        spectra = shown_parts(frame.part_spectra[partition], vmin)
        looks = {"vmin": vmin, "vmax": vmax, "powers": frame.mean_part_powers[partition],
                 "radar_moves": frame.radar.is_moving}
        words = "taken apart" + (f" by {partition}" if partition != "parts" else "") + ", without noise"
        words += "; mean power of all ranges together and its 95 % interval"
        if not all(power.resolved for power in frame.mean_part_powers[partition].values()):
            words += f" (not resolved: wider than \N{PLUS-MINUS SIGN}{RESOLVED_DB:g}\N{NO-BREAK SPACE}dB)"
        yield write(names[partition], plots.plot_partition(spectra, title=f"What the radar receives, {words}", **looks))
        if index == 0:
            words = f"The same {words}"
            yield write("overview", plots.plot_overview(frame.spectrum, spectra, title=title + mean, parts_title=words, **looks))
    if frame.range_azimuth is not None:
        maps = _maps_from_above(frame, next(iter(partitions), None), vmin)
        leaked = frame.beside_spectra.get(LEAKAGE)
        yield write("range_azimuth", plots.plot_range_azimuth(maps, places=_places(frame, objects),
                                                              leaked=leaked and frame.range_azimuth_of(leaked)))


def _places(frame: Frame, objects) -> dict:
    """Where the objects of the frame truly are, in its range-azimuth map. objects: as in `families`"""
    time = frame.paths.frame.trace_time
    return true_places(frame.scene, frame.radar, families(frame.paths).objects if objects is None else objects, time)


def _maps_from_above(frame: Frame, partition, vmin: float) -> dict:
    """{title: range-azimuth map} of the whole and of the parts of a partition (None: no parts) that a picture shows."""
    spectra = shown_parts(frame.part_spectra[partition], vmin) if partition is not None else {}
    noise = noise_words(frame)
    parts = {f"{plots.part_title(name)}, without noise": frame.range_azimuth_of(one) for name, one in spectra.items()}
    return {"everything" + noise: frame.range_azimuth} | parts


def shown_parts(spectra: dict, vmin: float) -> dict:
    """The parts that a picture shows: "other" only when some of it reaches the colour scale."""
    return {name: spectrum for name, spectrum in spectra.items()
            if name != REST or plots.power_dbm(spectrum).max() > vmin}
