"""Which echoes make a cell: complex contributions of families of paths, which add up to its value."""
from __future__ import annotations

import dataclasses
from functools import cached_property

import numpy as np

import echopath as ep
from echopath import _core
from echopath.base.numerics.decibels import SMALLEST_POWER, in_dbm
from echopath.base.text.mesh_names import object_of
from echopath.spectra.range_transform import range_profiles
from echopath.spectra.windows import of_velocity, samples_of
from echopath.transmit.signals import decompose_slots

MAX_BYTES = 2 << 30     # of the signals of all families, while they are made
MAX_MIRRORS = 16        # told apart in the background: those that most paths touch
REST = "rest: noise, left-out paths"
REST_RECEIVED = "rest: what the receiver makes, noise, left-out paths"  # its gains, filters and faults are in no family
WITH_WEAK = "{}, {:,} weak families"  # one of these, where not all families have room
BACKGROUND = "background"
ON_WAY = "on the way"   # part of the paths over a mirror, whatever its name; "other" are the others


@dataclasses.dataclass(frozen=True)
class EchoGroup:
    """Paths of one family that touch the same things.

    name: as it is shown; touched: names of the objects and mirrors on their way, those that can be taken out
    peak_range (m), peak_velocity (m/s): where its own map is highest, at the first channel; family: ep.Family
    """

    name: str
    touched: frozenset
    peak_range: float
    peak_velocity: float
    family: object = None


@dataclasses.dataclass(frozen=True)
class Contribution:
    """What a group of echoes adds to a cell: `value` in sqrt(W), complex; without_db: change of the cell's level without it."""

    name: str
    value: complex
    without_db: float
    group: EchoGroup | None = None


@dataclasses.dataclass(frozen=True)
class CellAttribution:
    """The value of a cell, or of a beam of one, in sqrt(W) and what makes it; the contributions add up to the value.

    contributions: strongest first, last what no family has; without: ((name, dB), ...), the change of the level without all
    paths that touch an object or a mirror, the largest first
    """

    value: complex
    contributions: tuple
    without: tuple

    @property
    def strongest(self) -> Contribution:
        """The largest contribution."""
        return max(self.contributions, key=lambda one: abs(one.value))

    @property
    def level_dbm(self) -> float:
        """Of the cell, dB re 1 mW."""
        return float(in_dbm(abs(self.value) ** 2, SMALLEST_POWER))


