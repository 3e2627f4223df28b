"""Whether keywords of detections will do, before a long trace."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..arguments.checks import COMMON, LARGEST_COUNT, Rule, count, refused
from ..arguments.keywords import refuse_unknown
from ..arguments.objects import objects_rule
from ..labels.planes import with_receivers
from ..paths.families import check_objects
from ..spectra.angles import require_told_folds
from ..spectra.range_doppler import CFAR_RULES, FALSE_ALARM_RATE

# Of the keywords of `detect_frame`.
RULES: dict[str, Rule] = {**CFAR_RULES, "objects": objects_rule, "max_peaks": COMMON["max_peaks"],
                          "folds": count(0, LARGEST_COUNT)}


def checked_keywords(scene, radar, spectrum_settings: dict, keywords: dict) -> dict:
    """Keywords of `detect_frame`; raises what it would, from an empty map of one receiver: to know before a long trace."""
    refuse_unknown("detections", keywords, RULES)
    keywords = {word: RULES[word](word, value) for word, value in keywords.items()}
    check_objects(scene, keywords.get("objects"))
    require_folds(radar, keywords.get("folds", 0))
    one, waveform = with_receivers(radar, slice(0, 1)), radar.waveform
    nothing = np.zeros((len(one.transmitters), 1, waveform.num_chirps, waveform.num_samples))
    _core.check_cfar(_core.range_doppler(nothing, one, **spectrum_settings), one,
                     **{word: value for word, value in keywords.items() if word in CFAR_RULES})
    if keywords.get("beams"):
        _core.check_beams(radar, keywords.get("false_alarm_rate", FALSE_ALARM_RATE))
    return keywords


def require_folds(radar, folds: int) -> None:
    """Raises ValueError where the turns of the transmitters do not tell so many velocities apart, as `estimate_angles` does."""
    turns = len(radar.transmitters) if radar.multiplexing == "tdm" else 1
    if 2 * folds >= max(2, turns):
        raise refused(ValueError, "folds", f"0, or less than half of the {turns} slots in which transmitters take turns", folds)
    require_told_folds(radar, folds)
