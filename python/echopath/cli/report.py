"""What a run prints: figures of a frame in plain words."""
from __future__ import annotations

import textwrap

import numpy as np

from ..arguments.names import first_names
from ..arguments.part_names import BESIDE
from ..base.numerics.decibels import SMALLEST_POWER, in_dbm
from ..base.radar.velocities import folded
from ..base.text.counts import counted, named
from ..labels.report import peak_words
from ..paths.resolution import FAINT, RESOLVED_DB, SURROUNDINGS
from ..paths.visibility import occluder_words
from ..scene.closing_speeds import bodies_faster_than
from ..signals.measures import power_dbm, with_error
from ..spectra.moving import velocity_extent
from .lists import more_line, strongest

NOTHING_DBM = -300.0  # of filters and tails that numbers alone can hold, 100 dB and more below any receiver
LABEL_WIDTH = 34
MAX_WIDTH = 118  # columns
MAX_LISTED = 40  # nodes, meshes or objects named one by one
MAX_UNRESOLVED = 20  # echoes named one by one
VAGUE_DB, UNKNOWN_DB = 1.0, 20.0  # widths of an interval from which on it is told, and from which on its upper end alone
PEAK_OF_CELLS = "strongest of its cells"
UNRESOLVED_MEAN = "mean over random phases where not resolved (95 %)"
ONE_FREQUENCY = ("  Coherent echoes add up or cancel at one frequency otherwise than over the band: these powers may be far\n"
                 "  from those of the signals, and those of parts need not add up to that of the whole.")
ON_EACH_OTHER = "surfaces on each other"
FOLDED = "velocities that are ambiguous"


def _power_text(power: float) -> str:
    return f"{power:8.2f} dBm" if power > NOTHING_DBM else "  nothing"


def line(label: str, value: str) -> str:
    """One line of a report."""
    return f"  {label + '  ':<{LABEL_WIDTH}}{value}"


def wrapped(label: str, value: str) -> list[str]:
    """`line` in as many lines as its width asks for."""
    indent = " " * (LABEL_WIDTH + 2)
    return textwrap.wrap(line(label, value), MAX_WIDTH, subsequent_indent=indent, break_on_hyphens=False)


def point(place) -> str:
    """Coordinates of a place, (x, y, z)."""
    return "(" + ", ".join(f"{value:.4g}" for value in place) + ")"


def counts(paths) -> list[str]:
    """Rays, hits and paths of a trace."""
    return [line("rays", f"{paths.frame.statistics.num_rays:,}"), line("hits recorded", f"{len(paths.mesh_id):,}"),
            line("paths", f"{paths.num_paths:,}"), *_target(paths.frame)]


def _target(frame) -> list[str]:
    if frame.target_error_db == 0.0:
        return []
    verdict = "met" if frame.error_db <= frame.target_error_db else "NOT met with the most rays allowed"
    return [line("error", f"{frame.error_db:.3g} dB, target {frame.target_error_db:g} dB: {verdict}")]


def overlaps(scene, time: float, names=None) -> list[str]:
    """Which meshes of a scene lie on each other at `time` (s), largest areas first; nothing where none do.

    names: of the meshes by ID, instead of those in the scene
    """
    names = names or [mesh.name for mesh in scene.meshes]
    found = sorted(scene.coplanar_overlaps(time=time), key=lambda overlap: -overlap.area)
    lines = [line("  " + " and ".join(dict.fromkeys(names[mesh_id] for mesh_id in overlap.mesh_ids)),
                  f"{counted(overlap.num_triangles, 'triangle')}, {overlap.area:.4g} m^2") for overlap in found[:MAX_LISTED]]
    if not found:
        return []
    more = more_line(len(found), MAX_LISTED)
    return [f"{ON_EACH_OTHER} (rounding decides which of the two a ray meets; of flagged mirrors it is the front one, or the "
            "last in one plane)", *lines, *more]


def overlaps_or_none(scene, time: float, names=None) -> list[str]:
    """The same, with a line that says so where none do."""
    return overlaps(scene, time, names) or [line(ON_EACH_OTHER, "none")]


def folded_velocities(scene, radar, time: float) -> list[str]:
    """Objects of a scene, or parts of them, that move faster in a frame about `time` (s) than a map of velocity tells, and where
    it shows them; nothing where none do."""
    limit = radar.waveform.max_velocity(radar.num_slots)
    found = bodies_faster_than(limit, scene, radar, time)
    lines = [line("  " + body.name, f"{'' if body.as_whole else 'up to '}{body.speed:+z.2f} m/s, "
                  f"shown at {folded(body.speed, 2.0 * limit):+z.2f} m/s") for body in found[:MAX_LISTED]]
    if not found:
        return []
    more = more_line(len(found), MAX_LISTED)
    return [f"{FOLDED} (the map of velocity repeats itself every {2.0 * limit:.4g} m/s)", *lines, *more]


