"""Results as small tables of HTML, which notebooks show: what their methods `_repr_html_` do.

Whatever is not a number of ours may hold any text (names of meshes come from files), so each cell is escaped, here and
nowhere else.
"""
from __future__ import annotations

import html

import numpy as np

from ..base.numerics.decibels import SMALLEST_POWER, in_dbm
from ..base.numerics.triangles import areas_of
from ..base.radar.sweep import sweep_text
from ..base.text.counts import counted
from ..receiver.settings import receiver_text
from ..scene.interferers import interferers_of, interferers_text
from ..scene.scales import linear_maps
from ..signals.same_radar import WAVEFORM_LISTS
from ..weather.weather import weather_of, weather_text

MOST_ROWS = 20
_LEFT = "text-align:left"


def scene_html(scene) -> str:
    """The meshes of a scene with their size, as objects are scaled, and material."""
    meshes, maps = list(scene.meshes), linear_maps(scene.nodes)
    rows = [(mesh.name, len(mesh.triangles), _number(_area(mesh.mesh, maps[mesh.node])), _material(mesh),
             "moves" if scene.is_moving(mesh.id) else "at rest") for mesh in meshes[:MOST_ROWS]]
    weather = weather_of(scene)
    air = "" if weather is None else f", weather: {weather_text(weather)}"
    others = f", {interferers_text(interferers_of(scene))}" if interferers_of(scene) else ""
    return _table(f"Scene: {counted(len(scene.nodes), 'node')}, {counted(len(meshes), 'mesh')}, "
                  f"{counted(scene.num_triangles, 'triangle')}{air}{others}",
                  ("mesh", "triangles", "area in m²", "material", "motion"), rows, len(meshes))


def _area(mesh, world_from_mesh) -> float:
    """m^2, of a mesh whose axes are turned and scaled by [3, 3]."""
    return float(areas_of((mesh.vertices @ world_from_mesh.T)[mesh.triangles]).sum())


def _material(mesh) -> str:
    """Of a name whether it is a mirror here, which the material of that name is not."""
    if not mesh.material_name:
        return repr(mesh.material)
    return mesh.material_name + (", mirror" if mesh.material.mirror else "")


def radar_html(radar) -> str:
    """What a radar sends, and what it can tell apart."""
    waveform = radar.waveform
    num_transmitters = len(radar.transmitters)
    steps = ", slots differ" if any(getattr(waveform, name) for name in WAVEFORM_LISTS) else ""
    return _pairs("Radar", {
        "band": sweep_text(waveform),
        "chirps": f"{waveform.num_chirps} of {counted(waveform.num_samples, 'sample')} at "
                  f"{1e-6 * waveform.sampling_rate:.6g} MHz, every {1e6 * waveform.chirp_interval:.6g} µs{steps}",
        "antennas": f"{counted(num_transmitters, 'transmitter')}, {counted(len(radar.receivers), 'receiver')}, "
                    f"{radar.multiplexing}",
        "receiver": receiver_text(radar),
        "range": f"cells of {waveform.range_resolution:.4g} m up to {waveform.max_range:.4g} m",
        "velocity": f"up to ±{waveform.max_velocity(radar.num_slots):.4g} m/s",
        "transmit power": f"{float(in_dbm(radar.transmit_power)):.4g} dBm a transmitter",
        "noise figure": f"{radar.noise_figure_db:.4g} dB",
        "motion": repr(radar.motion) if radar.is_moving else "at rest"})


def paths_html(paths) -> str:
    """How many paths there are, by the number of their bounces."""
    bounces, is_diffuse = np.asarray(paths.num_bounces), np.asarray(paths.diffuse) != 0
    rows = []
    for count in np.unique(bounces):
        here = bounces == count
        rows.append((int(count), f"{np.count_nonzero(here & ~is_diffuse):,}", f"{np.count_nonzero(here & is_diffuse):,}"))
    frame = paths.frame
    title = (f"Paths: {paths.num_paths:,} of {counted(frame.statistics.num_rays, 'ray')}, {counted(paths.num_hits, 'hit')}, "
             f"{frame.polarization}, seed {frame.seed}, at {frame.trace_time:.6g} s")
    return _table(title, ("bounces", "coherent", "diffuse"), rows, len(rows))


