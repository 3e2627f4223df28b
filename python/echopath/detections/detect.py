"""From a range-Doppler map to a labelled point cloud."""
from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from .. import _core
from ..arguments.checks import Progress, an, checked, keywords, optional, real, refused, text
from ..arguments.keywords import parameters_of
from ..arguments.objects import Objects, objects_rule
from ..arguments.part_names import BESIDE, RESIDUE, require_names
from ..arguments.settings import LabelSettings
from ..base.radar.antennas import centre_of
from ..labels.labels import Labels
from ..labels.part_cells import floor_over
from ..paths.resolution import FamilyPowers, family_powers
from ..receiver.echo_gains import EchoGains
from ..signals.parts import decompose
from ..signals.same_radar import difference
from ..spectra.angles import estimate_angles
from ..spectra.range_doppler import CFAR_RULES, FALSE_ALARM_RATE, RANK, CfarMethod, cfar
from . import labelling
from .channels import in_turns
from .detections import Detections
from .directions import directions_of
from .echo_fields import EchoFields
from .family_fields import FamilyFields, Signals
from .noise import mean_noise, warn_of_missing_noise
from .uneven_fields import echo_fields


def _parts(argument: str, value):
    """{name: cube or RangeDoppler}, or {name: selection}, of at least one part."""
    an(Mapping, called="a dict of cubes, RangeDoppler or selections")(argument, value)
    if not value:
        raise refused(ValueError, argument, "a dict of at least one part", value)
    return {_name(argument, name): part for name, part in value.items()}


def _name(argument: str, name) -> str:
    """Of a part; parts of Families are named by these."""
    return str(name) if isinstance(name, _core.Family) else text(argument, name)


def _signals_of(parts: dict, paths, radar, progress) -> dict:
    """{name: cube or RangeDoppler} of parts that may be selections of the paths."""
    selected = {name: part for name, part in parts.items() if isinstance(part, (str, _core.Selection))}
    if not selected:
        return parts
    require_names({"parts": selected})
    if paths is None:
        raise ValueError(f"parts: selections need paths to choose from, got {', '.join(parts)} without paths")
    return decompose(paths, radar, parts, progress=progress)


def _require_other_names(parts: dict | None, labels: Labels | None, beside: dict | None) -> None:
    """Raises ValueError for what is named in both: either would stand in the place of the other."""
    argument, names = ("parts", parts or {}) if labels is None else ("labels", labels.part_names)
    twice = [name for name in beside or {} if name in names]
    if twice:
        raise ValueError(f"beside: must have other names than {argument}, got {twice[0]!r} in both")


_OWN = ("spectrum", "radar", "cells", "velocity", "range", "progress")  # of each call, which no settings have
_ANGLES = keywords("estimate_angles", tuple(name for name in parameters_of(estimate_angles) if name not in _OWN))


@checked(**CFAR_RULES, angles=optional(_ANGLES), paths=optional(an(_core.Paths)), parts=optional(_parts),
         labels=optional(an(Labels, called="Labels")), beside=optional(_parts), objects=objects_rule,
         noise_margin_db=optional(LabelSettings.RULES["noise_margin_db"]), start_time=optional(real(unit="s")))
