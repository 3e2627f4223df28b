"""Frames in time of a scene file, on the command line."""
from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from .. import plots
from ..base.process.progress import progress_bars
from ..base.text.counts import counted
from ..dataset.folder import TEMPLATE as DATASET_FILE
from ..frame.unresolved import unresolved_of_frame
from ..scene_file import SceneFile
from ..sensor_files import save_raw
from ..sequence import Sequence, load_sequence
from ..sequence.folder import NAME as SEQUENCE_FILE
from ..sequence.pictures import drive_of, write_film_of
from . import report
from .numbers import duration_words
from .run import FRAME_NAME, TRUTH_NAME, keywords_of, raw_line
from .warned import pictures_warned


def is_sequence(scene_file: SceneFile, options) -> bool:
    """Whether a run makes frames in time. Raises ValueError for options of them without their number."""
    if options.frames is not None or scene_file.sequence is not None:
        return True
    for option in ("interval", "keep", "shard"):
        value = getattr(options, option)
        if value is not None:
            text = "/".join(map(str, value)) if option == "shard" else value
            raise ValueError(f"--{option}: belongs to frames in time, give --frames too, got {text}")
    return False


def require_no_others(out: Path, are_in_time: bool) -> None:
    """Raises ValueError where a folder has results of another kind, which those who open it would see in place of these.

    are_in_time: whether frames in time are to be written into it, or one frame
    """
    kinds = {FRAME_NAME: "one frame", SEQUENCE_FILE: "frames in time", DATASET_FILE: "a dataset"}
    del kinds[SEQUENCE_FILE if are_in_time else FRAME_NAME]
    for name, kind in kinds.items():
        if (out / name).exists():
            raise ValueError(f"--out: must be another folder than that of {kind} ({name}), got '{out}'")


def run_sequence(scene_file: SceneFile, options, extra_parts: dict) -> Iterator[str]:
    """Makes the frames that are missing in the folder or file of the options; yields a line for each.

    extra_parts: as in `simulate_file`
    """
    keep = _chosen(scene_file, options, "keep")
    keywords = keywords_of(scene_file, num_rays=options.rays, seed=options.seed, batches=options.batches,
                           truth=options.truth or None, extra_parts=extra_parts)
    if options.raw is not None and (keep not in (None, "all") or options.shard is not None):
        raise ValueError("--raw: needs the signals of all frames: --keep all, without --shard")
    if keep == "labels" and keywords["labels"] is None:
        keywords["labels"] = True
    sequence = Sequence(scene_file.scene, scene_file.radar, **keywords | _starts(scene_file, options))
    yield f"{scene_file.title or scene_file.path}: {counted(len(sequence), 'frame')} {sequence._pace()}"
    objects, unresolved = scene_file.label_objects(), []
    with progress_bars() as progress:
        for saved in sequence._save_frames(options.out, keep or "all", options.shard, progress,
                                           look=lambda frame: unresolved.append(unresolved_of_frame(frame, objects))):
            yield _line(saved, len(sequence))
    stored = load_sequence(options.out)
    yield f"wrote {stored}"
    if options.raw is not None:
        yield raw_line(options.raw, save_raw(stored, options.raw))
    if keywords["truth"] is not None:
        path = _beside(stored, TRUTH_NAME)
        stored.truth.to_csv(path)
        yield f"wrote {path}"
    if stored.keep != "labels" and stored.is_done.all():
        yield from _write_pictures(stored, scene_file.title)
    yield from report.unresolved_in_frames(unresolved)


def _write_pictures(stored, title: str) -> Iterator[str]:
    """The frames at a glance and as a film, of maps that are read once; yields a line for each file."""
    picture, film = _beside(stored, "overview.png"), _beside(stored, "film.gif")
    with pictures_warned("the frames are written, but not all of their pictures"):
        drive = drive_of(stored)
        plots.save_png(plots.plot_drive(drive, title=title), picture, seed=stored.settings["seed"],
                       noise_seed=stored.settings["noise_seed"])
        yield f"wrote {picture}"
        write_film_of(drive, film)
        yield f"wrote {film}"


def _beside(stored, name: str) -> Path:
    """A file in the folder of frames, or beside the file of all, which begins with its name."""
    return stored.path / name if stored.path.is_dir() else stored.path.with_name(f"{stored.path.stem}_{name}")


def _starts(scene_file: SceneFile, options) -> dict:
    """{keyword: value} of `Sequence` that tell when the frames begin. Of the times of a scene file `--frames` takes the first."""
    times = getattr(scene_file.sequence, "times", None)
    if times is not None and options.interval is None:
        if options.frames is not None and options.frames > len(times):
            raise ValueError(f"--frames: must be at most {len(times)}, the times of the scene file, got {options.frames}")
        return {"times": times[:options.frames]}
    frames, interval = (_chosen(scene_file, options, name) for name in ("frames", "interval"))
    if interval is None:
        raise ValueError("--interval: must be given with --frames, in s from the start of a frame to that of the next")
    if frames is None:
        raise ValueError("--frames: must be given with --interval in the place of the times of the scene file")
    return {"frames": frames, "interval": interval}


def _chosen(scene_file: SceneFile, options, name: str):
    """An option, or what the scene file has; None: neither."""
    value = getattr(options, name)
    return getattr(scene_file.sequence, name, None) if value is None else value


def _line(saved, frames: int) -> str:
    text = f"frame {saved.place + 1} of {frames} at {saved.start_time:.6g} s: "
    text += "is there" if saved.seconds is None else f"{saved.seconds:.1f} s"
    if saved.seconds_left:
        text += f", {duration_words(saved.seconds_left)} left"
    return text
