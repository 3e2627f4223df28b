"""The objects that the labels of a frame tell of."""
from __future__ import annotations

import echopath as ep


def told_objects(frame):
    """As `ep.families` takes them, in their order; vans of a town that was read as one object are found anew.

    None, the usual ones: there are no labels, they know no object, or nothing says which meshes their names stand for.
    """
    labels = list(frame.labels.values()) if frame.labels else []
    names = list(dict.fromkeys(one.name for one in labels[0].objects)) if labels else []
    if not names:
        return None
    if set(names) <= {node.name for node in frame.paths.scene.nodes}:
        return names
    found = ep.find_objects(frame.scene, frame.radar, time=frame.radar.middle_of_frame(frame.start_time))
    return found if set(found) == set(names) else None