def detect(spectrum: _core.RangeDoppler, radar: _core.Radar, *, method: CfarMethod = "ca",
           false_alarm_rate: float = FALSE_ALARM_RATE, guard_velocity: int | None = None, guard_range: int | None = None,
           training_velocity: int | None = None, training_range: int | None = None, rank: float = RANK, beams: bool = False,
           angles: Mapping[str, object] | None = None, paths: _core.Paths | None = None, parts: Mapping[Any, Any] | None = None,
           labels: Labels | None = None, beside: Mapping[Any, Any] | None = None, objects: Objects = None,
           noise_margin_db: float | None = None, start_time: float | None = None, progress: Progress = None) -> Detections:
    """Echoes that stand out of the noise of a range-Doppler map, with what made them.

    Cells above the threshold of `cfar` that are local maxima, their place between the cells by the known response of the
    window, directions by `estimate_angles`, without the phase that transmit slots (TDM) add at that velocity between the cells.
    A detection has the part of the largest power in its cell without noise, and its object or ghost by the rule of labels
    (ObjectLabel.cells); it is "noise" where echoes hold less than half of its power above the mean of thermal noise: those of
    the parts or labels in all channels, of paths alone by a model of their fields in at most 8 channels, compared with the power
    in those, which follows the sidelobes of an echo down to 60 dB below it, so that those farther down are noise unless there
    are parts or labels. Errors of chains, filters and imbalance of `radar.receiver` count; images and skirts that it makes of
    echoes elsewhere are noise.
    spectrum: RangeDoppler with values [tx, rx, velocity, range] in sqrt(W), with noise, as the receiver gives it
    radar: that of the spectrum
    method, false_alarm_rate, guard_velocity, guard_range, training_velocity, training_range, rank, beams: as in `cfar`, in cells;
        in beams noise, range and velocity are those of the strongest beam in which a cell is above its threshold, and what made
        a detection is told in that beam: of two echoes in one cell it is the one that the beam found, while `Detections.paths`
        are those of the whole cell. Direction and power are those of the strongest beam of the cell, whatever its threshold:
        where clutter hides a stronger echo of the cell in its own beam, they are of that one and the name is not.
        Labels keep powers of all channels alone: with `labels` the part is that of the stronger echo, and without paths no
        objects are known below the noise of a channel
    angles: keywords of `estimate_angles`, such as {"max_peaks": 2} for several directions of a cell
    paths: of `trace` with that radar, whatever receiver and noise figure it had: objects, ghosts and the paths behind each
        detection
    parts: {name: cube or RangeDoppler} without noise, of `decompose` or `Frame.part_spectra[view]`; or, with paths, {name:
        selection} as `decompose` takes them. Those named "interference", "rain", "leakage" or "residue", here and in labels,
        are what no path makes there: a detection of theirs is of no object
    labels: Labels of the map instead of parts; without paths their objects and ghosts too
    beside: {name: cube or RangeDoppler} of what no path makes, such as `Frame.beside_spectra`: a detection in whose cell one of
        these has the largest power has its name as part, and is of no object; named otherwise than the parts, or those of labels
    objects: of `families`, with paths
    noise_margin_db: dB from -300 to 300, with paths: as of `annotate`, above which the rule of labels tells an object from what
        hides it; None: that of labels where they are given, else 10
    start_time: s, first sample of the frame, to which the gains of `radar.receiver` have drifted; None: that of paths, else 0
    progress: callable (stage, fraction), True for bars, or None
    Returns Detections: range in m, from 0 on, velocity in m/s and the rest. Raises ValueError naming the argument,
    KeyboardInterrupt on Ctrl-C. Warns (RuntimeWarning) where the map holds no noise of the radar.
    """
    rules = {"method": method, "false_alarm_rate": false_alarm_rate, "guard_velocity": guard_velocity, "guard_range": guard_range,
             "training_velocity": training_velocity, "training_range": training_range, "rank": rank, "beams": beams}
    return detected(spectrum, radar, rules, angles=angles, paths=paths, parts=parts, labels=labels, beside=beside,
                    objects=objects, noise_margin_db=noise_margin_db, start_time=start_time, progress=progress)


