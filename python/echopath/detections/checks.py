"""Whether keywords of detections will do, before a long trace."""
from __future__ import annotations

import numpy as np

from .. import _core
from ..families import check_objects
from ..keywords import refuse_unknown
from ..labels.planes import with_receivers

CFAR_KEYWORDS = ("method", "false_alarm_rate", "guard_velocity", "guard_range", "training_velocity", "training_range",
                 "rank")
KEYWORDS = (*CFAR_KEYWORDS, "objects", "max_peaks")


def check_keywords(scene, radar, spectrum_settings: dict, keywords: dict) -> None:
    """Raises what `detect_frame` would for keywords, from an empty map of one receiver: to know before a long trace."""
    refuse_unknown("detections", keywords, KEYWORDS)
    check_objects(scene, keywords.get("objects"))
    one, waveform = with_receivers(radar, slice(0, 1)), radar.waveform
    nothing = np.zeros((len(one.transmitters), 1, waveform.num_chirps, waveform.num_samples))
    _core.check_cfar(_core.range_doppler(nothing, one, **spectrum_settings), one,
                     **{word: value for word, value in keywords.items() if word in CFAR_KEYWORDS})