def range_doppler_html(spectrum) -> str:
    """Shape, axes and peak of a range-Doppler map."""
    power = np.mean(np.abs(spectrum.values) ** 2, axis=(0, 1))
    row, column = np.unravel_index(int(power.argmax()), power.shape)
    tx, rx, velocities, ranges = spectrum.values.shape
    return _pairs("RangeDoppler", {
        "channels": f"{counted(tx, 'transmitter')} x {counted(rx, 'receiver')}",
        "velocity": f"{counted(velocities, 'cell')}, {spectrum.velocity[0]:.4g} to {spectrum.velocity[-1]:.4g} m/s",
        "range": f"{counted(ranges, 'cell')}, {spectrum.range[0]:.4g} to {spectrum.range[-1]:.4g} m",
        "window": f"{spectrum.window}, zero_pad {spectrum.zero_pad}",
        "strongest cell": f"{_dbm(power[row, column])} at {spectrum.range[column]:.4g} m, {spectrum.velocity[row]:+.4g} m/s",
        "median cell": _dbm(float(np.median(power)))})


def detections_html(detections) -> str:
    """The strongest detections."""
    order = np.argsort(-detections.power, kind="stable")
    rows = [(f"{detections.range[i]:.2f}", f"{detections.velocity[i]:+z.2f}", _degrees(detections.azimuth[i]),
             f"{detections.snr_db[i]:.1f}", detections.object[i], detections.part[i],
             "noise" if detections.is_noise[i] else f"type {detections.ghost_type[i]}" if detections.ghost_type[i] else "")
            for i in order[:MOST_ROWS]]
    header = ("range in m", "velocity in m/s", "azimuth in °", "SNR in dB", "object", "part", "ghost or noise")
    return _table(f"Detections: {len(detections)}, strongest first", header, rows, len(detections))


def labels_html(labels) -> str:
    """The parts of the map, its objects, and how many ghosts have cells."""
    counts = np.bincount(labels.dominant[labels.mask].astype(np.int64), minlength=len(labels.part_names))
    num_rows, num_columns = labels.shape
    parts = _table(f"Labels: {labels.plane.replace('_', '-')} map of {num_rows} x {counted(num_columns, 'cell')}, "
                   f"{np.count_nonzero(labels.mask):,} labelled", ("part", "cells"),
                   list(zip(labels.part_names, counts))[:MOST_ROWS], len(labels.part_names))
    rows = [(label.name, label.status, label.cells, _dbm(label.power), f"{label.visible_share:.0%}")
            for label in labels.objects[:MOST_ROWS]]
    with_cells = sum(ghost.cells > 0 for ghost in labels.ghosts)
    return parts + _table(f"Objects, and {counted(with_cells, 'ghost')} with cells of {len(labels.ghosts)}",
                          ("object", "status", "cells", "power", "visible"), rows, len(labels.objects))


def frame_html(frame) -> str:
    """What a frame holds, and what it cost."""
    shape = "none" if frame.cube is None else " x ".join(map(str, frame.cube.shape))
    parts = "; ".join(f"{partition}: {', '.join(map(str, cubes))}" for partition, cubes in frame.parts.items())
    facts = {"paths": f"{frame.paths.num_paths:,}", "cube (tx x rx x chirp x sample)": shape, "parts": parts or "none",
             "noise": "none" if frame.noise_seed is None else f"seed {frame.noise_seed}",
             "weather": weather_text(weather_of(frame.scene)), "interferers": interferers_text(interferers_of(frame.scene)),
             "labels": ", ".join(map(str, frame.labels)) or "none",
             "detections": "none asked for" if frame.detections is None else len(frame.detections)}
    stages = [(stage.name, f"{stage.seconds:.3f}", f"{stage.peak_memory / 2**20:,.0f}") for stage in frame.stages]
    told = _pairs("Frame", facts)
    return told + (_table("Stages", ("stage", "seconds", "peak memory in MiB"), stages, len(stages)) if stages else "")


