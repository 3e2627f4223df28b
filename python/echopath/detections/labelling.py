"""Which part and which object made a detected cell."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..arguments.checks import array
from ..base.process.progress import with_progress
from ..labels.cell_owners import CellOwners
from ..spectra.range_doppler import require_finite_samples
from .detections import NOISE

HALF = 0.5  # of a cell's power above the mean noise: what echoes without noise hold less of was made by noise


def part_powers(maps: dict, cells, gains, beams=None) -> tuple:
    """Names [K], powers [K, N] of maps of parts in cells [N, 2] and power [N] of their sum as fields, W, mean over channels, or
    in beams.

    gains: EchoGains of the receiver, through which the parts have not gone, at the ranges of the cells; beams: weights
        [N, tx, rx], or {name: weights} of each part; None: none
    """
    velocity, distance = cells[:, 0], cells[:, 1]
    powers, whole = [], np.zeros((1, len(cells)))
    for name, part in maps.items():
        tx, rx = (np.arange(count) for count in part.values.shape[:2])
        values = part.values[:, :, velocity, distance] * gains.of(name, tx[:, None, None], rx[:, None], np.arange(len(cells)))
        fields = _fields_of(values, beams[name] if isinstance(beams, dict) else beams)
        powers.append(np.mean(np.abs(fields) ** 2, axis=0))
        whole = whole + fields
    return list(maps), np.array(powers), np.mean(np.abs(whole) ** 2, axis=0)


def _fields_of(values, beams):
    """Values [tx, rx, N] as [C, N], of all channels C, or the one field [1, N] in beams."""
    if beams is None:
        return values.reshape(values.shape[0] * values.shape[1], values.shape[2])
    return np.einsum("ntr,trn->n", beams, values)[None]


def maps_of(argument: str, parts: dict | None, spectrum, radar) -> dict:
    """{name: RangeDoppler} of {name: cube or RangeDoppler}, as that of the spectrum. Raises TypeError or ValueError naming the
    argument."""
    return {name: _map_of(argument, name, part, spectrum, radar) for name, part in (parts or {}).items()}


def _map_of(argument: str, name: str, part, spectrum, radar):
    if isinstance(part, dict):
        raise ValueError(f"{argument}: must be those of one view, as {argument}[{name!r}], got a table of views")
    if not isinstance(part, _core.RangeDoppler):
        cube = array("[T, R, C, S]", kind="complex")(argument, part)
        require_finite_samples(f"{argument}.{name}", cube)
        return _core.range_doppler(cube, radar, window=spectrum.window, zero_pad=spectrum.zero_pad)
    if part.values.shape != spectrum.values.shape:
        raise ValueError(f"{argument}: maps must be as that of the spectrum, {spectrum.values.shape}, got {part.values.shape} "
                         f"of {name!r}")
    return part


def require_cells_of(spectrum, labels) -> None:
    """Raises ValueError for Labels of another map than the spectrum's."""
    if labels.plane != "range_doppler" or labels.whole.shape != spectrum.values.shape[2:]:
        raise ValueError(f"labels: must be of the spectrum's cells {spectrum.values.shape[2:]}, got {labels!r}")


def label_powers(spectrum, labels, beside: dict, cells, gains) -> tuple:
    """As part_powers, from Labels of the range-Doppler map and maps of what is beside them: with the gain in the mean over the
    channels. Labels keep no fields, so that the power of all is the sum of theirs and of what is beside them."""
    velocity, distance = cells[:, 0], cells[:, 1]
    tx, rx, place = (np.arange(count) for count in (*spectrum.values.shape[:2], len(cells)))
    powers = [labels.power[k, velocity, distance] * _mean_gain(gains.of(name, tx[:, None, None], rx[:, None], place))
              for k, name in enumerate(labels.part_names)]
    whole = labels.whole[velocity, distance] * _mean_gain(gains.of("", tx[:, None, None], rx[:, None], place))
    if not beside:
        return list(labels.part_names), np.array(powers), whole
    names, more, all_beside = part_powers(beside, cells, gains)
    return [*labels.part_names, *names], np.array([*powers, *more]), whole + all_beside


def _mean_gain(gains) -> np.ndarray:
    """Of powers, [N], of gains of amplitudes [tx, rx, N]."""
    return np.mean(np.abs(gains) ** 2, axis=(0, 1))


def families_of_cells(families, fields, count: int, peak_of, *, noise_floor: float, progress=None) -> tuple:
    """The family that has each of N cells by the rule of labels, None without echoes, and power [N] of all as fields, W.

    families: Families of the echoes, or FamilyFields; fields: `each` of EchoFields or of FamilyFields, whose power is NaN, which
    yields so many; peak_of: of these; noise_floor: W, from which on labels take a cell for more than noise
    progress: as in `detect`
    """
    owners = CellOwners((count,), families.families, noise_floor)
    own, joint = np.zeros((len(families), count)), np.zeros((len(owners.rivals), count))
    rival_of_family = owners.rival_of_family
    whole = np.zeros(count)
    for i, (index, field, power) in enumerate(with_progress(fields, count, progress, "families of cells")):
        sums = _sums(field, families.family_of_path[index], len(families))
        own[:, i] = np.mean(np.abs(sums) ** 2, axis=0)
        joint[:, i] = np.mean(np.abs(_sums(sums, rival_of_family, len(owners.rivals))) ** 2, axis=0)
        whole[i] = power
    for rival, power in enumerate(joint):
        owners.add(rival, power, 0.0)
    for rival in owners.faded():
        (number,) = owners.rivals[rival]
        owners.peak[number] = peak_of(families.family_of_path == number)
    for rival in owners.give(joint.any(axis=0)):
        members = owners.rivals[rival]
        owners.divide(rival, own[members], np.zeros(len(members)))
    return [families.families[number] if number >= 0 else None for number in owners.family], whole


