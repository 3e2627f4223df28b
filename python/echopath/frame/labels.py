"""Labels of a frame that was simulated or read back from a file."""
from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..arguments.checks import Progress, an, anything, checked
from ..arguments.objects import Objects
from ..arguments.part_names import require_names
from ..arguments.settings import FRAME_KEYWORDS, LabelSettings, Plane
from ..labels.annotate import label_partitions, owners_and_powers
from ..labels.labels import Labels
from ..labels.powers import CubeSet, add_powers, join
from ..labels.request import labelling_of, make_request
from ..signals.beside import cubes_beside
from ..signals.parts import ONLY_PARTITION, as_partitions, check_partitions
from .frame import Frame


@checked({"settings": LabelSettings}, **LabelSettings.RULES, frame=an(Frame), parts=anything)
def annotate_frame(frame: Frame, parts: Mapping[str, Any] | None = None, *, plane: Plane = LabelSettings.plane,
                   objects: Objects = LabelSettings.objects, noise: bool = LabelSettings.noise,
                   noise_margin_db: float = LabelSettings.noise_margin_db,
                   dynamic_range_db: float | None = LabelSettings.dynamic_range_db, errors: bool = LabelSettings.errors,
                   settings: LabelSettings | None = None, progress: Progress = None) -> dict[str, Labels]:
    """Labels of the cells of a frame's map, from its record and the cubes of its partitions alone.

    frame: Frame of `simulate` or `load_frame`, whose window, zero_pad and settings of signals are those of the labels
    parts: {name: selection} (partition "parts") or {partition: {name: selection}} beside the partitions of the frame, in place
        of one of the same name; None: those alone; without any, all paths are "other" of a partition "parts"
    plane, objects, noise, noise_margin_db (dB), dynamic_range_db (dB), errors: as in `annotate`
    settings: LabelSettings that give the keywords which the call leaves out, or None
    progress: callable (stage, fraction), True for bars, or None
    Returns {partition: Labels}. Objects and ghosts are those of the recorded paths: of a file that leaves out weak ones,
    without these. Raises ValueError for bad input, KeyboardInterrupt on Ctrl-C.
    """
    paths, angles = frame.paths, frame.angle_settings if plane == "range_azimuth" else None
    asked = LabelSettings(plane=plane, objects=objects, noise=noise, noise_margin_db=noise_margin_db,
                          dynamic_range_db=dynamic_range_db, errors=errors)
    request = make_request(frame.radar, paths.frame.num_batches, asked, **frame.spectrum_settings, angles=angles or None)
    chosen = _as_new_partitions(parts, frame)
    replayed = {name: getattr(frame, name) for name in FRAME_KEYWORDS} | {"progress": progress}
    selections = frame.selections | chosen
    work = labelling_of(request, paths, selections, replayed)
    owners, powers = owners_and_powers(work, chosen)
    kept = {partition: cubes for partition, cubes in frame.parts.items() if partition not in chosen}
    powers |= add_powers([CubeSet(frame.radar, 1.0, kept)], request.plane)
    powers = {partition: powers[partition] for partition in selections}
    beside = cubes_beside(frame)
    if beside:
        join(powers.values(), beside, frame.cube, frame.radar, request.plane)
    return label_partitions(work, owners, powers, tuple(beside))


def _as_new_partitions(parts, frame) -> dict:
    chosen = as_partitions(parts) or ({} if frame.parts else {ONLY_PARTITION: {}})
    check_partitions(chosen, frame.scene)
    require_names(chosen)
    return chosen
