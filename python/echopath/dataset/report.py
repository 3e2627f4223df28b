"""One HTML page that shows what a dataset holds, without other files."""
from __future__ import annotations

import base64
import html
import io
import os
from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from .. import _core
from ..arguments.checks import checked, path as path_rule
from ..base.numerics.decibels import in_dbm
from ..base.storage.files import write_texts
from ..paths.resolution import RESOLVED_DB
from ..plots.style import CURVE_COLOURS, new_figure
from ..presentation.notebook import validity_html
from ..signals.measures import for_pictures
from ..tracing.validity import validity
from .classes import CODES
from .folder import read_record
from .opened import Dataset, dataset_rule
from .statistics import Statistics, statistics_of

EXAMPLES, MOST_DRAWN, FEW = 4, 12, 6  # pictures of frames; drawn numbers that are shown; values that have a bar each
_DPI = 100
_STYLE = ("body{font:15px/1.5 sans-serif;max-width:70em;margin:2em auto;padding:0 1em;color:#222}"
          "table{border-collapse:collapse}td,th{padding:.2em .8em;border-bottom:1px solid #ddd;text-align:right}"
          "td:first-child,th:first-child{text-align:left}img{max-width:100%}")


@checked(dataset=dataset_rule, path=path_rule)
def write_report(dataset: Dataset, path: str | os.PathLike[str]) -> None:
    """Writes one HTML file about a dataset: what is done, objects by class, range and power, ghosts, detections, what was drawn,
    how well the rays know the powers, and frames chosen evenly with their validity (`ep.validity`).

    dataset: as of `open`; path: of the file, written whole or not at all. At most 2000 frames, evenly spread, are read; those
        that are shown are made again where their paths were not kept.
    Raises ep.FileError where the file cannot be written.
    """
    found = statistics_of(dataset)
    parts = [f"<h1>{html.escape(str(dataset.template.table.get('title') or dataset.folder.name))}</h1>", *_facts(dataset, found),
             *_classes(dataset, found), *_histograms(found), *_errors(found), *_detections(found), *_drawn(found),
             *_examples(dataset)]
    head = f'<!doctype html><meta charset="utf-8"><title>Dataset</title><style>{_STYLE}</style>'
    path = Path(path)
    write_texts(path.parent, {path.name: "\n".join([head, *parts]) + "\n"})


def _facts(dataset: Dataset, found: Statistics) -> Iterable[str]:
    settings = dataset.template.settings
    records = [read_record(dataset.folder, scene) for scene in range(settings.scenes)]
    states = Counter(record.state for record in records)
    yield _table(("", ""), [
        ("scenes done", f"{states['done']} of {settings.scenes}"), ("frames done", str(len(dataset))),
        *((f"frames of '{name}'", str(len(dataset.split(name)))) for name in settings.split),
        ("frames read for this page", str(found.frames))])
    failed = [(f"scene {scene}", record.reason) for scene, record in enumerate(records) if record.state == "failed"]
    if failed:
        yield "<h2>Scenes that failed</h2>" + _table(("scene", "reason"), failed)


def _classes(dataset: Dataset, found: Statistics) -> Iterable[str]:
    """Objects, one for each frame that it is in, by class and split, and by status."""
    kinds = _kinds(found)
    if not kinds:
        return
    splits, statuses = list(dataset.template.settings.split), sorted({one.status for one in found.objects})
    counts: Counter[tuple[str, str]] = Counter((one.kind, name) for one in found.objects for name in (one.split, one.status))
    ghosts = Counter({kind: sum(count for (owner, _), count in found.ghosts.items() if owner == kind) for kind in kinds})
    cells = Counter({kind: sum(one.cells for one in found.objects if one.kind == kind) for kind in kinds})
    yield "<h2>Objects</h2><p>Each counts once in every frame.</p>" + _table(
        ("class", *splits, *statuses, "cells", "cells of ghosts"),
        [(kind, *(str(counts[kind, name]) for name in (*splits, *statuses)), str(cells[kind]), str(ghosts[kind]))
         for kind in kinds])


def _kinds(found: Statistics) -> list[str]:
    return [kind for kind in CODES if any(one.kind == kind for one in found.objects)]


def _histograms(found: Statistics) -> Iterable[str]:
    """Ranges and powers of objects that have a cell, by class."""
    seen = {kind: [one for one in found.objects if one.kind == kind and one.power] for kind in _kinds(found)}
    seen = {kind: ones for kind, ones in seen.items() if ones}
    if not seen:
        return
    colours = [CURVE_COLOURS[index % len(CURVE_COLOURS)] for index in range(len(seen))]
    with new_figure(11.0, 3.4) as figure:
        left, right = figure.subplots(1, 2)
        for axes, label, values in (
                (left, "Range of the strongest cell in m", [[one.range for one in ones] for ones in seen.values()]),
                (right, "Power of the strongest cell in dBm",
                 [[in_dbm(one.power) for one in ones if one.power] for ones in seen.values()])):
            axes.hist(values, bins=24, stacked=True, color=colours, label=list(seen))
            axes.set_xlabel(label)
            axes.set_ylabel("Objects in frames")
        left.legend()
    yield "<h2>Where they are, and how strong</h2>" + _image(figure)