def _sums(field, group, num_groups: int):
    """Sums [C, G] of fields [C, N] over those of each group [N]."""
    place = (group + num_groups * np.arange(len(field))[:, None]).ravel()
    real, imaginary = (np.bincount(place, part.ravel(), num_groups * len(field)) for part in (field.real, field.imag))
    return (real + 1j * imaginary).reshape(len(field), num_groups)


def families_of_labels(labels, cells) -> list:
    """Family of each of cells [N, 2] by the maps of Labels, None: neither object nor ghost."""
    def family(cell):
        of_object, of_ghost = labels.object_map[tuple(cell)], labels.ghost_map[tuple(cell)]
        if of_ghost >= 0:
            ghost = labels.ghosts[of_ghost]
            return _core.Family(ghost.object, ghost.ghost_type, ghost.order, ghost.via)
        return _core.Family(labels.objects[of_object].name, 0, 1, ()) if of_object >= 0 else None

    return [family(cell) for cell in cells]


def resolved_labels(labels) -> set:
    """The families of the objects and ghosts of Labels whose power the rays know."""
    ghosts = {_core.Family(ghost.object, ghost.ghost_type, ghost.order, ghost.via): ghost.received for ghost in labels.ghosts}
    objects = {_core.Family(label.name, 0, 1, ()): label.received for label in labels.objects}
    return {family for family, interval in (objects | ghosts).items() if interval is not None and interval.resolved}


class CellLabels:
    """What made each of N detected cells, as far as paths, parts and labels tell.

    families: list [N] of Family or None; resolved: set of the families whose power the rays know
    """

    def __init__(self, noise):
        """noise: [N] W, mean power of thermal noise in the cells"""
        count = len(noise)
        self._noise, self.families, self.resolved = noise, [None] * count, set()
        self._part, self._share = np.full(count, "", dtype=str), np.full(count, np.nan)
        self._echoes, self._measured = None, None

    def take_families(self, families, echoes, measured, resolved) -> None:
        """families: [N]; echoes, measured: as of `take_echoes`; resolved: set of those whose power the rays know"""
        self.families, self.resolved = families, resolved
        self.take_echoes(echoes, measured)

    def take_parts(self, names, powers, whole, measured) -> None:
        """names: [K] of parts; powers: [K, N] W; whole: [N] W, of their sum as fields; measured: [N] W, of the map."""
        self.take_part_names(names, powers)
        self.take_echoes(whole, measured)

    def take_part_names(self, names, powers) -> None:
        """names: [K] of parts; powers: [K, N] W"""
        self._part, self._share = _strongest_part(names, powers)

    def take_echoes(self, whole, measured) -> None:
        """whole, measured: [N] W, power of all echoes as one field and that of the map, of the same channels or beams"""
        self._echoes, self._measured = whole, measured

    def add_echoes(self, more) -> None:
        """more: [N] W, power of what the map has beside the echoes that were taken"""
        self._echoes = self._echoes + more

    def take_beside(self, names, powers, measured) -> None:
        """names: [K] of what no path makes; powers: [K, N] W: beside the echoes of paths, which have no part's name, or else
        beside what the map has more of; measured: [N] W, of the map."""
        echoes = np.maximum(measured - powers.sum(axis=0), 0.0) if self._echoes is None else self._echoes
        self._part, self._share = _strongest_part(["", *names], np.concatenate([echoes[None], powers]))
        self._share = np.where(self._part == "", np.nan, self._share)
        if self._echoes is not None:
            self.add_echoes(powers.sum(axis=0))

    def leave(self, names) -> None:
        """Cells of parts of these names are of no family."""
        self.families = [None if part in names else family for part, family in zip(self._part, self.families)]

    def columns(self) -> dict:
        """{name of a field of Detections: [N]}; cells are of noise where echoes hold less than half of what stands above the mean
        of thermal noise."""
        is_noise = np.zeros(len(self.families), bool)
        if self._echoes is not None:
            is_noise = (self._echoes == 0.0) | (self._echoes < HALF * (self._measured - self._noise))
        is_resolved = np.array([family in self.resolved for family in self.families], bool) & ~is_noise
        return {"part": np.where(is_noise, NOISE, self._part), "share": np.where(is_noise, np.nan, self._share),
                "is_noise": is_noise, "is_resolved": is_resolved} | _as_columns(self.families, is_noise)


def _strongest_part(names, powers):
    """(part text [N], share [N]) of the largest of powers [K, N] in W; "" and NaN where all are zero."""
    total = powers.sum(axis=0)
    best = powers.argmax(axis=0)
    share = np.divide(powers.max(axis=0), total, out=np.full(len(total), np.nan), where=total > 0.0)
    return np.where(total > 0.0, np.array(names, dtype=str)[best], ""), share


def _as_columns(families, is_noise) -> dict:
    """object, ghost_type, order, class_code [N] of families, empty and 0 for None and noise [N]."""
    known = [None if noise else family for family, noise in zip(families, is_noise)]
    columns = {"object": np.array([family.object if family else "" for family in known], dtype=str)}
    return columns | {name: np.array([getattr(family, name) if family else 0 for family in known], np.int32)
                      for name in ("ghost_type", "order", "class_code")}
