"""What a run prints: figures of a frame in plain words."""
from __future__ import annotations

import textwrap

import numpy as np

import echopath as ep

from ..measures import in_dbm, power_dbm, velocity_extent

LABEL_WIDTH = 34


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
    """The modelled effects with what asked for them, and the names of the others."""
    lines = [line(effect.name, effect.reason) for effect in all_effects if effect.modelled]
    others = ", ".join(effect.name for effect in all_effects if not effect.modelled)
    return ["effects modelled", *lines, *textwrap.wrap(f"not modelled: {others}", 110, subsequent_indent="  ")]


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
    """Mean received power of the whole and of each part with its standard error, for traces with batches."""
    paths = frame.paths
    if paths.frame.num_batches < 2:
        return []
    lines = [f"mean received power over the random phases, +- standard error of {paths.frame.num_batches} batches",
             line("whole", power_with_error(ep.received_power(paths)))]
    for partition, part_of_path in frame.part_of_path.items():
        lines.append(f"mean received power, {partition}")
        lines += [line(name, power_with_error(ep.received_power(paths.select(part_of_path == index))))
                  for index, name in enumerate(frame.parts[partition])]
    return lines


def power_with_error(power) -> str:
    """An ep.ReceivedPower in dBm +- dB; the bound of two standard errors where it is not resolved."""
    if power.resolved:
        return f"{_power_text(in_dbm(power.power))} +- {power.error_db:.2f} dB"
    bound = max(power.power, 0.0) + 2.0 * power.standard_error
    return f"  not resolved, below {in_dbm(bound):.2f} dBm" if bound > 0.0 else _power_text(-np.inf)


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
