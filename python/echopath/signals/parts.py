"""Signals of parts of the paths, which remember what the parts are."""
from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from .. import _core
from .._core import Grouping, Selection
from ..arguments.checks import Progress, an, checked, optional, refused, text
from ..arguments.names import first_names
from ..arguments.settings import Evaluate, Method, Replay, Retrace, SignalSettings
from ..base.classes.equality import is_same
from ..base.classes.made_by import made_by
from ..paths.families import Families
from ..transmit.signals import decompose_slots
from .if_signal import RULES

View = Mapping[Any, Selection | str] | Families | Grouping
Selections = Mapping[str, Selection | str | Mapping[str, Selection | str]]  # one partition, or several
Views = Mapping[Any, Selection | str | View] | Families | Grouping | None  # one view, or several
_VIEWS = (Mapping, Families, Grouping)

_ONE_KIND = "all selections (one partition) or all tables of selections (several)"
ONLY_PARTITION = "parts"  # name of a partition that is the only one and has none


@made_by("ep.decompose")
class Parts(dict[Any, Any]):
    """{name: cube [tx, rx, chirp, sample] in sqrt(W)} of one partition, "other" last; made by `decompose`.

    cubes: as above; selections: {name: selection} as they were given, without "other"; None for parts by families
    radar: that of the signals, None: not known
    """

    def __init__(self, cubes, selections, radar=None):
        for argument, value in (("cubes", cubes), ("selections", {} if selections is None else selections)):
            if not isinstance(value, Mapping):
                raise refused(TypeError, argument, "a dict by the names of the parts", value)
        if radar is not None and not isinstance(radar, _core.Radar):
            raise refused(TypeError, "radar", "a Radar or None", radar)
        super().__init__(cubes)
        self.selections = None if selections is None else dict(selections)
        self.radar = radar

    def __eq__(self, other) -> bool:
        return is_same(dict(self), dict(other)) if isinstance(other, dict) else NotImplemented

    def __ne__(self, other) -> bool:
        return not self == other

    __hash__ = None

    def __repr__(self) -> str:
        shape = "".join(f": {list(np.shape(cube))}" for cube in list(self.values())[:1])
        return f"Parts({first_names(list(map(str, self)))}{shape})"

    def __missing__(self, name):
        raise KeyError(f"no part '{name}'; there are {', '.join(map(str, self))}")


def selection_rule(argument: str, value: Selection | str) -> Selection | str:
    """A Selection, or the text of one, which must be free of faults."""
    if isinstance(value, Selection):
        return value
    if not isinstance(value, str):
        raise refused(TypeError, argument, "a Selection or its text", value)
    try:
        Selection(text(argument, value))
    except ValueError as error:
        told = str(error)
        raise ValueError(told if told.startswith(f"{argument}:") else f"{argument}: {told}") from None
    return value


def _selections_rule(argument: str, group: Mapping) -> None:
    for name, chosen in group.items():
        selection_rule(f"{argument}.{text(argument, name)}", chosen)


def _views_rule(argument: str, value):
    """None, {name: selection}, Families, or {view: either of them}."""
    value = {} if value is None else value
    if not _is_table_of_views(value):
        if isinstance(value, Mapping):
            _selections_rule(argument, value)
        return value
    for name, view in value.items():
        if isinstance(view, Mapping):
            _selections_rule(f"{argument}.{name}", view)
    return value


def are_tables(parts: Mapping, kinds: type | tuple[type, ...] = Mapping, called: str = "parts") -> bool:
    """Whether the values are tables of parts; none is: they are the parts of one. Raises ValueError for a mixture.

    kinds: what counts as a table; called: the argument that holds the parts
    """
    num_tables = sum(isinstance(value, kinds) for value in parts.values())
    if num_tables not in (0, len(parts)):
        raise refused(ValueError, called, _ONE_KIND, list(parts))
    return num_tables > 0


def as_partitions(parts) -> dict:
    """{name: selection} or {partition: {name: selection}} -> the latter, whose selections are free of faults."""
    if parts is None:
        return {}
    if not isinstance(parts, Mapping):
        raise refused(TypeError, "parts", "a dict of selections, or of such dicts", parts)
    partitions = {text("parts", name): dict(group) for name, group in parts.items()} if are_tables(parts) else {
        ONLY_PARTITION: dict(parts)} if parts else {}
    for name, group in partitions.items():
        _selections_rule("parts" if name == ONLY_PARTITION else f"parts.{name}", group)
    return partitions


