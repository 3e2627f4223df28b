"""What is in a file or a folder: scene, template, frame, mesh; frames in time, dataset."""
from __future__ import annotations

import os
from pathlib import Path

import numpy as np

import echopath as ep

from .. import dataset
from ..arguments.names import first_names
from ..base.numerics.decibels import in_dbm
from ..base.radar.sweep import sweep_text
from ..base.text.counts import counted
from ..dataset.folder import TEMPLATE as DATASET_FILE
from ..frame_file import left_out, load_frame
from ..frame_file.container import FRAME, SEQUENCE, has_maps, has_paths, kind_of
from ..frame_file.maps import load_maps
from ..frame_file.opening import SUFFIXES as FRAME_SUFFIXES, file_and_group
from ..paths.edge_hits import edge_hits
from ..paths.resolution import RESOLVED_DB
from ..presentation.tables import event
from ..readers.load import READ_RULES, READERS, is_foreign, read_model
from ..readers.options import ReadOptions
from ..receiver.converter import step_text
from ..receiver.settings import receiver_text
from ..scene.interferers import interferers_of, interferers_within
from ..scene.lifetimes import scene_in_frame
from ..scene_file import load_scene
from ..scene_file.frame_starts import first_start
from ..scene_file.load import parse
from ..sequence.folder import NAME as SEQUENCE_FILE
from ..sequence.starts import Starts, pace_words
from ..signals.measures import with_error
from ..weather.weather import weather_of, weather_text
from . import report
from .labels import LABELS_NAME
from .lists import more_line
from .model_info import describe_model
from .run import FRAME_NAME


def describe_file(path, selections=(), *, unit=None, up=None) -> list[str]:
    """Lines that say what is in a scene file or a template (TOML), a frame file (HDF5), a mesh file or a foreign scene
    (load_model), and in a folder of a frame, of its labels, of frames in time or of a dataset.

    selections: of paths, also to be told of; of frame files
    unit, up: of foreign files, as of load_model; None: as the file says
    Raises ValueError for another kind of file and for bad selections, ep.FileError when it cannot be read.
    """
    path = Path(path)
    path = next((path / name for name in (FRAME_NAME, LABELS_NAME) if os.path.exists(path / name)), path)
    suffix = file_and_group(path)[0].suffix.lower()
    selections = [ep.Selection(selection) for selection in selections]
    if selections and suffix not in FRAME_SUFFIXES:
        raise ValueError(f"{path}: must be a frame file (.h5) for --select, which asks for its paths")
    for option, value in (("--unit", unit), ("--up", up)):
        if value is not None and not is_foreign(path):
            raise ValueError(f"{path}: must be a file that load_model reads for {option}")
    if suffix == ".toml" and "dataset" in parse(path):
        return _describe_template(dataset.Template(path))
    if suffix == ".toml":
        return _describe_scene_file(load_scene(path))
    if (path / DATASET_FILE).exists():
        return _describe_dataset(path, dataset.open(path))
    is_sequence_file = suffix in FRAME_SUFFIXES and path.is_file() and kind_of(path) == SEQUENCE
    if is_sequence_file and selections:
        raise ValueError(f"{path}: must be the file of one frame for --select, such as {path}/frames/000000 of these frames")
    if is_sequence_file or (path / SEQUENCE_FILE).exists():
        return _describe_sequence(ep.load_sequence(path))
    if suffix in FRAME_SUFFIXES and not selections and kind_of(path) == FRAME and not has_paths(path):
        return _describe_maps(path, load_maps(path)) if has_maps(path) else _describe_labels(path, ep.load_labels(path))
    if suffix in FRAME_SUFFIXES:
        return _describe_frame(path, selections)
    if suffix in ep._core.MESH_SUFFIXES:
        meshes = ep.load_meshes(str(path), 1.0 if unit is None else unit)
        return [*_describe_meshes(meshes), *_describe_foreign(path, unit, up, with_overlaps=False)]
    if is_foreign(path):
        return _describe_foreign(path, unit, up)
    if not path.exists():
        raise ep.FileError(f"{path}: no such file or folder")
    raise ValueError(f"{path}: must be a .toml or .h5 file, or one of {', '.join(READERS)}; trajectories are read by "
                     "ep.read_trajectories, configurations of sensors by ep.load_sensor, antenna patterns by ep.load_antenna")