def effects(all_effects) -> list[str]:
    """The effects that were modelled and those that were not, each with what asked for it or why not."""
    lines = []
    for title, modelled in (("effects modelled", True), ("effects not modelled", False)):
        lines.append(title)
        for effect in all_effects:
            if effect.modelled == modelled:
                lines += wrapped(effect.name, effect.reason)
    return lines


def validity(certificate) -> list[str]:
    """Whether one trace serves the frame, from an ep.Validity."""
    return str(certificate).splitlines()


def checks(of_guard) -> list[str]:
    """What the guard of a run compared; nothing where it was off."""
    return ["checks of this run", *(line(check.name, str(check)) for check in of_guard)] if of_guard else []


def stages(all_stages) -> list[str]:
    """Time and peak memory of each stage."""
    lines = [line(stage.name, f"{stage.seconds:8.2f} s {stage.peak_memory / 2**20:10,.0f} MiB") for stage in all_stages]
    return ["time and peak memory", *lines, line("all", f"{sum(stage.seconds for stage in all_stages):8.2f} s")]


def powers(frame, parts: dict) -> list[str]:
    """Power of the signals of a frame, of the whole and of each part of each partition, without noise."""
    phases = ", one realisation of the random phases" if np.any(frame.paths.diffuse) else ""
    lines = [f"received power of the signals, without noise: mean over the band, all antennas and chirps{phases}",
             line("whole", _power_text(power_dbm(frame.cube)))]
    for partition, cubes in parts.items():
        lines.append(f"received power, {partition}")
        lines += [line(name, _power_text(power_dbm(cube))) for name, cube in cubes.items()]
    return lines


def mean_powers(frame) -> list[str]:
    """Mean received power of the whole and of each part with half its 95 % interval, and how far it may be from `powers`."""
    phases = ", mean over the random phases" if np.any(frame.paths.diffuse) else ""
    lines = [f"received power at the start frequency, between the first antennas{phases}, +- half the 95 % interval",
             line("whole", _aligned(with_error(frame.mean_power)))]
    for partition, part_powers in frame.mean_part_powers.items():
        lines.append(f"received power at the start frequency, {partition}")
        lines += [line(name, _aligned(with_error(power))) for name, power in part_powers.items()]
    if np.count_nonzero(frame.paths.diffuse == 0) > 1:
        lines.append(ONE_FREQUENCY)
    return lines


def _aligned(text: str) -> str:
    """Levels below those of `powers`, words two columns in."""
    level, unit, error = text.partition(" dBm")
    return f"{level:>8}{unit}{error}" if "+-" in error else f"  {text}"


def unresolved(found, paths, left_out=None) -> list[str]:
    """The last lines of a run: which echoes above the noise the rays do not know to 0.3 dB, and what would resolve them.

    found: list of ep.Unresolved of the paths; left_out: of the frame file that was asked, None: a whole record
    """
    if not (found or paths.num_paths or (left_out and left_out.num_paths)):
        return ["no path leads back to the radar, and no object that the rays look for is in its sight"]
    if not found and paths.num_paths and not np.any(paths.power):
        return ["no path has any power: the antennas look away from all that the rays met"]
    if not found:
        whose = ", by the paths that the file keeps" if left_out and left_out.num_paths else ""
        return [f"resolved to {RESOLVED_DB:g} dB: every object and ghost above the noise{whose}"]
    lines = _table([(f"  {one.title}", f"{one.interval}; {one.advice}") for one in found[:MAX_UNRESOLVED]])
    rest = more_line(len(found), MAX_UNRESOLVED, indent=2)
    return [f"NOT resolved to {RESOLVED_DB:g} dB (95 % interval)", *lines, *rest]


