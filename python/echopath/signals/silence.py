"""Signals in which nothing is heard."""
from __future__ import annotations

import numpy as np

from ..base.callers import warn_user


def warn_of_silence(paths, radar, cube: np.ndarray) -> None:
    """Warns where paths were found and nothing is heard: of coherent surfaces few rays find no point of reflection.

    paths: _core.Paths; radar: that hears them; cube: sqrt(W), their signal
    """
    if paths.num_paths and not cube.any():
        warn_user(f"no signal of {paths.num_paths:,} paths: they lie beyond the last range of the waveform, "
                  f"{radar.waveform.max_range:.4g} m, or rays too few for the coherent echo of a surface found none of it: "
                  "ep.unresolved(paths) says which objects need more, ep.received_power(paths) how much there may be")
