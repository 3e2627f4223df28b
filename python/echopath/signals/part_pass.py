"""Signals of many groups of paths, of which some are made at a time."""
from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from .. import _core
from ..arguments.settings import SignalSettings
from ..transmit.signals import has_steps

_KEYWORDS = ("tolerance", "method", "replay", "evaluate", "phase_tolerance")


def takes_a_pass(radar: _core.Radar, settings: Mapping[str, object]) -> bool:
    """Whether groups of paths can be made some at a time: groups of later records are not known before, and those of chirps that
    differ have no common pass. settings: keywords of `synthesize`"""
    return settings.get("retrace", SignalSettings.retrace) == "never" and not has_steps(radar)


def part_pass(paths: _core.Paths, radar: _core.Radar, group_of_path: np.ndarray, num_groups: int,
              settings: Mapping[str, object], probe: _core.SignalProbe | None = None) -> _core.PartPass:
    """A pass over the groups. group_of_path: u32 [P]; settings: keywords of `synthesize`, others are left aside"""
    keywords = {name: settings.get(name, getattr(SignalSettings, name)) for name in _KEYWORDS}
    return _core.PartPass(paths, radar, group_of_path, num_groups, probe=probe, **keywords)
