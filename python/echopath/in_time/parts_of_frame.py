"""The signals of the objects and ghosts of a frame, of which there may be thousands that no cell shows."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..arguments.settings import FRAME_KEYWORDS, SignalSettings
from ..frame.frame import Frame
from ..labels.ghost_names import ghost_name
from ..labels.planes import with_receivers
from ..labels.powers import parts_by_rival
from ..paths.families import Families, families
from ..signals.parts import decompose
from ..transmit.signals import has_steps

_OF_PASS = ("tolerance", "method", "replay", "evaluate", "phase_tolerance")  # keywords of `_core.PartPass`


class PartsOfFrame:
    """What the echoes of a frame are made of, cubes [tx, rx, chirp, sample] in sqrt(W) that add up to them.

    objects: {name: cube} of their own echoes; ghosts: {name: cube}, those that no map tells apart as one
    faint: cube of all other ghosts; rest: cube of what touches no object; has_ghosts: whether there are any
    """

    def __init__(self, frame: Frame, objects, least: float, channel):
        """least: W, of a ghost whose paths add up in phase, up to which it is faint; objects, channel: as in `spectrogram`"""
        of_paths = families(frame.paths, objects)
        groups = list(parts_by_rival(of_paths.families).values())
        in_phase = _in_phase(frame, of_paths)
        numbers = {family: number for number, family in enumerate(of_paths.families)}
        members = [[numbers[family] for family in group] for group in groups]
        faint = [group[0].is_ghost and in_phase[some].sum() ** 2 <= least for group, some in zip(groups, members)]
        parts = [some for some, is_faint in zip(members, faint) if not is_faint]
        together = [number for some, is_faint in zip(members, faint) if is_faint for number in some]
        *cubes, self.faint = _cubes(frame, of_paths, [*parts, together], channel)
        firsts = [group for group, is_faint in zip(groups, faint) if not is_faint]
        self.has_ghosts = any(group[0].is_ghost for group in groups)
        self.ghosts = {_name_of(group): cube for group, cube in zip(firsts, cubes) if group[0].is_ghost}
        self.objects = {group[0].object: cube for group, cube in zip(firsts, cubes) if group[0].object and not group[0].is_ghost}
        self.rest = sum(cube for group, cube in zip(firsts, cubes) if not group[0].object)


def _in_phase(frame: Frame, of_paths: Families) -> np.ndarray:
    """Sum [F] in sqrt(W) of what the paths of each family have at the time of the trace, for the first antennas."""
    paths = frame.paths
    amplitude = np.abs(paths._echoes_at_receivers(paths.frame.trace_time, 0, [0])[1][0])
    return np.bincount(of_paths.family_of_path, amplitude, len(of_paths))


def _cubes(frame: Frame, of_paths: Families, parts: list, channel) -> list:
    """Signals of parts, lists of indices of families that hold each family once, of the channels that are asked for."""
    tx, rx = channel or (None, None)
    radar = frame.radar if rx is None else with_receivers(frame.radar, slice(rx, rx + 1))
    settings = {name: getattr(frame, name) for name in FRAME_KEYWORDS}
    if settings["retrace"] != "never" or has_steps(radar):
        by_family = list(decompose(frame.paths, radar, of_paths, **settings).values())
        nothing = np.zeros_like(by_family[0])
        found = [sum((by_family[number] for number in part), nothing) for part in parts]
    else:
        part_of_family = np.empty(len(of_paths), np.uint32)
        for number, part in enumerate(parts):
            part_of_family[part] = number
        signal = {name: settings.get(name, getattr(SignalSettings, name)) for name in _OF_PASS}
        one_pass = _core.PartPass(frame.paths, radar, part_of_family[of_paths.family_of_path], len(parts), **signal)
        one_pass.set_adds_up(False)
        found = one_pass.cubes([[number] for number in range(len(parts))], None)
    return [cube if tx is None else cube[tx:tx + 1] for cube in found]


def _name_of(ghosts: list) -> str:
    """Of families that go over the same mirrors as often, there or back, which no map tells apart."""
    if len(ghosts) == 1:
        return ghost_name(ghosts[0])
    first, types = ghosts[0], sorted({family.ghost_type for family in ghosts})
    return f"{first.object}, type {' and '.join(map(str, types))}, order {first.order} via {', '.join(first.via)}"
