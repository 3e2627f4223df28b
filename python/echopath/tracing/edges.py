"""Whether a trace looks for the echoes of sharp edges where `edges="auto"` leaves that to the scene."""
from __future__ import annotations

from .. import _core


def looks_for_edges(edges, scene, radar, start_time: float) -> bool:
    """edges: of `trace`; scene, radar; start_time: s, of the frame. "auto" is True where the strongest edge matters."""
    if edges != "auto":
        return edges
    return edges_matter(*strongest_edge(scene, radar, radar.middle_of_frame(start_time)))


def strongest_edge(scene, radar, time: float) -> tuple[float, float]:
    """(W that the strongest sharp edge would carry at a time in s, were nothing in its way, W of noise in a cell of the map)."""
    return _core.strongest_edge(scene, radar, time), _core.noise_power_in_cell(radar)


def edges_matter(power: float, noise: float) -> bool:
    """The rule of "auto": an edge stands out of the noise of a cell. Both in W."""
    return power > noise