def _describe_foreign(path, unit, up, *, with_overlaps: bool = True) -> list[str]:
    """As `ep.load_model` reads it, which would also warn of a size that is among these lines."""
    return describe_model(path, read_model(path, ReadOptions(READ_RULES["unit"]("unit", unit), up)), with_overlaps=with_overlaps)


def _describe_sequence(stored) -> list[str]:
    lines = [str(stored.path), "frames in time", report.line("frames", f"{len(stored)}, {int(stored.is_done.sum())} done"),
             report.line("starts", f"{stored.times[0]:.6g} to {stored.times[-1]:.6g} s, {stored._pace()}"),
             report.line("kept", stored.keep + (", truth" if stored.settings.get("truth") is not None else ""))]
    return [*lines, *_describe_scene(stored.scene, stored.radar, float(stored.times[0])),
            *_describe_radar(stored.radar, float(stored.times[0]))]


def _describe_dataset(path, opened) -> list[str]:
    made = opened.template.settings
    shares = ", ".join(f"{name} {len(opened.split(name))}" for name in made.split)
    return [str(path), "dataset", report.line("scenes", f"{made.scenes}, {len(opened.scenes)} done"),
            report.line("frames", f"{len(opened)}, {made.frames} of each scene"), report.line("kept", made.keep),
            report.line("frames of splits", shares)]


def _describe_template(template) -> list[str]:
    made, first = template.settings, template.scene_file(0)
    interval = "" if made.interval is None else f", every {made.interval:.6g} s"
    drawn = template.draw(0).values
    lines = [str(template.path), "template of scenes", report.line("scenes", str(made.scenes)),
             report.line("frames of each", f"{made.frames}{interval}"), report.line("kept", made.keep),
             report.line("split", ", ".join(f"{name} {share:g}" for name, share in made.split.items())),
             f"drawn for scene 0: {counted(len(drawn), 'value')}"]
    lines += [report.line(f"  {place}", f"{value:.6g}" if isinstance(value, float) else str(value))
              for place, value in list(drawn.items())[:report.MAX_LISTED]]
    lines += more_line(len(drawn), report.MAX_LISTED)
    return [*lines, "scene 0", *_describe_scene_file(first)]


def _rays_of(trace) -> str:
    if trace.num_rays is not None:
        return f"{trace.num_rays:,}"
    if trace.target_error_db is not None:
        return "as many as the target asks for"
    return f"as many as {RESOLVED_DB:g} dB for each object asks for"


def _describe_scene_file(scene_file) -> list[str]:
    trace = scene_file.trace
    scene, radar, start_time = scene_file.scene, scene_file.radar, first_start(trace, scene_file.sequence)
    lines = [scene_file.title or str(scene_file.path), *_describe_scene(scene, radar, start_time),
             *_describe_radar(radar, start_time), *_describe_interferers(scene, radar, start_time),
             *report.folded_velocities(scene_in_frame(scene, radar, start_time), radar, radar.middle_of_frame(start_time)),
             "trace", report.line("rays", _rays_of(trace)), report.line("bounces at most", str(trace.max_bounces))]
    if trace.batches is not None:
        lines.append(report.line("batches", str(trace.batches)))
    if trace.target_error_db is not None:
        until = f"{trace.target_error_db:g} dB, {trace.max_rays:,} rays at most"
        lines.append(report.line("until an error of", until))
    for partition, group in scene_file.partitions().items():
        lines.append(f"parts, {partition}")
        lines += [report.line(name, expression) for name, expression in group.items()]
    return [*lines, *_describe_results(scene_file)]


def _describe_results(scene_file) -> list[str]:
    """What a run of the scene file makes beside maps: frames in time, labels, detections, truth."""
    lines, sequence = [], scene_file.sequence
    if sequence is not None:
        times = _starts_of(scene_file)
        lines = ["frames in time", report.line("frames", f"{len(times)}, {pace_words(times, sequence.interval)}"),
                 report.line("starts", f"{times[0]:.6g} to {times[-1]:.6g} s"), report.line("kept", sequence.keep)]
    wanted = [name for name in ("labels", "detections", "truth") if getattr(scene_file, name) is not None]
    return [*lines, "results", report.line("beside maps", ", ".join(wanted))] if wanted else lines