def as_partition(argument: str, parts) -> dict | None:
    """{name: selection} of one partition, whose selections are free of faults, or None."""
    if parts is None:
        return None
    if not isinstance(parts, Mapping):
        raise refused(TypeError, argument, "a dict of selections or None", parts)
    _selections_rule(argument, parts)
    return dict(parts)


def _is_table_of_views(parts) -> bool:
    """Whether all values are views; none is: one view. Raises ValueError for a mixture."""
    if not isinstance(parts, _VIEWS):
        raise refused(TypeError, "parts", "a dict of selections or of views, or Families", parts)
    if not isinstance(parts, Mapping):
        return False
    return are_tables(parts, _VIEWS)


def _grouping(view) -> Grouping:
    if isinstance(view, Grouping):
        return view
    return view.grouping if isinstance(view, Families) else Grouping.selections(list(view.items()))


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
    for option in texts or []:
        name, equals, expression = option.partition("=")
        name = name.strip()
        if not (name and equals):
            raise ValueError(f"part: must be NAME=SELECTION, as in walls=\"T .* 'wall*' .* R\", got {option}")
        if name in parts:
            raise ValueError(f"part: must have a name of its own, got {name} twice")
        try:
            parts[name] = Selection(expression)
        except ValueError as error:
            raise ValueError(f"part: {name}: {error}") from None
    return parts


def _radar_rule(argument: str, value):
    """None or a Radar; `annotate` takes the parts in its place."""
    called = "a Radar (selections are its parts=)" if isinstance(value, _VIEWS) else ""
    return optional(an(_core.Radar, called=called))(argument, value)


@checked({"settings": SignalSettings}, **RULES | {"radar": _radar_rule}, parts=_views_rule)
def decompose(paths: _core.Paths, radar: _core.Radar | None = None, parts: Views = None, *,
              tolerance: float = SignalSettings.tolerance, method: Method = SignalSettings.method,
              replay: Replay = SignalSettings.replay, evaluate: Evaluate = SignalSettings.evaluate,
              phase_tolerance: float = SignalSettings.phase_tolerance, retrace: Retrace = SignalSettings.retrace,
              keyframes: int = SignalSettings.keyframes, settings: SignalSettings | None = None,
              probe: _core.SignalProbe | None = None, progress: Progress = None) -> Parts | Any:
    """The signals of parts of the paths, in one pass.

    paths: of `trace`; radar: another waveform, array or motion than that of the trace, or None
    parts: {name: selection}, where the first that takes a path has it; or the Families of the paths (`families`); or {view:
        either of them} for several views at once; None: all paths are "other"
    tolerance (relative rms), method, replay, evaluate, phase_tolerance (rad), retrace, keyframes, settings, probe, progress:
        as in `synthesize`
    Cubes are those of each transmitter alone, [tx, rx, chirp, sample], for transmitters that send at once, too: what
    `demultiplex` aims at. Slots that differ in frequency or bandwidth cost one pass for each kind, and take no probe.
    Returns Parts, {name: cube} with "other" for the rest, or {Family: cube} with the background last, the cubes [tx, rx,
    chirp, sample] adding up to the whole; for several views {view: Parts}. Raises TypeError or ValueError naming the
    argument, also for bad names and selections.
    """
    parts = {} if parts is None else parts
    is_one_view = not _is_table_of_views(parts)
    views = {"": parts} if is_one_view else parts
    check_partitions({name or ONLY_PARTITION: view for name, view in views.items() if isinstance(view, Mapping)}, paths.scene)
    radar = paths.radar if radar is None else radar
    cubes = decompose_slots(paths, radar, [_grouping(view) for view in views.values()], tolerance=tolerance, method=method,
                            replay=replay, evaluate=evaluate, phase_tolerance=phase_tolerance, retrace=retrace,
                            keyframes=keyframes, progress=progress, probe=probe)
    made = {name: Parts(of_view, view if isinstance(view, Mapping) else None, radar)
            for (name, view), of_view in zip(views.items(), cubes)}
    return made[""] if is_one_view else made