def _errors(found: Statistics) -> Iterable[str]:
    """How well the rays know the mean powers of the objects that have cells."""
    errors = {kind: found.errors_db(kind) for kind in _kinds(found)}
    rows = [(kind, *(_decibels(np.quantile(ones, share, method="higher")) for share in (0.5, 0.9)),
             f"{100.0 * np.mean(np.array(ones) <= RESOLVED_DB):.0f} %") for kind, ones in errors.items() if ones]
    if rows:
        yield ("<h2>Monte-Carlo error</h2><p>How far the 95 % interval of an object's mean power reaches: what more rays would "
               "change.</p>")
        yield _table(("class", "half within", "nine of ten within", f"within {RESOLVED_DB} dB"), rows)


def _decibels(value: float) -> str:
    return f"{value:.1f} dB" if np.isfinite(value) else "not known"


def _detections(found: Statistics) -> Iterable[str]:
    if found.detections:
        yield "<h2>Detections</h2>" + _table(("what made them", "number", "a frame"), [
            (name, str(count), f"{count / found.frames:.2f}") for name, count in found.detections.most_common()])


def _drawn(found: Statistics) -> Iterable[str]:
    """Histograms of the numbers that were drawn in the most scenes."""
    numbers = {place: values for place, values in found.drawn.items()
               if len(set(map(str, values))) > 1 and all(isinstance(one, (int, float)) for one in values)}
    chosen = sorted(numbers, key=lambda place: (-len(numbers[place]), place))[:MOST_DRAWN]
    if not chosen:
        return
    rows = -(-len(chosen) // 3)
    with new_figure(11.0, 2.3 * rows) as figure:
        panels = figure.subplots(rows, 3, squeeze=False).flat
        for place, axes in zip(chosen, panels):  # in this order: the iterator that ends first takes none of the other
            _draw_numbers(axes, numbers[place])
            axes.set_title(place.removeprefix("objects."))
            axes.set_xlabel("Value (SI units where its name says no other)")
            axes.set_ylabel("Scenes")
        for axes in list(panels):  # what is left of the iterator
            axes.set_axis_off()
    yield "<h2>What was drawn</h2>" + _image(figure)


def _draw_numbers(axes: Any, values: list[float]) -> None:
    """A bar for each value where few were drawn again and again, else a histogram."""
    counts = sorted(Counter(values).items())
    axes.yaxis.get_major_locator().set_params(integer=True)
    if len(counts) <= FEW and (len(counts) < len(values) or all(isinstance(one, int) for one in values)):
        axes.bar([for_pictures(f"{value:g}") for value, _ in counts], [count for _, count in counts], color=CURVE_COLOURS[0])
    else:
        axes.hist(values, bins=20, color=CURVE_COLOURS[0])


def _examples(dataset: Dataset) -> Iterable[str]:
    """Labelled maps of some frames, evenly chosen, and whether one trace serves each."""
    places = sorted({int(place) for place in np.linspace(0, len(dataset) - 1, EXAMPLES)}) if len(dataset) else []
    for one in (dataset[place] for place in places):
        for labels in list(one.frame.labels.values())[:1]:
            with new_figure(11.0, 4.4) as figure:
                title = f"Frame {one.number}: scene {one.scene}, {one.split}"
                labels.plot("objects", ax=figure.subplots(), title=title)
            yield _image(figure)
        yield _validity(dataset, dataset.numbers.index(one.number))


def _validity(dataset: Dataset, place: int) -> str:
    """Whether one trace serves a frame, which is made again where its paths were not kept; why not, where it cannot be."""
    try:
        frame: Any = (dataset if dataset.keep == "all" else dataset.remade())[place].frame
    except (ValueError, _core.FileError) as error:
        return f"<p>Its validity is not known: {html.escape(str(error))}</p>"
    return validity_html(validity(frame.paths, frame.radar, replay=frame.replay))


def _image(figure: Any) -> str:
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=_DPI, metadata={"Software": None})
    return f'<p><img alt="" src="data:image/png;base64,{base64.b64encode(buffer.getvalue()).decode()}"></p>'


def _table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    def line(cells: Iterable[str], tag: str) -> str:
        return "<tr>" + "".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in cells) + "</tr>"

    return "<table>" + line(head, "th") + "".join(line(row, "td") for row in rows) + "</table>"
