"""What the window shows, as files: pictures, maps, films, pages."""
from __future__ import annotations

from pathlib import Path

import numpy as np

from echopath.base.storage.files import written_whole
from echopath.base.storage.film import KINDS as FILMS, write_film
from echopath.base.storage.origin import origin_texts

from ...scene_builder.web_page import ScenePage
from ..qt import QtGui
from .pictures import drawing_of, picture_of, png_of

DRAWINGS, PAGES = (".svg", ".pdf"), (".html", ".htm")
FILM_PICTURES = 64     # of the chirps of a frame
FRAMES_PER_SECOND = 10.0


def export(window, path, scale: int = 1, progress=None) -> None:
    """Writes what a window shows, by the name of the file: .png the window, .svg or .pdf its maps, .gif or .mp4 a film of its
    time line (of the chirps of its frame, where it has none), .html its scene.

    scale: of a PNG, 1 to 8 times the pixels of the screen along each axis; progress: callable (stage, fraction) or None
    Raises ep.FileError, ValueError for another kind, ModuleNotFoundError naming the package that a kind needs.
    """
    kind = Path(path).suffix.lower()
    if kind == ".png":
        _write_png(window, path, scale)
    elif kind in DRAWINGS:
        with written_whole(path) as temporary:
            temporary.write_bytes(drawing_of(window.map_area, kind))
    elif kind in FILMS:
        write_film(path, film_pictures(window, progress), FRAMES_PER_SECOND)
    elif kind in PAGES:
        ScenePage(window.session).save(path)
    else:
        kinds = ", ".join((".png", *DRAWINGS, *FILMS, *PAGES))
        raise ValueError(f"picture: must end in one of {kinds}, got {path}")


def _write_png(window, path, scale: int) -> None:
    picture = picture_of(window, scale)
    for keyword, text in origin_texts(window.session.paths.frame.seed if window.session else None).items():
        picture.setText(keyword, text)
    with written_whole(path) as temporary:
        temporary.write_bytes(png_of(picture))


def film_pictures(window, progress=None):
    """Pictures u8 [height, width, 3] of the window: frame by frame of its time line, or through the chirps of its frame."""
    shown = _frames(window) if window.time_line.line is not None else _chirps(window)
    count = next(shown)
    for number, _ in enumerate(shown):
        window.settle()
        yield _pixels(window.grab().toImage())
        if progress is not None:
            progress("pictures", (number + 1) / count)


def _chirps(window):
    session, count = window.session, window.session.radar.waveform.num_chirps
    before, steps = session.chirp, range(0, count, max(1, count // FILM_PICTURES))
    yield len(steps)
    try:
        for chirp in steps:
            session.set_chirp(chirp)
            yield chirp
    finally:
        session.set_chirp(before)


def _frames(window):
    control = window.time_line
    control.pause()  # its own frames would come between, and be shown in part
    before = control.place
    yield len(control.line)
    try:
        for place in range(len(control.line)):
            control.go(place)
            yield place
    finally:
        control.go(before)


def _pixels(image: QtGui.QImage):
    image = image.convertToFormat(QtGui.QImage.Format.Format_RGB888)
    rows = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
    return rows[:, :3 * image.width()].reshape(image.height(), image.width(), 3).copy()