def unresolved_in_frames(found) -> list[str]:
    """The last lines of a run of frames in time: what the rays do not know in some of them, with the widest of its intervals.

    found: of each frame that was made, a list of ep.Unresolved
    """
    if not found:
        return []
    made = f"in {counted(len(found), 'frame')}" if len(found) > 1 else "in the frame"
    by_title: dict = {}
    for one in (one for frame in found for one in frame):
        by_title.setdefault(one.title, []).append(one)
    if not by_title:
        return [f"resolved to {RESOLVED_DB:g} dB {made} that {'were' if len(found) > 1 else 'was'} made: "
                "every object and ghost above the noise"]
    rows = sorted(by_title.items(), key=lambda row: (-len(row[1]), -max(one.interval.high for one in row[1])))
    worst = {title: max(echoes, key=lambda one: one.interval.high / max(one.interval.low, 1e-300)) for title, echoes in rows}
    lines = _table([(f"  {title}", f"{len(echoes)} of {len(found)}, at worst {worst[title].interval}; {worst[title].advice}")
                    for title, echoes in rows[:MAX_UNRESOLVED]])
    return [f"NOT resolved to {RESOLVED_DB:g} dB (95 % interval) {made} that {'were' if len(found) > 1 else 'was'} made", *lines,
            *more_line(len(rows), MAX_UNRESOLVED, indent=2)]


def labels(of_partitions: dict) -> list[str]:
    """Tables of the parts, the objects and the ghosts of {partition: Labels}."""
    if not of_partitions:
        return []
    first = next(iter(of_partitions.values()))
    lines = []
    for partition, of_cells in of_partitions.items():
        words = f"{np.count_nonzero(of_cells.mask):,} of {counted(of_cells.mask.size, 'cell')} labelled, {partition}"
        if of_cells.certain is not None:
            words += f" ({np.count_nonzero(of_cells.certain):,} certain)"
        counts = [np.count_nonzero(of_cells.dominant == index) for index in range(len(of_cells.part_names))]
        lines += [words, *(line(name, f"{count:8,} {named(count, 'cell')}") for name, count in zip(of_cells.part_names, counts))]
    return lines + _objects(first) + _ghosts(first)


def detections(found, of_partitions: dict, advice: str = "", *, file: str = "") -> list[str]:
    """How many detections each object, what no path makes and the rest have, and which objects have cells in {partition: Labels}
    but none; nothing where none were asked for. advice: what to ask for in place of the mean over cells (method="ca"), "" where
    it was not taken
    file: the name of the table that has them, "": none"""
    if found is None:
        return []
    made_by_none = (found.object == "") & np.isin(found.part, BESIDE)  # rain, leakage and what else is no echo of the scene
    owners = {"": SURROUNDINGS, **{name: name for name in found.object if name}}
    groups = [(words, (found.object == name) & ~made_by_none) for name, words in sorted(owners.items())]
    groups += [(name, made_by_none & (found.part == name)) for name in sorted(set(found.part[made_by_none]))]
    return [f"{counted(len(found), 'detection')}{file and ', '}{file}",
            *(line(words, f"{np.sum(of_group & ~found.is_noise):8,}") for words, of_group in groups),
            line("noise alone", f"{int(found.is_noise.sum()):8,}"), *_undetected(found, of_partitions, advice)]


def other_method(asked, words: str) -> str:
    """`words`, which ask for order statistics, unless keywords of a detector name a method that minds neighbours as little."""
    return words if (asked or {}).get("method", "ca") in ("ca", "go") else ""


def _undetected(found, of_partitions: dict, advice: str) -> list[str]:
    """Objects that are seen in the labels and have no detection; a mean over the cells about a cell hides what stands beside
    much stronger echoes."""
    labelled = next(iter(of_partitions.values())).objects if of_partitions else []
    names = [label.name for label in labelled if label.status == "seen" and label.name not in found.object]
    told = first_names(names) + (f"; {advice} may find what stands beside stronger echoes" if advice else "")
    return [line("labelled, not detected", told)] if names else []


def truth(found) -> list[str]:
    """Where each object is and how strongly the radar sees it; nothing where that was not asked for."""
    if found is None:
        return []
    rows = [("truth", "range", "azimuth", "radial", "in sight", "cross section")]
    columns = (found.name, found.range, np.degrees(found.azimuth), found.radial_velocity, found.visible_share, found.rcs,
               found.rcs_low, found.rcs_high)
    shown = strongest(found.received, found.visible_share, MAX_LISTED)
    for name, distance, azimuth, velocity, share, *rcs in zip(*(column[shown] for column in columns)):
        rows.append((f"  {name}", f"{distance:.2f} m", f"{azimuth:+z.1f} deg", f"{velocity:+z.2f} m/s", f"{share:.0%}",
                     _cross_section(*rcs)))
    return _table(rows, right=(1, 2, 3, 4, 5)) + more_line(len(found), MAX_LISTED, indent=2)


def _cross_section(rcs: float, low: float, high: float) -> str:
    """A cross section in words, with its 95 % interval (all in m^2) where that is wider than VAGUE_DB."""
    value, lowest, highest = (10.0 * np.log10(max(one, SMALLEST_POWER)) for one in (rcs, low, high))
    if not np.isfinite([rcs, low, high]).all() or high <= 0.0:
        return "none"
    if highest - lowest <= VAGUE_DB:
        return f"{value:.1f} dBsm"
    return f"below {highest:.1f} dBsm" if highest - lowest > UNKNOWN_DB else f"{lowest:.1f} to {highest:.1f} dBsm"