def sequence_html(row, kind: str, facts: dict) -> str:
    """How many frames there are, and when; facts: further {name: value}."""
    times, ends = row.times, "none"
    if len(times):
        ends = f"{times[0]:.6g} to {times[-1]:.6g} s, {row._pace()}"
    return _pairs(kind, {"frames": len(times), "starts": ends, "objects": len(row.scene)} | facts)


def template_html(template) -> str:
    """What a template makes, and what its first scene draws."""
    made, drawn = template.settings, template.draw(0).values
    interval = "" if made.interval is None else f", every {made.interval:.6g} s"
    told = _pairs(f"Template {template.path.name}", {
        "scenes": made.scenes, "frames of each": f"{made.frames}{interval}", "kept": made.keep, "seed": made.seed,
        "split": ", ".join(f"{name} {share:.4g}" for name, share in made.split.items())})
    rows = [(place, f"{value:.6g}" if isinstance(value, float) else value) for place, value in drawn.items()]
    return told + _table(f"Drawn for scene 0: {counted(len(rows), 'value')}", ("value", "drawn"), rows[:MOST_ROWS], len(rows))


def validity_html(report) -> str:
    """Whether one trace serves, what does not hold, and the objects."""
    rows = [(name, "yes" if one.ok else "no", f"{one.new_surface:.1%}", f"{one.disappears:.1%}", f"{one.error_db:+z.2f}")
            for name, one in list(report.objects.items())[:MOST_ROWS]]
    verdict = "one trace serves" if report.ok else counted(len(report.warnings), "warning")
    table = _table(f"Validity: {verdict}, {counted(report.num_paths, 'path')}, phase error {report.rms_phase_error:.3g} rad rms",
                   ("object", "served", "new surface", "disappears", "error in dB"), rows, len(report.objects))
    return table + "".join(f"<p>{html.escape(warning)}</p>" for warning in report.warnings)


def effects_html(found) -> str:
    """Effects with their reasons."""
    rows = [(effect.name, "yes" if effect.modelled else "no", effect.reason) for effect in found]
    title = f"Effects: {sum(effect.modelled for effect in found)} of {len(found)} modelled"
    return _table(title, ("effect", "modelled", "reason"), rows, len(rows), most=len(rows))


def _table(title: str, header, rows, count: int, most: int = MOST_ROWS) -> str:
    """A table of cells that are escaped; count: of all rows, of which `rows` are the first."""
    lines = [f"<table><caption style='{_LEFT}'><b>{html.escape(title)}</b></caption>",
             "<tr>" + "".join(_cell("th", name) for name in header) + "</tr>"]
    lines += ["<tr>" + "".join(_cell("td", value) for value in row) + "</tr>" for row in rows]
    if count > most:
        lines.append(f"<tr><td colspan='{len(header)}' style='{_LEFT}'>and {count - most:,} more</td></tr>")
    return "\n".join([*lines, "</table>"])


def _pairs(title: str, facts: dict) -> str:
    return _table(title, ("", ""), list(facts.items()), len(facts))


def _cell(tag: str, value) -> str:
    return f"<{tag} style='{_LEFT}'>{html.escape(str(value))}</{tag}>"


def _number(value: float) -> str:
    return f"{value:.4g}"


def _dbm(power) -> str:
    return f"{float(in_dbm(power, SMALLEST_POWER)):.1f} dBm" if power > 0.0 else "none"


def _degrees(angle) -> str:
    return "" if np.isnan(angle) else f"{np.degrees(angle):+z.1f}"
