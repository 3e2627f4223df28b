"""Scenes of Universal Scene Description (USD), as CARLA, Isaac Sim and Blender write them; needs usd-core."""
from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

from ..axes import Axes
from ..model import Model
from ..options import AXES, ReadOptions
from ..sampled import Clock, chosen_animation
from ..tree import Tree
from .content import Content
from .stage import Timeline, opened, pxr_module

TIMELINE = "timeline"  # the name of the one animation of a stage
MOST_SAID = 5          # sentences of USD itself that become notes


def read(path: Path, options: ReadOptions) -> Model:
    """A Model of a stage: meshes and solids, instances, transforms and points over time, skeletons, names of materials.

    Time 0 of the animation, which is called "timeline", is the first frame of the stage; a loop goes to its last frame. Invisible
    prims and those of the purposes guide and proxy are left out.
    """
    pxr = SimpleNamespace(**{name: pxr_module(name) for name in ("Usd", "UsdGeom", "UsdShade", "UsdSkel")})
    with opened(path) as (stage, said):
        tree, timeline = Tree(options), Timeline(stage)
        axes = Axes(options, unit=_unit(stage), up=_up(stage, pxr, tree))
        content = Content(path, stage, tree, axes, timeline, pxr)
        codes = content.time_codes()
        animation = chosen_animation(options, (TIMELINE,) if len(codes) > 1 else ())
        begin, end = timeline.seconds(_ends(timeline, codes, options.loop))
        content.add_all(Clock(options, float(begin), float(end), timeline.steps) if animation else None)
    for sentence in said[:MOST_SAID]:
        tree.note(f"USD says: {sentence}")
    return tree.model(format="USD", unit=axes.unit, up=axes.up, animations=(TIMELINE,) if len(codes) > 1 else (),
                      animation=animation, duration=float(end - begin) if animation else 0.0)


def _ends(timeline: Timeline, codes: list[float], loop: bool) -> tuple[float, float]:
    """Time codes at which the animation begins and ends. Samples outside the stage's own range, as of a lead-in, are played
    where the scene's time comes to them, but are no part of a loop."""
    if loop and timeline.end > timeline.start:
        return timeline.start, timeline.end
    return min([timeline.start, *codes[:1]]), max([timeline.end, *codes[-1:]])


def _unit(stage) -> float:
    """m per unit, 1 cm where the stage does not say or says what cannot be.

    The library's own function refuses numbers of single precision, which some versions of Blender wrote.
    """
    unit = stage.GetMetadata("metersPerUnit")
    return float(unit) if isinstance(unit, (int, float)) and 1e-12 <= unit <= 1e9 else 0.01


def _up(stage, pxr, tree: Tree) -> str:
    """The vertical axis, y where the stage says what cannot be."""
    up = str(pxr.UsdGeom.GetStageUpAxis(stage)).lower()
    if up not in AXES:
        tree.note(f"its vertical axis '{up[:20]}' is none: y is taken")
    return up if up in AXES else "y"
