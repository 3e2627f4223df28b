"""Signals of parts of the paths, which remember what the parts are."""
from __future__ import annotations

from . import _core
from ._core import Grouping, Selection
from ._core import decompose as _decompose
from .families import Families

ONLY_PARTITION = "parts"  # name of a partition that is the only one and has none


class Parts(dict):
    """{name: cube [tx, rx, chirp, sample] in sqrt(W)} of one partition, "other" last; made by `decompose`.

    cubes: as above; selections: {name: selection} as they were given, without "other"; None for parts by families
    radar: that of the signals, None: not known
    """

    def __init__(self, cubes, selections, radar=None):
        super().__init__(cubes)
        self.selections = None if selections is None else dict(selections)
        self.radar = radar

    def __missing__(self, name):
        raise KeyError(f"no part '{name}'; there are {', '.join(map(str, self))}")


def decompose(paths, radar=None, parts=None, **settings):
    """The signals of parts of the paths, in one pass.

    paths: of `trace`; radar: another waveform, array or motion than that of the trace, or None
    parts: {name: selection}, where the first that takes a path has it; or the Families of the paths (`families`); or {view:
        either of them} for several views at once
    settings: tolerance (relative rms), method, replay, evaluate, phase_tolerance (rad), retrace, keyframes and progress,
        as in `synthesize`
    Returns Parts, {name: cube} with "other" for the rest, or {Family: cube} with the background last, the cubes [tx, rx,
    chirp, sample] adding up to the whole; for several views {view: Parts}. Raises ValueError for bad names and selections.
    """
    parts = {} if parts is None else parts
    is_one_view = not _is_table_of_views(parts)
    views = {"": parts} if is_one_view else parts
    cubes = _decompose(paths, radar, [_grouping(view) for view in views.values()], **settings)
    radar = paths.radar if radar is None else radar
    made = {name: Parts(of_view, view if isinstance(view, dict) else None, radar)
            for (name, view), of_view in zip(views.items(), cubes)}
    return made[""] if is_one_view else made


def _is_view(value) -> bool:
    return isinstance(value, (dict, Families, Grouping))


def _is_table_of_views(parts) -> bool:
    """Whether all values are views; none is: one view. Raises ValueError for a mixture."""
    if not _is_view(parts):
        raise TypeError(f"parts: must be a dict of selections or of views, or Families, got {type(parts).__name__}")
    if not isinstance(parts, dict):
        return False
    num_views = sum(map(_is_view, parts.values()))
    if num_views not in (0, len(parts)):
        raise ValueError(f"parts: must be all selections or all dicts of selections, dicts, got {num_views}")
    return num_views > 0


def _grouping(view) -> Grouping:
    if isinstance(view, Grouping):
        return view
    return view.grouping if isinstance(view, Families) else Grouping.selections(list(view.items()))


def as_partitions(parts) -> dict:
    """{name: selection} or {partition: {name: selection}} -> the latter."""
    if not parts:
        return {}
    nested = [isinstance(value, dict) for value in parts.values()]
    if all(nested):
        return {partition: dict(group) for partition, group in parts.items()}
    if any(nested):
        raise ValueError(f"parts: must be all selections or all tables of selections, got {list(parts)}")
    return {ONLY_PARTITION: dict(parts)}


def check_partitions(partitions: dict, scene) -> None:
    """Raises ValueError naming the part whose name or text is faulty or that names no mesh of the scene.

    partitions: {partition: {part: selection}}. Cheap: to know before a long trace.
    """
    for partition, group in partitions.items():
        key = "parts" if partition == ONLY_PARTITION else f"parts.{partition}"
        for name, selection in group.items():
            try:
                _core.check_part_names([(name, selection)])
                Selection(selection).check(scene)
            except ValueError as error:
                raise ValueError(f"{key}.{name}: {str(error).removeprefix('parts: ')}") from None


def parts_of_options(texts) -> dict:
    """{name: Selection} of texts NAME=SELECTION, in their order. Raises ValueError where one is not of that form."""
    parts = {}
    for text in texts or []:
        name, equals, expression = text.partition("=")
        name = name.strip()
        if not (name and equals):
            raise ValueError(f"part: must be NAME=SELECTION, as in ghosts=\"T .* 'wall*' .* R\", got {text}")
        if name in parts:
            raise ValueError(f"part: must have a name of its own, got {name} twice")
        parts[name] = Selection(expression)
    return parts
