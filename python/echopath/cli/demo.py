"""The street demo: a pedestrian walks between two walls; what every ray touched, by route and by body part."""
from __future__ import annotations

from importlib.resources import as_file
from pathlib import Path

import echopath as ep

from ..arguments.part_names import REST
from ..base.process.stages import StageClock
from ..base.storage.data_folder import data_folder
from ..frame.frame import Frame
from ..scene_file import load_scene
from ..signals.measures import residual
from ..spectra.moving import EXTENT_BELOW_PEAK_DB
from . import report
from .run import certify, simulate_file, write_outputs

NUM_RAYS = 100_000
ARMS, LEGS = "pedestrian/arm_*", "pedestrian/leg_*"


def run_demo(out="out/demo", *, num_rays=NUM_RAYS, seed=None, batches=None, progress=None, say=print) -> Frame:
    """Simulates data/scenes/street.toml, writes frame.h5, eight pictures and label maps to `out`, and reports what the rays
    touched.

    num_rays: launched; seed, batches: None, those of the file; progress: callable (stage, fraction) or None
    say: takes each line of the report.
    """
    out = Path(out)
    with as_file(data_folder("scenes") / "street.toml") as path:
        street = load_scene(path)
    frame = simulate_file(street, num_rays=num_rays, seed=seed, batches=batches,
                          extra_parts=limb_partitions(street.parts["route"]), labels=True, progress=progress)
    certificate = certify(frame, progress=progress)
    written = write_outputs(frame, out, partitions=street.parts)
    residuals = _check_sums(frame, progress)
    for text in _report(street, frame, certificate, written, residuals):
        say(text)
    return frame


def limb_partitions(route: dict) -> dict:
    """Two more views of the street: its limbs, and the legs by route."""
    legs = ep.hits(LEGS)
    legs_by_route = {name: legs & ep.Selection(expression) for name, expression in route.items()}
    return {"limbs": {"arms": ep.hits(ARMS), "legs": legs}, "legs by route": legs_by_route | {"no listed route": legs}}


def _check_sums(frame: Frame, progress) -> dict:
    """How far the parts of each partition are from a whole that was synthesised on its own."""
    clock = StageClock()
    with clock("check of the sum"):
        whole = ep.synthesize(frame.paths, frame.radar, progress=progress)
        residuals = {partition: residual(whole, cubes) for partition, cubes in frame.parts.items()}
    frame.stages += clock.stages
    return residuals


def _report(street, frame: Frame, certificate, written, residuals: dict) -> list[str]:
    shown = {partition: cubes for partition, cubes in frame.parts.items() if partition != "limbs"}
    shown["legs by route"] = {name: cube for name, cube in shown["legs by route"].items() if name != REST}
    limbs = frame.part_spectra["limbs"]
    return [street.title, *report.counts(frame.paths), *report.effects(frame.effects),
            *report.stages(frame.stages), *report.powers(frame, shown), *report.mean_powers(frame),
            f"radial velocities (receding positive), down to {EXTENT_BELOW_PEAK_DB:.0f} dB below the peak",
            report.extent("arms", limbs["arms"]), report.extent("legs", limbs["legs"]),
            "|whole - sum of parts| / |whole|, the whole synthesised on its own",
            *(report.line(partition, f"{value:.1e}") for partition, value in residuals.items()),
            *report.labels({partition: frame.labels[partition] for partition in street.parts}),
            *report.checks(frame.checks), *report.validity(certificate), *report.files(written),
            *report.unresolved(frame.unresolved, frame.paths)]
