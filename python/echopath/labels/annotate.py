"""Labels of every cell of a map, of every object and of every ghost."""
from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any

import numpy as np

from .. import _core
from ..arguments.checks import MapWindow, Progress, an, anything, checked, optional, refused, text
from ..arguments.names import first_names
from ..arguments.objects import Objects
from ..arguments.part_names import REST, require_names
from ..arguments.settings import Evaluate, LabelSettings, Method, Plane, Replay, Retrace, SignalSettings
from ..base.classes.by_partition import ByPartition
from ..paths.resolution import Interval, interval_of
from ..paths.visibility import appearing_in_frame, visibility_in_trace
from ..signals import same_radar
from ..signals.part_pass import takes_a_pass
from ..signals.parts import selection_rule
from ..spectra.range_doppler import require_finite_samples
from .family_pass import FamilyPass, owners_of_views
from .labels import Labels
from .objects import family_cells, label_ghosts, label_objects, occluded_objects
from .powers import CubeSet, add_powers, decomposed, join
from .request import Labelling, Request, labelling_of, make_request
from .standard_errors import share_errors

_PARTS, _FAMILIES = "parts", "families"


@checked({"settings": LabelSettings, "signal": SignalSettings}, **LabelSettings.RULES, **SignalSettings.RULES,
         radar=optional(an(_core.Radar)), parts=anything, angles=anything)
def annotate(paths: _core.Paths, parts: Mapping[Any, Any] | None = None, radar: _core.Radar | None = None, *,
             objects: Objects = LabelSettings.objects, plane: Plane = LabelSettings.plane,
             window: MapWindow = SignalSettings.window, zero_pad: int = SignalSettings.zero_pad,
             angles: Mapping[str, Any] | None = None, noise: bool = LabelSettings.noise,
             noise_margin_db: float = LabelSettings.noise_margin_db,
             dynamic_range_db: float | None = LabelSettings.dynamic_range_db, errors: bool = LabelSettings.errors,
             tolerance: float = SignalSettings.tolerance, method: Method = SignalSettings.method,
             replay: Replay = SignalSettings.replay, evaluate: Evaluate = SignalSettings.evaluate,
             phase_tolerance: float = SignalSettings.phase_tolerance, retrace: Retrace = SignalSettings.retrace,
             keyframes: int = SignalSettings.keyframes, settings: LabelSettings | None = None,
             signal: SignalSettings | None = None, progress: Progress = None) -> Labels:
    """Labels the cells of a map: which part of the paths made each, and what the map shows of each object of the scene.

    Model: powers without noise; |field|^2 of each part, mean over the channels, of the one realisation of the random phases
    that the map of `synthesize` has. A cell of the mask belongs to whatever has the largest power in it; what a ghost shares
    with its object belongs to the object (ObjectLabel.cells). Where parts interfere, their powers do not add up to that of
    the whole.
    paths: of `trace`, all of them
    parts: Parts of `decompose` of the same radar, or selections as `decompose` takes them, {name: selection}: then no cube
        outlives its use. None: all paths are "other"
    radar: that of the signals, None: of the parts or of the trace
    objects: as in `families`, what to report on; None leaves out mirrors and what surrounds the antenna: what it stands
        within, as a tunnel or its own vehicle, and flat bodies whose bounding sphere holds it, as the road and walls beside it,
        in a `Sequence` at its first frame.
        Name those to have them labelled, too
    plane: "range_doppler" or "range_azimuth" (beams of each part); window, zero_pad: as in `range_doppler`
    angles: keywords of `range_azimuth` for that plane, None: {"combine": "peak"}; Bartlett beams only
    noise: False: no cell is in the noise; noise_margin_db: dB, cells count as above the noise where the power of the whole
        is this much above the mean of the noise in a cell (k T0 F fs and the noise bandwidths of the window; of a
        range-azimuth map, measured on noise alone). Noise alone passes 10 dB in one cell of 22 000, of one channel
    dynamic_range_db: dB below the strongest cell of the echoes that the mask goes down to, None: no limit
    errors: True: standard errors too, which needs trace(batches=2 or more; 8 are good) and one more pass over the paths
    tolerance (relative rms), method, replay, evaluate, phase_tolerance (rad), retrace, keyframes: as in `synthesize`; those
        of the parts where these are given
    settings, signal: LabelSettings and SignalSettings that give the keywords which the call leaves out, or None
    progress: callable (stage, fraction), True for bars, or None
    Returns Labels. Memory: the cubes of all parts and families at as many receivers as 1 GiB holds, one at least, all for
    range_azimuth; and 8 bytes per cell for each part and family, with errors for each part and batch three times.
    Raises ValueError for bad input, for errors without batches, KeyboardInterrupt on Ctrl-C.
    """
    radar = _radar_of(paths, parts, radar)
    chosen = LabelSettings(objects=objects, plane=plane, noise=noise, noise_margin_db=noise_margin_db,
                           dynamic_range_db=dynamic_range_db, errors=errors)
    request = make_request(radar, paths.frame.num_batches, chosen, window=window, zero_pad=zero_pad, angles=angles)
    selections, cubes = _selections_and_cubes(parts, radar, paths.frame.start_time, errors)
    require_names({_PARTS: selections})
    replayed = {"tolerance": tolerance, "method": method, "replay": replay, "evaluate": evaluate,
                "phase_tolerance": phase_tolerance, "retrace": retrace, "keyframes": keyframes, "progress": progress}
    work = labelling_of(request, paths, {_PARTS: selections}, replayed)
    owners, powers = owners_and_powers(work, {} if cubes else {_PARTS: selections})
    if cubes:
        powers = add_powers([CubeSet(radar, 1.0, {_PARTS: cubes})], request.plane)
    return label_partitions(work, owners, powers)[_PARTS]