class Attribution:
    """The signals of the families of a frame, kept so that any cell is taken apart at once. Where those of all would take more
    than MAX_BYTES, the weakest join the rest of each cell.

    groups: tuple of EchoGroup
    """

    def __init__(self, signals, objects=None, progress=None):
        """signals: model.Signals of the frame; objects: as in `ep.families`; progress: callable (stage, fraction)

        Raises ValueError where the signal of one family would take more than MAX_BYTES.
        """
        self._paths, self._settings = signals.paths, signals.spectrum_settings
        families = ep.families(self._paths, objects)
        mirrors = self._mirrors(families)
        waveform, radar = self._paths.radar.waveform, self._paths.radar
        kept, self._num_weak = self._kept(families, mirrors)
        of_kept = ep.families(kept, objects) if self._num_weak else families
        cubes = self._decomposed(kept, of_kept, mirrors, signals.settings, progress)
        self._num_ranges = signals.num_ranges
        # What a click needs of a channel and a range is one piece.
        self._profiles = np.zeros((len(radar.transmitters), len(radar.receivers), self._num_ranges, len(cubes),
                                   waveform.num_chirps), np.complex64)
        self._families, self._mirror_names = families, mirrors
        self.groups = tuple(self._group(row, key, mirrors, cube) for row, (key, cube) in enumerate(cubes.items()))

    def _mirrors(self, families) -> list[str]:
        """What the paths of the background touch and is no object: names of children of the root."""
        background = families.family_of_path == len(families.families) - 1
        paths, offsets = np.flatnonzero(background), np.asarray(self._paths.offsets)
        counts = np.zeros(len(self._paths.scene.meshes), np.int64)
        num_bounces, mesh_id = np.asarray(self._paths.num_bounces), np.asarray(self._paths.mesh_id)
        for hit in range(int(num_bounces[paths].max(initial=0))):
            at = offsets[paths[num_bounces[paths] > hit]] + hit
            counts += np.bincount(mesh_id[at], minlength=len(counts))
        totals = {}
        for mesh, count in zip(self._paths.scene.meshes, counts):
            top = object_of(mesh.name)
            totals[top] = totals.get(top, 0) + int(count)
        return sorted((name for name, count in totals.items() if count), key=lambda name: -totals[name])[:MAX_MIRRORS]

    def _kept(self, families, mirrors) -> tuple:
        """(paths of the strongest families for whose signals there is room, number of the others)."""
        radar, waveform, count = self._paths.radar, self._paths.radar.waveform, len(families)
        size = 16 * len(radar.transmitters) * len(radar.receivers) * waveform.num_chirps * waveform.num_samples
        room = MAX_BYTES // size - len(mirrors)  # the background is several, by its mirrors
        if room < 1:
            raise ValueError(f"families: the signals of one and {len(mirrors)} mirrors would take more than "
                             f"{MAX_BYTES / 2**30:g} GiB")
        if count <= room:
            return self._paths, 0
        powers = ep.received_powers(self._paths, families.family_of_path, count)
        strongest = np.argsort([-power.power for power in powers], kind="stable")[:room]
        return self._paths.select(np.isin(families.family_of_path, strongest)), count - room

    def _decomposed(self, paths, families, mirrors, settings, progress) -> dict:
        """{(family, ON_WAY or "other" of each mirror): cube}, the mirrors telling the paths of the background apart."""
        views = [families.grouping] + [_core.Grouping.selections([(ON_WAY, ep.hits(name))]) for name in mirrors]
        grouping = _core.Grouping.all_of(views)
        return decompose_slots(paths, paths.radar, [grouping], progress=progress, **settings)[0]

    def _group(self, row: int, key: tuple, mirrors, cube) -> EchoGroup:
        waveform = self._paths.radar.waveform
        profiles = range_profiles(cube, waveform, **self._settings)[..., :self._num_ranges]
        self._profiles[:, :, :, row] = np.moveaxis(profiles, 3, 2)
        family, *words = key
        on_way = [name for name, word in zip(mirrors, words) if word == ON_WAY]
        touched = {family.object, *family.via} if family.object else set(on_way)
        name = name_of(family) if family.object else f"{BACKGROUND} over {' + '.join(on_way)}" if on_way else BACKGROUND
        return EchoGroup(name, frozenset(touched), *self._peak(cube), family)

    def _peak(self, cube) -> tuple:
        spectrum = ep.range_doppler(cube, self._paths.radar, **self._settings)
        velocity, distance = np.unravel_index(np.abs(spectrum.values[0, 0]).argmax(), spectrum.values.shape[2:])
        return float(spectrum.range[distance]), float(spectrum.velocity[velocity])

    def paths_of(self, group: EchoGroup):
        """Which paths a group holds: bool [P]."""
        families = self._families
        mask = families.family_of_path == families.families.index(group.family)
        if not group.family.object:
            for name in self._mirror_names:
                hits = np.asarray(ep.hits(name).matches(self._paths))
                mask &= hits if name in group.touched else ~hits
        return mask

    @cached_property
    def things(self) -> tuple:
        """Names of what can be taken out: objects and mirrors."""
        return tuple(sorted(set().union(*(group.touched for group in self.groups))))

    def values(self, range_index: int, velocity_index: int, weights):
        """What each group adds to a cell: complex [G], sqrt(W).

        weights: complex [tx, rx] of the channels: one channel, or the steering of a beam
        """
        chirps = chirp_weights(self._paths.radar.waveform, velocity_index, **self._settings)
        values = np.zeros(len(self.groups), complex)
        for tx, rx in np.argwhere(np.asarray(weights) != 0.0):
            values += weights[tx, rx] * (self._profiles[tx, rx, range_index].astype(complex) @ chirps)
        return values

    def of_cell(self, spectrum, range_index: int, velocity_index: int, weights) -> CellAttribution:
        """The contributions to a cell of a map of the frame; weights: as in `values`, [tx, rx]."""
        values = self.values(range_index, velocity_index, weights)
        value = complex(np.sum(np.asarray(weights) * spectrum.values[:, :, velocity_index, range_index]))
        contributions = [Contribution(group.name, complex(part), _change_db(value, part), group)
                         for group, part in zip(self.groups, values)]
        contributions.sort(key=lambda one: -abs(one.value))
        rest = value - complex(values.sum())
        rest_name = REST if self._paths.radar.receiver is None else REST_RECEIVED
        if self._num_weak:
            rest_name = WITH_WEAK.format(rest_name, self._num_weak)
        contributions.append(Contribution(rest_name, rest, _change_db(value, rest)))
        without = [(thing, _change_db(value, sum(part for group, part in zip(self.groups, values) if thing in group.touched)))
                   for thing in self.things]
        return CellAttribution(value, tuple(contributions), tuple(sorted(without, key=lambda one: one[1])))


def name_of(family) -> str:
    """Of an object or its ghost, short: "pedestrian via floor (2/3)", type and order in brackets."""
    if not family.is_ghost:
        return f"{family.object} itself"
    return f"{family.object} via {' + '.join(family.via)} ({family.ghost_type}/{family.order})"


def chirp_weights(waveform, velocity_index: int, *, window="hann", zero_pad: int = 1):
    """[C], complex: the value of a cell of `range_doppler` is the sum of the profiles of its range times these."""
    num_chirps = waveform.num_chirps
    doppler = velocity_index - num_chirps * zero_pad // 2
    weights = samples_of(of_velocity(window), num_chirps)
    return weights / weights.sum() * _tone(doppler, num_chirps, zero_pad)


def _tone(index: int, count: int, zero_pad: int):
    return np.exp(-2j * np.pi * (index * np.arange(count) % (count * zero_pad)) / (count * zero_pad))


def _change_db(value: complex, taken: complex) -> float:
    """dB by which a level changes where `taken` is taken from `value`."""
    left, whole = abs(value - taken), abs(value)
    if whole == 0.0:
        return 0.0
    return float(20.0 * np.log10(max(left / whole, 1e-15)))