def detected(spectrum, radar, rules: dict, *, angles=None, paths=None, parts=None, labels=None, beside=None, objects=None,
             known: FamilyPowers | None = None, without_noise=None, noise_margin_db=None, start_time=None,
             signals: Signals | None = None, progress=None) -> Detections:
    """As `detect`, of arguments that are right.

    rules: keywords of `cfar`; known: of paths and objects, where there are some already; without_noise: RangeDoppler of the
        signal of the paths, which tells noise from echoes in place of the model of their fields; signals: with paths, of a frame
        whose records are renewed: those of all its families, which tell objects and ghosts in place of the paths
    """
    if parts is not None and labels is not None:
        raise ValueError("labels: cannot be given beside parts")
    _require_other_names(parts, labels, beside)
    if paths is not None and (field := difference(radar, paths.radar, paths.frame.start_time)):
        raise ValueError(f"paths: must be traced with the radar of the spectrum, of any receiver, got another {field}")
    if labels is not None:
        labelling.require_cells_of(spectrum, labels)
    parts = None if parts is None else labelling.maps_of("parts", _signals_of(parts, paths, radar, progress), spectrum, radar)
    beside = labelling.maps_of("beside", beside, spectrum, radar)
    found = cfar(spectrum, radar, **rules, progress=progress)
    start_time = _start_of(paths) if start_time is None else start_time
    of_noise, beams = EchoGains(radar, spectrum.range, start_time).of_filters, rules["beams"]
    warn_of_missing_noise(radar, _core.mean_power(spectrum) if beams else found.power, of_noise)
    peaks = _core.find_peaks(spectrum, radar, found, progress)
    cells, power = peaks["cells"], found.power[tuple(peaks["cells"].T)]
    echoes = None if paths is None else echo_fields(paths, spectrum)
    floor = _noise_floor(spectrum, radar, labels, noise_margin_db) / (len(_core.virtual_array(radar).elements) if beams else 1)
    noise = mean_noise(radar, spectrum.window, cells, of_noise, peaks["beam_weights"])
    gains = EchoGains(radar, peaks["range"], start_time)  # within a cell, filters of several poles change by more than half
    makers = _Makers(paths, signals, without_noise, parts, labels, beside, objects, known, floor, noise, gains,
                     peaks["beam_weights"], peaks["beam_weights"])
    if beams:
        makers = makers._replace(beams=_beams_of_echoes(radar, cells, makers, echoes))
    columns = _labels_of(spectrum, radar, cells, power, makers, echoes, progress)
    directions = directions_of(spectrum, radar, peaks, angles or {}, progress)
    found = _joined(radar, peaks, power, directions, columns, echoes)
    return found if paths is None else dataclasses.replace(found, seed=paths.frame.seed)


class _Makers(NamedTuple):
    """What may have made a detection, as in `detect`."""

    paths: _core.Paths | None
    signals: Signals | None
    without_noise: _core.RangeDoppler | None
    parts: dict | None
    labels: Labels | None
    beside: dict
    objects: object
    known: FamilyPowers | None
    noise_floor: float  # W
    noise: np.ndarray   # [N] W, thermal, in the mean, of the cells
    gains: EchoGains    # at the ranges of the peaks
    beams: np.ndarray | None  # weights [N, tx, rx] that the beams which found the cells give to the transmitters' signals
    beams_of_map: np.ndarray | None  # and to the channels of the map, as which what no path makes has come apart

    def beams_of(self, names):
        """Of parts, {name: weights}; None: no beams. What codes leave of echoes counts as these do."""
        if self.beams is None:
            return None
        apart = {*BESIDE, *self.beside} - {RESIDUE}
        return {name: self.beams_of_map if name in apart else self.beams for name in names}


def _start_of(paths) -> float:
    return 0.0 if paths is None else paths.frame.start_time


def _noise_floor(spectrum, radar, labels, margin_db: float | None) -> float:
    """Power in W from which on labels take a cell of the map for more than noise. Arguments as in `detect`."""
    if margin_db is None:
        margin_db = LabelSettings.noise_margin_db if labels is None else labels.noise_margin_db
    return floor_over(_core.cell_noise_power(radar, spectrum.window), margin_db)


def _beams_of_echoes(radar, cells, makers: _Makers, echoes: EchoFields | None) -> np.ndarray:
    """Weights [N, tx, rx] of the beams for the transmitters' signals, which the code leaves mixed where echoes are too fast for
    the map: of its mixes, in the one in which the echoes have the most power."""
    turned = in_turns(makers.beams, radar)
    maps = {"": makers.without_noise} if makers.parts is None and makers.without_noise is not None else makers.parts
    maps = {name: part for name, part in (maps or {}).items() if name not in BESIDE} or None
    if len(turned) == 1 or (maps is None and echoes is None):
        return makers.beams
    if maps is None:
        powers = [[power for _, _, power in echoes.each(cells, makers.gains, beams)] for beams in turned]
    else:
        powers = [labelling.part_powers(maps, cells, makers.gains, beams)[2] for beams in turned]
    return turned[np.argmax(powers, axis=0), np.arange(len(cells))]


