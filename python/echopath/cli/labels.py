"""`echopath labels FRAME.h5`: labels the map of a frame from its file alone."""
from __future__ import annotations

from pathlib import Path

from ..arguments.settings import LabelSettings
from ..frame.detections import detect_frame
from ..frame.labels import annotate_frame
from ..frame.unresolved import unresolved_of_frame
from ..frame_file import left_out, load_frame, save_labels
from . import report
from .label_outputs import write_labels
from .run import DETECTIONS_NAME, chosen_partition
from .typed_names import told_as
from .warned import pictures_warned

LABELS_NAME = "labels.h5"


def label_file(path, folder, *, settings: LabelSettings, parts=(), cfar=None, progress=None) -> list[str]:
    """Labels the map of a frame file, writes labels.h5, detections.csv, maps and pictures, and says what is in them.

    path: of the frame file; folder: of what is written
    settings: how to label; parts: texts NAME=SELECTION of a partition "choice" beside those of the file
    progress: callable (stage, fraction) or None
    cfar: keywords of `cfar` for the detections, of frames with signals
    Returns the lines of a report. Raises ValueError for bad input, ep.FileError for bad files.
    """
    path, folder = Path(path), Path(folder)
    with told_as(path="FRAME.h5"):
        missing, frame = left_out(path), load_frame(path)
    chosen = chosen_partition(parts, frame.parts)
    frame.labels = annotate_frame(frame, chosen, settings=settings, progress=progress)
    detections = ["no detections: the file has paths alone, no signals"]
    if frame.spectrum is not None:
        frame.detections = detect_frame(frame, objects=settings.objects, progress=progress, **cfar or {})
        frame.detections.to_csv(folder / DETECTIONS_NAME)
        detections = report.detections(frame.detections, frame.labels, report.other_method(cfar, "--cfar os"),
                                       file=DETECTIONS_NAME)
    written = [folder / LABELS_NAME]
    save_labels(frame.labels, written[0])
    with pictures_warned("the labels are written, but not all of their pictures"):
        written.extend(write_labels(frame, folder, frame.selections | chosen))
    return [str(path), *report.counts(frame.paths), report.omissions(missing, path), *report.labels(frame.labels),
            *detections, f"written to {folder}",
            f"  {', '.join(str(one.relative_to(folder)) for one in written)}",
            *report.unresolved(unresolved_of_frame(frame, settings.objects, progress), frame.paths, missing)]


def objects_of_options(texts) -> dict | None:
    """{name: [globs]} of texts NAME=GLOB, of which several may have one name; None of no texts. Raises ValueError."""
    objects = {}
    for text in texts:
        name, _, glob = (word.strip() for word in text.partition("="))
        if not (name and glob):
            raise ValueError(f"object: must be NAME=GLOB, as in cars='car_*', got {text}")
        objects.setdefault(name, []).append(glob)
    return objects or None
