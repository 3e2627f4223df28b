"""Which echoes of a frame the rays do not resolve, above the noise of its radar."""
from __future__ import annotations

from .._core import noise_power_in_cell
from ..paths.resolution import unresolved


def unresolved_of_frame(frame, objects=None, progress=None) -> list:
    """Echoes of the objects that are labelled that the rays do not know, above the noise of the frame's radar.

    objects: of the labels, None: the children of the scene's root; progress: as of `unresolved`
    """
    if objects is None:
        return frame.unresolved
    return unresolved(frame.paths, objects, least_power=noise_power_in_cell(frame.radar), progress=progress)
