"""Films of pictures: GIF by Pillow, MP4 by ffmpeg where imageio-ffmpeg is installed."""
from __future__ import annotations

import functools
import itertools
from pathlib import Path

import numpy as np

from ..process.libraries import needed_module
from .files import written_whole

KINDS = (".gif", ".mp4")


def write_film(path, pictures, frames_per_second: float) -> None:
    """Writes pictures u8 [height, width, 3], all of one size, as a film, whole or not at all.

    path: .gif (it goes round) or .mp4; pictures: taken one after the other, none is kept for an MP4
    Raises ValueError for another kind and for no picture, ModuleNotFoundError without imageio-ffmpeg, ep.FileError.
    """
    write = _write_gif if require_kind(path) == ".gif" else functools.partial(_write_mp4, needed_module(
        "imageio_ffmpeg", "a film in MP4 (GIF needs nothing)", extra="film"))
    with written_whole(path) as temporary:
        others = iter(pictures)
        first = next(others, None)
        if first is None:
            raise ValueError("pictures: must be at least one, got none")
        write(temporary, first, others, frames_per_second)


def require_kind(path) -> str:
    """The kind of film that a path names. Raises ValueError for another one."""
    kind = Path(path).suffix.lower()
    if kind not in KINDS:
        raise ValueError(f"path: must end in {' or '.join(KINDS)}, got {path}")
    return kind


def _write_gif(path, first, others, frames_per_second: float) -> None:
    from PIL import Image

    images = (Image.fromarray(picture).quantize(256) for picture in itertools.chain([first], others))
    timed = _with_durations(images, frames_per_second)
    with open(path, "wb") as file:
        next(timed).save(file, "GIF", save_all=True, append_images=timed, loop=0)


def _with_durations(images, frames_per_second: float):
    """The images, each shown for whole hundredths of a second, as GIF has them, so that all together take their time."""
    shown = 0
    for count, image in enumerate(images, 1):
        end = max(shown + 1, round(100.0 * count / frames_per_second))
        image.info["duration"], shown = 10 * (end - shown), end
        yield image


def _write_mp4(ffmpeg, path, first, others, frames_per_second: float) -> None:
    height, width = (length - length % 2 for length in first.shape[:2])  # yuv420p halves both
    writer = ffmpeg.write_frames(str(path), (width, height), fps=frames_per_second, macro_block_size=2,
                                 output_params=["-f", "mp4"])
    writer.send(None)
    try:
        for picture in itertools.chain([first], others):
            writer.send(np.ascontiguousarray(picture[:height, :width]))
    finally:
        writer.close()
