"""Films of pictures: GIF by Pillow, MP4 by ffmpeg where imageio-ffmpeg is installed."""
from __future__ import annotations

from pathlib import Path

import numpy as np

from ..process.libraries import needed_module
from .files import written_whole

KINDS = (".gif", ".mp4")


def write_film(path, pictures, frames_per_second: float) -> int:
    """Writes pictures u8 [height, width, 3], all of one size, as a film, whole or not at all; returns how many there were.

    path: .gif (it goes round) or .mp4; pictures: taken one after the other, none is kept for an MP4
    Raises ValueError for another kind and for no picture, ModuleNotFoundError without imageio-ffmpeg, ep.FileError.
    """
    write = _write_gif if require_kind(path) == ".gif" else _write_mp4
    with written_whole(path) as temporary:
        count = write(temporary, iter(pictures), frames_per_second)
    return count


def require_kind(path) -> str:
    """The kind of film that a path names. Raises ValueError for another one."""
    kind = Path(path).suffix.lower()
    if kind not in KINDS:
        raise ValueError(f"path: must end in {' or '.join(KINDS)}, got {path}")
    return kind


def _write_gif(path, pictures, frames_per_second: float) -> int:
    from PIL import Image

    images = (Image.fromarray(picture).quantize(256) for picture in pictures)
    first = next(images, None)
    if first is None:
        raise ValueError("pictures: must be at least one, got none")
    counted = _Counted(images)
    with open(path, "wb") as file:
        first.save(file, "GIF", save_all=True, append_images=counted, duration=round(1e3 / frames_per_second), loop=0)
    return 1 + counted.count


class _Counted:
    """Passes on what is iterated, and counts it."""

    def __init__(self, items):
        self._items, self.count = items, 0

    def __iter__(self):
        for item in self._items:
            self.count += 1
            yield item


def _write_mp4(path, pictures, frames_per_second: float) -> int:
    ffmpeg = needed_module("imageio_ffmpeg", "a film in MP4 (GIF needs nothing)", extra="film")
    first = next(pictures, None)
    if first is None:
        raise ValueError("pictures: must be at least one, got none")
    height, width = (length - length % 2 for length in first.shape[:2])  # yuv420p halves both
    writer = ffmpeg.write_frames(str(path), (width, height), fps=frames_per_second, macro_block_size=2,
                                 output_params=["-f", "mp4"])
    writer.send(None)
    count = 0
    try:
        for picture in _chain(first, pictures):
            writer.send(np.ascontiguousarray(picture[:height, :width]))
            count += 1
    finally:
        writer.close()
    return count


def _chain(first, others):
    yield first
    yield from others