def _labels_of(spectrum, radar, cells, power, makers: _Makers, echoes: EchoFields | None, progress) -> dict:
    """part, share, object, ghost_type, order and class_code [N] of cells [N, 2]; echoes: with paths; progress: as in `detect`."""
    parts, labels, beside, gains, beams = makers.parts, makers.labels, makers.beside, makers.gains, makers.beams
    found = labelling.CellLabels(makers.noise)
    if makers.paths is not None:
        known = makers.known or family_powers(makers.paths, makers.objects, progress)
        families, whole, measured = _families_of(spectrum, radar, cells, power, makers, known.families, echoes, progress)
        found.take_families(families, whole, measured, known.resolved)
    elif labels is not None:
        found.families = labelling.families_of_labels(labels, cells)
        found.resolved = labelling.resolved_labels(labels)
    if labels is not None:
        names, powers, whole = labelling.label_powers(spectrum, labels, beside, cells, gains)
        found.take_part_names(names, powers)
        if makers.paths is None or beams is None:
            found.take_echoes(whole, power)
        elif beside:  # the echoes of paths in the beam are what the power in it compares with
            found.add_echoes(labelling.part_powers(beside, cells, gains, makers.beams_of(beside))[2])
    elif parts is not None:
        maps = parts | beside
        found.take_parts(*labelling.part_powers(maps, cells, gains, makers.beams_of(maps)), power)
    elif beside:
        found.take_beside(*labelling.part_powers(beside, cells, gains, makers.beams_of(beside))[:2], power)
    found.leave((*BESIDE, *beside))
    return found.columns()


def _families_of(spectrum, radar, cells, power, makers: _Makers, families, echoes: EchoFields, progress) -> tuple:
    """Family or None of each of cells [N, 2], and power [N] in W of all echoes and of the map, of the same channels or beams.

    families: Families of the paths; all else as of `_labels_of`
    """
    gains, beams, count = makers.gains, makers.beams, len(cells)
    if makers.signals is None:
        sorted_by, source, fields = families, echoes, echoes.each(cells, gains, beams, progress)
    else:
        sorted_by = source = FamilyFields(families, makers.signals, radar, spectrum, cells, beams, progress)
        fields = source.each()
    found, whole = labelling.families_of_cells(sorted_by, fields, count, source.peak_of, noise_floor=makers.noise_floor,
                                               progress=progress)
    if makers.without_noise is not None:
        return found, labelling.part_powers({"": makers.without_noise}, cells, gains, beams)[2], power
    return found, whole, power if beams is not None else echoes.measured(cells)


def _joined(radar, peaks: dict, power, directions: dict, columns: dict, echoes) -> Detections:
    """Peaks [N] and their directions [D] as detections [D]. power: [N] W, of the cells."""
    index, waveform = directions["index"], radar.waveform
    velocity = peaks["velocity"][index] + directions["fold"]
    # Beams have their power in the cell; what the windows lost between cells is put back to them too.
    in_beam = directions["power"] * (peaks["power"] / power)[index]
    # Noise or what velocity shifts may put what is next to the antennas below the first range, where nothing is.
    distance = np.maximum(peaks["range"][index] - waveform.centre_frequency * velocity / waveform.slope, 0.0)
    return Detections(cells=peaks["cells"][index], velocity=velocity, range=distance,
                      azimuth=directions["azimuth"], elevation=directions["elevation"],
                      power=np.where(np.isnan(in_beam), peaks["power"][index], in_beam), noise=peaks["noise"][index],
                      echoes=echoes, centre=centre_of(radar), **{name: values[index] for name, values in columns.items()})
