"""What a run prints: figures of a frame in plain words."""
from __future__ import annotations

import textwrap

import numpy as np

from ..measures import in_dbm, note_on_errors, power_dbm, velocity_extent, with_error

LABEL_WIDTH = 34
MAX_WIDTH = 118  # columns


def _power_text(power: float) -> str:
    return f"{power:8.2f} dBm" if np.isfinite(power) else "  nothing"


def line(label: str, value: str) -> str:
    """One line of a report."""
    return f"  {label:<{LABEL_WIDTH}}{value}"


def counts(paths) -> list[str]:
    """Rays, hits and paths of a trace."""
    return [line("rays", f"{paths.frame.statistics.num_rays:,}"), line("hits recorded", f"{len(paths.mesh_id):,}"),
            line("paths", f"{paths.num_paths:,}"), *_target(paths.frame)]


def _target(frame) -> list[str]:
    if frame.target_error_db == 0.0:
        return []
    verdict = "met" if frame.error_db <= frame.target_error_db else "NOT met with the most rays allowed"
    return [line("error", f"{frame.error_db:.3g} dB, target {frame.target_error_db:g} dB: {verdict}")]


def effects(all_effects) -> list[str]:
    """The effects that were modelled and those that were not, each with what asked for it or why not."""
    lines = []
    for title, modelled in (("effects modelled", True), ("effects not modelled", False)):
        lines.append(title)
        for effect in all_effects:
            if effect.modelled == modelled:
                text = line(effect.name, effect.reason)
                indent = " " * (LABEL_WIDTH + 2)
                lines += textwrap.wrap(text, MAX_WIDTH, subsequent_indent=indent, break_on_hyphens=False)
    return lines


def validity(certificate) -> list[str]:
    """Whether one trace serves the frame, from an ep.Validity."""
    return str(certificate).splitlines()


def stages(all_stages) -> list[str]:
    """Time and peak memory of each stage."""
    lines = [line(stage.name, f"{stage.seconds:8.2f} s {stage.peak_memory / 2**20:10,.0f} MiB") for stage in all_stages]
    return ["time and peak memory", *lines, line("all", f"{sum(stage.seconds for stage in all_stages):8.2f} s")]


def powers(whole, parts: dict) -> list[str]:
    """Mean received power of the whole and of each part of each partition, without noise."""
    lines = ["received power, without noise", line("whole", _power_text(power_dbm(whole)))]
    for partition, cubes in parts.items():
        lines.append(f"received power, {partition}")
        lines += [line(name, _power_text(power_dbm(cube))) for name, cube in cubes.items()]
    return lines


def mean_powers(frame) -> list[str]:
    """Mean received power of the whole and of each part with its standard error; without batches, what gives it."""
    note = note_on_errors(frame.paths)
    if note:
        return [line("standard errors", note)]
    num_batches = frame.paths.frame.num_batches
    lines = [f"mean received power over the random phases, +- standard error of {num_batches} batches",
             line("whole", _aligned(with_error(frame.mean_power)))]
    for partition, part_powers in frame.mean_part_powers.items():
        lines.append(f"mean received power, {partition}")
        lines += [line(name, _aligned(with_error(power))) for name, power in part_powers.items()]
    return lines


def _aligned(text: str) -> str:
    """Levels below those of `powers`, words two columns in."""
    level, unit, error = text.partition(" dBm")
    return f"{level:>8}{unit}{error}" if "+-" in error else f"  {text}"


def extent(label: str, spectrum) -> str:
    """Radial velocities that a part covers."""
    found = velocity_extent(spectrum)
    return line(label, "does not move" if found is None else f"{found[0]:+6.2f} to {found[1]:+6.2f} m/s")


def files(written) -> list[str]:
    """What a run wrote, how large the frame file is and what it leaves out."""
    pictures = ", ".join(picture.name for picture in written.pictures)
    return [f"written to {written.frame_path.parent}", omissions(written.left_out, written.frame_path), f"  {pictures}"]


def omissions(left_out, path) -> str:
    """Size of a frame file and what it leaves out."""
    size = f"{path.stat().st_size / 2**20:,.0f} MiB"
    if left_out.num_paths == 0:
        return line(path.name, f"{size}, all paths")
    power = _power_text(in_dbm(left_out.power)).strip()
    return line(path.name, f"{size}, without the {left_out.num_paths:,} weakest paths ({power} in sum)")
