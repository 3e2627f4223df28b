"""The objects that the labels of a frame tell of."""
from __future__ import annotations

import echopath as ep

from ..palette import objects_of


def told_objects(frame):
    """As `ep.families` takes them, where they are no children of the root: vans of a town that was read as one object.

    None: they are, or there are no labels, or nothing says which meshes their names stand for.
    """
    labels = list(frame.labels.values()) if frame.labels else []
    names = list(dict.fromkeys(one.name for one in labels[0].objects)) if labels else []
    scene = frame.paths.scene
    if set(names) <= set(objects_of(scene)[0]):
        return None
    if set(names) <= {node.name for node in scene.nodes}:
        return names
    found = ep.find_objects(frame.scene, frame.radar, time=frame.radar.middle_of_frame(frame.start_time))
    return found if set(found) == set(names) else None