def _objects(of_cells) -> list[str]:
    if not of_cells.objects:
        return ["no objects"]
    rows = [("objects", "status", "cells", "power, anywhere", PEAK_OF_CELLS, "in sight", "hidden by", UNRESOLVED_MEAN)]
    powers, shares = zip(*((label.power, label.visible_share) for label in of_cells.objects))
    for label in (of_cells.objects[index] for index in strongest(powers, shares, MAX_LISTED)):
        rows.append((f"  {label.name}", label.status, f"{label.cells:,}", _power(label), _peak(label),
                     f"{label.visible_share:.0%}", occluder_words(label.occluders), _interval(label)))
    return _table(rows, right=(2, 3, 5)) + more_line(len(of_cells.objects), MAX_LISTED, indent=2)


def _ghosts(of_cells) -> list[str]:
    shown = [ghost for ghost in of_cells.ghosts if ghost.cells]
    if not shown:
        return []
    rows = [("ghosts", "type", "order", "class", "cells", "power, anywhere", PEAK_OF_CELLS, "via", UNRESOLVED_MEAN)]
    for ghost in sorted(shown, key=lambda ghost: -ghost.power)[:MAX_LISTED]:
        rows.append((f"  {ghost.object}", str(ghost.ghost_type), str(ghost.order), str(ghost.class_code), f"{ghost.cells:,}",
                     _power(ghost), _peak(ghost), ", ".join(ghost.via), _interval(ghost)))
    hidden = len(of_cells.ghosts) - len(shown)
    return _table(rows, right=(1, 2, 3, 4, 5)) + more_line(len(shown), MAX_LISTED, indent=2) + (
        [f"  and {hidden:,} without cells"] if hidden else [])


def _level(power: float) -> str:
    return f"{in_dbm(power):.1f} dBm" if in_dbm(power) > NOTHING_DBM else "nothing"


def _power(label) -> str:
    """Of this realisation; the upper end of its interval where the rays have found next to nothing of it."""
    received = label.received
    if received and received.is_in_doubt and label.power < FAINT * received.high:
        return f"below {_level(received.high)}"
    return _level(label.power)


def _peak(label) -> str:
    if label.peak is None:
        return ""
    return f"{peak_words(label.peak, width=6)} {_level(label.peak.power):>11}"


def _interval(label) -> str:
    """Of the mean received power, where the rays do not know it; "" where they do or nobody knows."""
    received = label.received
    if not (received and received.is_in_doubt):
        return ""
    return f"{_level(received.low)} to {_level(received.high)}" if received.low > 0.0 else f"below {_level(received.high)}"


def _table(rows: list, right=()) -> list[str]:
    """Rows of texts in columns two spaces apart, without a last column that says nothing below its head.

    right: indices of columns that end together
    """
    if len(rows) > 1 and not any(row[-1] for row in rows[1:]):
        rows = [row[:-1] for row in rows]
    widths = [max(map(len, column)) for column in zip(*rows)]
    return ["  ".join(f"{text:>{width}}" if index in right else f"{text:<{width}}"
                      for index, (text, width) in enumerate(zip(row, widths))).rstrip() for row in rows]


def extent(label: str, spectrum) -> str:
    """Radial velocities that a part covers."""
    found = velocity_extent(spectrum)
    return line(label, "does not move" if found is None else f"{found[0]:+6.2f} to {found[1]:+6.2f} m/s")


def files(written) -> list[str]:
    """What a run wrote, how large the frame file is and what it leaves out."""
    folder = written.frame_path.parent
    pictures = ", ".join(str(picture.relative_to(folder)) for picture in written.pictures)
    return [f"written to {folder}", omissions(written.left_out, written.frame_path), *([f"  {pictures}"] if pictures else [])]


def omissions(left_out, path) -> str:
    """Size of a frame file, unless it is a part of one, and what it leaves out."""
    size = f"{path.stat().st_size / 2**20:,.0f} MiB, " if path.is_file() else ""
    if left_out.num_paths == 0:
        return line(path.name, f"{size}all paths")
    power = _power_text(in_dbm(left_out.power)).strip()
    return line(path.name, f"{size}without the {_weakest(left_out.num_paths)} ({power} in sum)")


def _weakest(count: int) -> str:
    return f"{count:,} weakest paths" if count > 1 else "weakest path"