def _starts_of(scene_file):
    """Starts of the frames in time of a scene file, [K] in s."""
    table = scene_file.sequence
    if table.times is not None:
        return np.array(table.times, float)
    return Starts(scene_file.trace.start_time, table.interval, None).of_all(range(table.frames))


def _describe_scene(scene, radar, start_time: float) -> list[str]:
    """What is in a scene, and which surfaces lie on each other in a frame that starts at a time in s."""
    there = scene_in_frame(scene, radar, start_time)
    bodies = _bodies(scene)
    lines = ["scene", report.line("meshes", str(len(scene.meshes))), report.line("triangles", f"{scene.num_triangles:,}")]
    lines += [report.line(f"  {name}", _body(scene, meshes)) for name, meshes in list(bodies.items())[:report.MAX_LISTED]]
    lines += more_line(len(bodies), report.MAX_LISTED)
    return [*lines, *_comings(scene, there, start_time), report.line("weather", weather_text(weather_of(scene))),
            *report.overlaps_or_none(there, radar.middle_of_frame(start_time))]


def _comings(scene, there, start_time: float) -> list[str]:
    """Which objects have lifetimes, and which of them are absent from the frame; nothing where none has one."""
    names = {index: f"'{node.name}'" for index, node in enumerate(scene.nodes) if node.lifetime is not None}
    if not names:
        return []
    absent = [name for index, name in names.items() if not there._takes_part(index)]
    of_frame = f"{first_names(absent)} absent" if absent else "all there"
    return report.wrapped("come and go", f"{first_names(list(names.values()))}; in the frame at {start_time:g} s: {of_frame}")


def _bodies(scene) -> dict[str, list]:
    """{name of a node: meshes at and below it}: objects of the scene, with their parts as far as the lines go."""
    names = [mesh.name.split("/") for mesh in scene.meshes]
    bodies: dict[str, list] = {}
    for depth in range(1, max(map(len, names), default=0) + 1):
        found: dict[str, list] = {}
        for mesh, name in zip(scene.meshes, names):
            found.setdefault("/".join(name[:depth]), []).append(mesh)
        if bodies and len(found) > report.MAX_LISTED:
            break
        bodies = found
    return bodies


def _body(scene, meshes) -> str:
    """Parts, triangles, material where all have one, and whether some move."""
    materials = {_material(mesh) for mesh in meshes}
    mirrors = sum(mesh.material.mirror for mesh in meshes)
    unlike = f", {mirrors} of them {'mirrors' if mirrors > 1 else 'a mirror'}" if mirrors else ""
    return ((f"{len(meshes)} meshes, " if len(meshes) > 1 else "")
            + counted(sum(len(mesh.mesh.triangles) for mesh in meshes), "triangle")
            + (materials.pop() if len(materials) == 1 else unlike)
            + (", moving" if any(scene.is_moving(mesh.id) for mesh in meshes) else ""))


def _material(mesh) -> str:
    name = f", {mesh.material_name}" if mesh.material_name else ""
    return name + (", mirror" if mesh.material.mirror else "")


def _describe_radar(radar, start_time: float) -> list[str]:
    """Antennas, place in the middle of a frame that starts at a time in s, and what the waveform tells."""
    waveform = radar.waveform
    return ["radar",
            report.line("antennas", f"{len(radar.transmitters)} transmitting, {len(radar.receivers)} receiving"),
            report.line("multiplexing", radar.multiplexing), report.line("receiver", receiver_text(radar)),
            *_describe_converter(radar), *_describe_array(ep.virtual_array(radar)),
            report.line("place", _place(radar, radar.middle_of_frame(start_time))),
            report.line("frequency", sweep_text(waveform)),
            report.line("samples, chirps", f"{waveform.num_samples} at {waveform.sampling_rate / 1e6:g} MHz, "
                        f"{waveform.num_chirps} every {waveform.chirp_interval * 1e6:g} us"),
            report.line("range", f"to {waveform.max_range:.2f} m, resolution {waveform.range_resolution:.3f} m"),
            report.line("velocity", f"+-{waveform.max_velocity(radar.num_slots):.2f} m/s, resolution "
                        f"{waveform.velocity_resolution(radar.num_slots):.3f} m/s")]


