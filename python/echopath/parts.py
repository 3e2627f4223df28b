"""Signals of parts of the paths, which remember what the parts are."""
from __future__ import annotations

from ._core import decompose as _decompose


class Parts(dict):
    """{name: cube [tx, rx, chirp, sample] in sqrt(W)} of one partition, "other" last; made by `decompose`.

    cubes: as above; selections: {name: selection} as they were given, without "other"
    radar: that of the signals, None: not known
    """

    def __init__(self, cubes, selections, radar=None):
        super().__init__(cubes)
        self.selections = dict(selections)
        self.radar = radar


def decompose(paths, radar=None, parts=None, **settings):
    """The signals of parts of the paths, in one pass.

    paths: of `trace`; radar: another waveform, array or motion than that of the trace, or None
    parts: {name: selection}, where the first that takes a path has it; or {view: {name: selection}} for several views at
        once
    settings: tolerance (relative rms), method, replay, evaluate, phase_tolerance (rad), retrace, keyframes and progress, as in
        `synthesize`
    Returns Parts, {name: cube} with "other" for the rest, the cubes [tx, rx, chirp, sample] adding up to the whole; for
    several views {view: Parts}. Raises ValueError for bad names and selections.
    """
    parts = {} if parts is None else parts
    cubes = _decompose(paths, radar, parts, **settings)
    radar = paths.radar if radar is None else radar
    if parts and all(isinstance(group, dict) for group in parts.values()):
        return {view: Parts(cubes[view], group, radar) for view, group in parts.items()}
    return Parts(cubes, parts, radar)
