"""Labels of a frame that was simulated or read back from a file."""
from __future__ import annotations

from ..families import families as find_families
from ..keywords import known_keywords
from ..parts import ONLY_PARTITION, as_partitions, check_partitions
from .annotate import MAP_KEYWORDS, label_partitions, make_request
from .powers import CubeSet, add_powers, decomposed

SIGNAL_SETTINGS = ("replay", "evaluate", "retrace", "keyframes")  # of a frame, as `decompose` takes them
_FAMILIES = object()  # a view that has the name of no partition


@known_keywords(also=MAP_KEYWORDS)
def annotate_frame(frame, parts=None, *, progress=None, **keywords) -> dict:
    """Labels of the cells of a frame's map, from its record and the cubes of its partitions alone.

    frame: Frame of `simulate` or `load_frame`, whose window, zero_pad and settings of signals are those of the labels
    parts: {name: selection} or {partition: {name: selection}} beside the partitions of the frame, None: those alone; without
        any, all paths are "other" of a partition "parts"
    progress: callable (stage, fraction) or None
    keywords: plane, objects, noise, noise_margin_db (dB), dynamic_range_db (dB) and errors, as in `annotate`
    Returns {partition: Labels}. Objects and ghosts are those of the recorded paths: of a file that leaves out weak ones,
    without these. Raises ValueError for bad input, KeyboardInterrupt on Ctrl-C.
    """
    paths, plane = frame.paths, keywords.get("plane")
    angles = {"angles": frame.angle_settings or None} if plane == "range_azimuth" else {}
    request = make_request(frame.radar, paths.frame.num_batches, **frame.spectrum_settings, **angles, **keywords)
    chosen = _as_new_partitions(parts, frame)
    settings = {name: getattr(frame, name) for name in SIGNAL_SETTINGS} | {"progress": progress}
    families = find_families(paths, request.objects)
    views = {_FAMILIES: families, **chosen}
    num_parts = len(families) + sum(len(group) + 1 for group in chosen.values())
    powers = add_powers(decomposed(paths, frame.radar, views, num_parts, request.plane, settings), request.plane)
    powers |= add_powers([CubeSet(frame.radar, 1.0, frame.parts)], request.plane)
    family_powers, selections = powers.pop(_FAMILIES), frame.selections | chosen
    powers = {partition: powers[partition] for partition in selections}
    return label_partitions(request, paths, families, family_powers, powers, selections, settings)


def _as_new_partitions(parts, frame) -> dict:
    chosen = as_partitions(parts) or ({} if frame.parts else {ONLY_PARTITION: {}})
    taken = [partition for partition in chosen if partition in frame.parts]
    if taken:
        raise ValueError(f"parts: the frame has a partition '{taken[0]}' already")
    check_partitions(chosen, frame.scene)
    return chosen