def _describe_interferers(scene, radar, start_time: float) -> list[str]:
    """Other radars of a scene: their places in the middle of a frame, their chirps, how long these cross those of the radar."""
    found = []
    sending = dict(interferers_within(scene, start_time, start_time + radar.frame_duration))
    for index, one in enumerate(interferers_of(scene)):
        if index not in sending:
            first, last = one.lifetime
            found.append(report.line(f"interferers[{index}]", f"absent: it sends from {first:g} to {last:g} s"))
            continue
        place, waveform = _place(one.radar, radar.middle_of_frame(start_time)), one.radar.waveform
        difference = abs(waveform.slope - radar.waveform.slope)
        longest = min(waveform.chirp_duration, radar.waveform.chirp_duration)
        crossing = min(longest, radar.waveform.sampling_rate / difference) if difference > 0.0 else longest
        pause = "" if one.interval is None else f", a frame each {one.interval * 1e3:g} ms"
        found += report.wrapped(f"interferers[{index}]", f"{place}; {sweep_text(waveform)} in "
                                f"{waveform.chirp_duration * 1e6:.4g} us, every {waveform.chirp_interval * 1e6:g} us{pause}: "
                                f"crossings of at most {crossing * 1e6:.3g} us")
    return found


def _describe_converter(radar) -> list[str]:
    has_converter = radar.receiver is not None and radar.receiver.adc is not None
    return report.wrapped("converter", step_text(radar)) if has_converter else []


def _place(radar, time: float) -> str:
    """Where the radar is and looks, and how fast it is, at a time in s if it moves."""
    pose = radar.world_from_radar(time)
    yaw, pitch = np.degrees((np.arctan2(pose[1, 0], pose[0, 0]), np.arcsin(np.clip(pose[2, 0], -1.0, 1.0))))
    x, y, z = np.round(pose[:3, 3], 6) + 0.0
    place = f"({x:.6g}, {y:.6g}, {z:.6g}) m, yaw {_degrees(yaw)} deg, pitch {_degrees(pitch)} deg"
    if not radar.is_moving:
        return place
    half = 0.25 * radar.frame_duration  # within the frame, where its motion is known
    before, after = (radar.world_from_radar(time + step)[:3, 3] for step in (-half, half))
    return f"{place}, {np.linalg.norm(after - before) / (2.0 * half):.3g} m/s, at {time:.4g} s"


def _degrees(angle: float) -> str:
    return f"{np.round(angle, 4) + 0.0:g}"


def _describe_array(array) -> list[str]:
    """The elements of a virtual array and the grid they are on; nothing for a single channel."""
    num_elements = len(array.elements)
    if num_elements == 1:
        return []
    if array.grid_shape is None:
        return [report.line("virtual array", f"{num_elements} elements, no grid")]
    (rows, columns), (up, across) = array.grid_shape, np.array(array.grid_spacing) / array.wavelength
    steps = [f"{step:.3g} wavelengths {way}" for step, way in ((across, "across"), (up, "up")) if step > 0.0]
    grid = f"{num_elements} elements, {columns} across x {rows} up, in steps of {' and '.join(steps)}"
    return [report.line("virtual array", grid),
            report.line("overlaps, gaps", f"{array.num_overlaps}, {len(array.gaps)}")]


def _describe_frame(path: Path, selections) -> list[str]:
    missing = left_out(path)
    frame = load_frame(path)
    chosen = [line for selection in selections for line in _describe_selection(frame, selection)]
    lines = [str(path), *_describe_scene(frame.scene, frame.radar, frame.paths.frame.start_time),
             *_describe_radar(frame.radar, frame.paths.frame.start_time),
             *_describe_interferers(frame.scene, frame.radar, frame.paths.frame.start_time),
             *report.folded_velocities(frame.scene, frame.radar, frame.paths.frame.trace_time), "record",
             *report.counts(frame.paths), report.omissions(missing, path), *report.effects(frame.effects)]
    if frame.cube is not None:
        shape = report.line("shape [tx, rx, chirp, sample]", str(list(frame.cube.shape)))
        lines += ["cube", shape, *report.powers(frame, frame.parts), *report.mean_powers(frame),
                  *report.labels(frame.labels or {}), *report.detections(frame.detections, frame.labels or {}),
                  *report.truth(frame.kept_truth), *report.checks(frame.checks),
                  *report.unresolved(frame.unresolved, frame.paths, missing)]
    return lines + chosen