def owners_and_powers(work: Labelling, partitions: dict):
    """What finds the owners of cells, as `label_partitions` takes it, and {partition: ViewPowers} of some partitions.

    partitions: {partition: {name: selection}}
    """
    request, paths, families, settings = work.request, work.paths, work.families, work.settings
    radar, plane = request.radar, request.plane
    if not takes_a_pass(radar, settings):
        views = {_FAMILIES: families, **partitions}
        num_parts = len(families) + sum(len(group) + 1 for group in partitions.values())
        powers = add_powers(decomposed(paths, radar, views, num_parts, plane, settings), plane)
        return owners_of_powers(request, powers.pop(_FAMILIES)), powers
    is_whole = len(partitions) == 1 and not any(partitions.values())
    signals = FamilyPass(work, adds_up=is_whole)
    if is_whole:
        cubes = {partition: {REST: signals.whole()} for partition in partitions}
        return signals.assign_cells, add_powers([CubeSet(radar, 1.0, cubes)], plane)
    num_parts = sum(len(group) + 1 for group in partitions.values())
    cubes = decomposed(paths, radar, partitions, num_parts, plane, settings) if partitions else []
    return signals.assign_cells, add_powers(cubes, plane)


def owners_of_cubes(request: Request, cubes: dict):
    """What finds the owners of cells from {Family: cube} of all families."""
    return owners_of_powers(request, add_powers([CubeSet(request.radar, 1.0, {_FAMILIES: cubes})], request.plane)[_FAMILIES])


def owners_of_powers(request: Request, powers):
    """What finds the owners of cells from ViewPowers of all families."""
    return lambda mask, intervals: owners_of_views(powers, mask, request.noise_floor)


def label_partitions(work: Labelling, owners, powers: dict, beside=()) -> ByPartition:
    """{partition: Labels} from {partition: ViewPowers}; objects and ghosts are the same in all.

    owners: callable (mask bool [V, R], {Family: Interval}) that gives CellOwners of the families
    beside: names of the parts, last in each view, that no path makes
    """
    first = next(iter(powers.values()))
    known = [Interval(power, power, power) for power in (first.received[name] for name in beside)]
    received = {partition: [*map(interval_of, work.mean.of_parts[partition]), *known]
                for partition, of_parts in powers.items()
                if [*work.selections.get(partition, {}), REST, *beside] == list(of_parts.cells)}
    intervals = dict(zip(work.families.families, map(interval_of, work.mean.of_families)))
    mask = work.request.masks(first)[1]
    owned = owners(mask, intervals)
    for name in beside:
        owned.leave(first.cells[name])
    scene_labels = _label_scene(work, owned, intervals, mask)
    labels = ByPartition({partition: _label_parts(work, of_parts, received.get(partition), scene_labels)
                          for partition, of_parts in powers.items()})
    if not work.request.errors:
        return labels
    return ByPartition({partition: _with_errors(found, work, work.selections.get(partition, {}), beside)
                        for partition, found in labels.items()})


