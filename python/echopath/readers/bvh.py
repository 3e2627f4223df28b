"""Motion capture (BVH) as a model: the walking person, moved as captured."""
from __future__ import annotations

from pathlib import Path

from .. import _core
from ..actors.human.captured import captured_body
from .model import Model
from .options import ReadOptions
from .sampled import chosen_animation
from .tree import Tree

NAME = "capture"   # of the one animation
EDGE = 0.018       # m, of the triangles


def read(path: Path, options: ReadOptions) -> Model:
    """A Model of the person of `actors.captured_pedestrian`; the capture is not repeated, and one frame is no animation."""
    body = captured_body(path, unit=options.unit, up=options.up, height=None)
    names = () if body.is_pose else (NAME,)
    animation = chosen_animation(options, names)
    tree = Tree(options)
    for note in body.notes:
        tree.note(note)
    if options.loop:
        tree.note("a motion capture is not repeated: the person would jump back")
    groups: dict[str, int] = {}
    for arrays in body.parts(options.offset, EDGE, "clothing", "skin"):
        group, _, name = arrays.name.rpartition("/")
        if group and group not in groups:
            groups[group] = tree.add(group)
        tree.add(name, groups.get(group, -1), mesh=_core.Mesh(arrays.vertices, arrays.triangles), smooth=True,
                 foreign_material=arrays.material, **_moved(path, arrays, animation))
    return tree.model(format="BVH", unit=body.unit, up=body.up, animations=names, animation=animation,
                      duration=float(body.times[-1] - body.times[0]) if animation else 0.0)


def _moved(path: Path, arrays, animation) -> dict:
    """The motion of a part; at rest its place in the first frame. Raises FileError for joints that give it no axes."""
    try:
        motion = _core.KeyframeMotion(times=arrays.times, translations=arrays.translations, rotations=arrays.rotations)
    except ValueError as error:
        raise _core.FileError(f"{path}: its {arrays.name} cannot move as captured: {error}") from None
    if animation:
        return {"motion": motion}
    return {"placement": motion.at(float(arrays.times[0]))}
