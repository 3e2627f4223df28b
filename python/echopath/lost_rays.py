"""A remark on rays that a trace lost."""
from __future__ import annotations

import warnings

LOST_SHARE = 0.01  # of the rays


def warn_of_lost_rays(statistics, stacklevel: int = 2) -> None:
    """Warns (RuntimeWarning) where more than one ray in a hundred met a surface that the radar touches, or slivers."""
    near, lost, rays = statistics.num_near_antenna, statistics.num_false_hits, max(statistics.num_rays, 1)
    if near + lost > LOST_SHARE * rays:
        warnings.warn(f"of {rays:,} rays, {near:,} met a surface within 1 mm of the radar and {lost:,} one that double "
                      "precision does not confirm (in the plane of an antenna, or a long sliver): their echoes are left "
                      "out. Antennas at least 1 mm off every surface see all", RuntimeWarning, stacklevel=stacklevel + 1)