def _label_scene(work: Labelling, owners, intervals: dict, mask) -> dict:
    """The fields of Labels that tell of objects and ghosts.

    owners: CellOwners; intervals: {Family: Interval}; mask: bool [V, R]
    """
    request, paths, families, progress = work.request, work.paths, work.families, work.settings.get("progress")
    found = family_cells(owners, mask, request.noise_floor, request.plane, intervals)
    seen = visibility_in_trace(paths, request.radar, request.objects, progress=progress)
    visibility = {of_object.name: of_object for of_object in seen}
    hidden = occluded_objects(families.objects, found, visibility, request.plane)
    appearing = appearing_in_frame(paths, request.radar, hidden, request.objects, progress=progress)
    objects, object_map = label_objects(families.objects, found, visibility, appearing, request.plane, work.seen)
    ghosts, ghost_map = label_ghosts(found, request.plane)
    return {"objects": objects, "object_map": object_map, "ghosts": ghosts, "ghost_map": ghost_map,
            "left_out": owners.left_out}


def _label_parts(work: Labelling, powers, received, scene_labels: dict) -> Labels:
    """Labels of a partition, without errors.

    powers: its ViewPowers; received: Interval in W of each part, None where the parts are not those of selections
    scene_labels: of `_label_scene`
    """
    request = work.request
    names, plane = list(powers.cells), request.plane
    power = np.stack([powers.cells[name] for name in names])
    above_noise, mask = request.masks(powers)
    return Labels(plane=plane.name, velocity=plane.velocity, azimuth=plane.azimuth, range=plane.range,
                  part_names=[str(name) for name in names], power=power, whole=powers.whole,
                  share=_core.power_shares(power), dominant=_core.strongest_part(power, mask),
                  noise_power=plane.noise_power, noise_margin_db=request.noise_margin_db,
                  dynamic_range_db=request.dynamic_range_db, above_noise=above_noise, mask=mask, seed=work.paths.frame.seed,
                  part_received=received, **scene_labels)


def label_frame(work: Labelling, owners, cubes: dict, beside: dict) -> dict:
    """{partition: Labels} from {partition: {part: cube}}, cubes [tx, rx, chirp, sample] in sqrt(W).

    owners: as in `label_partitions`; beside: {name: cube} of what no path makes, which every partition gets as parts
    """
    radar, plane = work.request.radar, work.request.plane
    powers = add_powers([CubeSet(radar, 1.0, cubes)], plane)
    if beside:
        join(powers.values(), beside, sum(next(iter(cubes.values())).values()), radar, plane)
    return label_partitions(work, owners, powers, tuple(beside))


def _with_errors(labels: Labels, work: Labelling, selections: dict, beside) -> Labels:
    """Labels of a partition of selections {name: selection} with their errors."""
    known = {name: labels.power[labels.part_names.index(name)] for name in beside}
    found = share_errors(labels, work, selections, known)
    names = ("mean_power", "power_error", "mean_share", "share_error", "certain")
    return dataclasses.replace(labels, **dict(zip(names, found)))


def _radar_of(paths, parts, radar):
    if radar is None:
        radar = getattr(parts, "radar", None)
    return paths.radar if radar is None else radar


def _selections_and_cubes(parts, radar, start_time: float, errors: bool):
    """({name: selection}, {name: cube} or {}) of what the caller gave as parts."""
    parts = {} if parts is None else parts
    if not isinstance(parts, Mapping):
        raise refused(TypeError, "parts", "Parts of decompose or {name: selection}", parts)
    if any(isinstance(value, Mapping) for value in parts.values()):
        raise ValueError(f"parts: must be one partition, as parts[{next(iter(parts))!r}], got a table of partitions: "
                         f"{first_names(list(map(str, parts)))}")
    if not any(isinstance(value, np.ndarray) for value in parts.values()):
        return {text("parts", name): selection_rule(f"parts.{name}", value) for name, value in parts.items()}, {}
    _check_cubes(parts, radar, start_time)
    selections = getattr(parts, "selections", None) or {}  # None: of families
    if errors and [*selections, REST] != list(parts):
        raise ValueError("errors: need the selections of the parts, got cubes alone; give {name: selection} or Parts of "
                         "them")
    return dict(selections), dict(parts)


def _check_cubes(parts: dict, radar, start_time: float) -> None:
    own = getattr(parts, "radar", None)
    if own is not None and (field := same_radar.difference(own, radar, start_time)):
        raise ValueError(f"parts: must be of the radar, got those of another {field}")
    waveform = radar.waveform
    shape = (len(radar.transmitters), len(radar.receivers), waveform.num_chirps, waveform.num_samples)
    for name, cube in parts.items():
        if np.shape(cube) != shape:
            raise ValueError(f"parts: cubes must have shape [tx, rx, chirp, sample] = {list(shape)}, the radar's, got "
                             f"{list(np.shape(cube))} for '{name}'")
        require_finite_samples(f"parts.{name}", cube)
