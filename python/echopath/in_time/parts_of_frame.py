"""The signals of the objects and ghosts of a frame, of which there may be thousands that no cell shows."""
from __future__ import annotations

import numpy as np

from ..arguments.settings import FRAME_KEYWORDS
from ..base.radar.antennas import one_of_each_look
from ..frame.frame import Frame
from ..labels.ghost_names import ghost_name
from ..labels.planes import with_receivers
from ..labels.powers import parts_by_rival
from ..paths.cells import chirp_times
from ..paths.families import Families, families
from ..signals.part_pass import part_pass, takes_a_pass
from ..signals.parts import decompose


class PartsOfFrame:
    """What the echoes of a frame are made of, cubes [tx, rx, chirp, sample] in sqrt(W) that add up to them.

    objects: {name: cube} of their own echoes; ghosts: {name: cube}, those that no map tells apart as one
    faint: cube of all other ghosts; rest: cube of what touches no object; has_ghosts: whether there are any
    """

    def __init__(self, frame: Frame, objects, least: float, channel):
        """least: W, of a ghost whose paths add up in phase, up to which it is faint; objects, channel: as in `spectrogram`"""
        of_paths = families(frame.paths, objects)
        signals = _Signals(frame, of_paths, channel)
        numbers = {family: number for number, family in enumerate(signals.families)}
        groups = list(parts_by_rival(signals.families).values())
        in_phase = _in_phase(frame, of_paths, channel, len(signals.families))
        members = [[numbers[family] for family in group] for group in groups]
        faint = [group[0].is_ghost and in_phase[some].sum() ** 2 <= least for group, some in zip(groups, members)]
        parts = [some for some, is_faint in zip(members, faint) if not is_faint]
        together = [number for some, is_faint in zip(members, faint) if is_faint for number in some]
        *cubes, self.faint = signals.cubes([*parts, together])
        firsts = [group for group, is_faint in zip(groups, faint) if not is_faint]
        self.has_ghosts = any(group[0].is_ghost for group in groups)
        self.ghosts = {_name_of(group): cube for group, cube in zip(firsts, cubes) if group[0].is_ghost}
        self.objects = {group[0].object: cube for group, cube in zip(firsts, cubes) if group[0].object and not group[0].is_ghost}
        self.rest = sum(cube for group, cube in zip(firsts, cubes) if not group[0].object)


def _in_phase(frame: Frame, of_paths: Families, channel, count: int) -> np.ndarray:
    """Sum [count] in sqrt(W) of the most that the paths of each family have at the begin, the middle and the end of the frame,
    for antennas of every kind; infinity for those behind them, of which only renewed records have paths."""
    paths, radar = frame.paths, frame.radar
    senders, receivers = ([asked] if asked is not None else one_of_each_look(antennas) for asked, antennas in
                          zip(channel or (None, None), (radar.transmitters, radar.receivers)))
    most = np.zeros(paths.num_paths)
    for tx in senders:
        for time in chirp_times(paths, tx):
            for amplitude in paths._echoes_at_receivers(time, tx, receivers)[1]:
                np.maximum(most, np.abs(amplitude), out=most)
    found = np.full(count, np.inf)
    found[:len(of_paths)] = np.bincount(of_paths.family_of_path, most, len(of_paths))
    return found


class _Signals:
    """The signals of the families of a frame.

    families: those of its paths, behind them those that only its renewed records have
    """

    def __init__(self, frame: Frame, of_paths: Families, channel):
        self._paths, self._of_paths = frame.paths, of_paths
        self._tx, rx = channel or (None, None)
        self._radar = frame.radar if rx is None else with_receivers(frame.radar, slice(rx, rx + 1))
        self._settings = {name: getattr(frame, name) for name in FRAME_KEYWORDS}
        self._made = None
        if not takes_a_pass(self._radar, self._settings):
            self._made = decompose(frame.paths, self._radar, of_paths, **self._settings)
        self.families = list(dict.fromkeys([*of_paths.families, *(self._made or ())]))

    def cubes(self, parts: list) -> list:
        """Of parts, lists of indices of families that hold each family once, of the channels that are asked for."""
        found = self._by_pass(parts) if self._made is None else self._sums(parts)
        return [cube if self._tx is None else cube[self._tx:self._tx + 1] for cube in found]

    def _sums(self, parts: list) -> list:
        nothing = np.zeros_like(next(iter(self._made.values())))
        return [sum((self._made.get(self.families[number], nothing) for number in part), nothing) for part in parts]

    def _by_pass(self, parts: list) -> list:
        part_of_family = np.empty(len(self.families), np.uint32)
        for number, part in enumerate(parts):
            part_of_family[part] = number
        groups = part_of_family[self._of_paths.family_of_path]
        one_pass = part_pass(self._paths, self._radar, groups, len(parts), self._settings)
        one_pass.set_adds_up(False)
        return one_pass.cubes([[number] for number in range(len(parts))], None)


def _name_of(ghosts: list) -> str:
    """Of families that go over the same mirrors as often, there or back, which no map tells apart."""
    if len(ghosts) == 1:
        return ghost_name(ghosts[0])
    first, types = ghosts[0], sorted({family.ghost_type for family in ghosts})
    return f"{first.object}, type {' and '.join(map(str, types))}, order {first.order} via {', '.join(first.via)}"