def _describe_maps(path: Path, maps) -> list[str]:
    """A frame of a run that keeps maps or labels alone."""
    lines = [str(path), "maps and labels of a frame, without its paths",
             report.line("start", f"{maps.start_time:.6g} s"),
             report.line("cells", f"{len(maps.velocity)} of velocity, {len(maps.range)} of range"
                         + (", with their powers" if maps.power is not None else ", whose powers are not kept"))]
    if maps.power is not None:
        velocity, distance = np.unravel_index(maps.power.argmax(), maps.power.shape)
        lines.append(report.line("strongest cell", f"{in_dbm(float(maps.power.max())):.2f} dBm at {maps.range[distance]:.2f} m, "
                                 f"{maps.velocity[velocity]:+z.2f} m/s"))
    return [*lines, *report.labels(maps.labels), *report.detections(maps.detections, maps.labels),
            *report.truth(maps.kept_truth)]


def _describe_labels(path: Path, labels) -> list[str]:
    """What `ep.save_labels` wrote."""
    return [str(path), "labels of a frame, without its map and paths", *report.labels(labels)]


def _describe_selection(frame, selection) -> list[str]:
    """Number, power and strongest of the paths that a selection takes."""
    mask = selection.matches(frame.paths)
    taken, power = int(mask.sum()), frame.path_power
    lines = [f"selected by {selection}", report.line("paths", f"{taken:,} of {len(mask):,}")]
    if taken == 0:
        return lines
    share = power.sum(where=mask) / power.sum() if power.any() else 0.0
    strongest = int(np.where(mask, power, -1.0).argmax())
    return [*lines, report.line("share of the sum of powers", f"{100.0 * share:.3g} %"),
            report.line("mean received power", _mean_power(frame.paths.select(mask))),
            report.line("strongest path", f"{in_dbm(power[strongest]):.2f} dBm, {_route(frame.paths, strongest)}")]


def _mean_power(paths) -> str:
    return with_error(ep.received_power(paths))


def _route(paths, path: int) -> str:
    """The hits of a path as an expression that takes it, and its length."""
    first, count = paths.offsets[path], int(paths.num_bounces[path])
    names = [mesh.name for mesh in paths.scene.meshes]
    diffuse, edges = int(paths.diffuse[path]), int(edge_hits(paths)[path])
    hits = [f"{event(diffuse, edges, k)}'{names[paths.mesh_id[first + k]]}'" for k in range(count)]
    one = np.zeros(paths.num_paths, bool)
    one[path] = True
    length = paths.select(one).lengths([paths.frame.trace_time])[0, 0]
    return f"{' '.join(['T', *hits, 'R'])}, {length:.3f} m"


def _describe_meshes(meshes) -> list[str]:
    lines = [f"{counted(len(meshes), 'mesh')}, in the axes of the file"]
    for name, mesh in meshes:
        low, high = np.min(mesh.vertices, axis=0), np.max(mesh.vertices, axis=0)
        lines += [name, report.line("triangles, vertices", f"{len(mesh.triangles):,}, {len(mesh.vertices):,}"),
                  report.line("area", f"{mesh.area:.6g} m^2, {'closed' if mesh.is_closed else 'open'}"),
                  report.line("from, to", f"{report.point(low)}, {report.point(high)} m"),
                  report.line("triangles removed", f"{mesh.num_removed_triangles}"),
                  report.line("vertices duplicated", f"{mesh.num_duplicated_vertices}")]
    return lines + report.overlaps_or_none(_scene_of(meshes), 0.0, [name for name, _ in meshes])


def _scene_of(meshes):
    """The meshes in one scene, under numbers: names in files may be what those of a scene must not be."""
    scene = ep.Scene()
    for number, (_, mesh) in enumerate(meshes):
        scene.add(mesh, name=str(number), material="metal")
    return scene
