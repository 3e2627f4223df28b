"""Scenes of the renderer Mitsuba in XML, as radio ray tracers (Sionna RT) ship their streets."""
from __future__ import annotations

from pathlib import Path

import numpy as np

from ..axes import Axes
from ..model import Model
from ..options import ReadOptions
from ..sampled import chosen_animation
from ..tree import MAX_NODES, Tree
from .elements import Element, read_elements
from .materials import bsdf_of, foreign_name, kind_of, radio_material
from .shapes import CURVED, KNOWN, Shapes
from .transforms import to_world


def read(path: Path, options: ReadOptions) -> Model:
    """A Model of a scene: shapes ply, obj, serialized, rectangle, cube, sphere, disk and cylinder, shape groups and their
    instances.

    Mitsuba has no vertical axis of its own: it is z, or y where a camera of the file has it upwards. Cameras, lights,
    textures and media are left out without a word, other shapes with one.
    """
    chosen_animation(options, ())
    scene = read_elements(path)
    up, note = _up_of(scene)
    axes = Axes(options, up=up)
    content = _Content(scene, Tree(options), axes)
    if note and options.up is None:
        content.tree.note(note)
    content.add_shapes(scene.children, -1)
    return content.tree.model(format=f"Mitsuba {scene.get('version')}".strip(), unit=axes.unit, up=axes.up)


def _up_of(scene: Element) -> tuple[str, str | None]:
    """The vertical axis, and what to say of it: that of the first camera that looks at something."""
    for sensor in (child for child in scene.children if child.tag == "sensor"):
        transform = sensor.named("to_world", "transform")
        for step in transform.children if transform is not None else ():
            if step.tag in ("lookat", "look_at") and "up" in step.attributes:
                axis = "xyz"[int(np.abs(step.numbers("up", 3)).argmax())]
                return axis, None if axis == "z" else f"its camera has {axis} upwards, which is taken for the vertical axis"
    return "z", None


class _Content:
    """Puts the shapes of a scene into a tree."""

    def __init__(self, scene: Element, tree: Tree, axes: Axes):
        self.tree = tree
        self._axes = axes
        self._shapes = Shapes(axes)
        self._known: dict[str, Element] = {}
        self._remember(scene)

    def _remember(self, element: Element) -> None:
        for child in element.children:
            if child.tag == "alias" and child.get("id") in self._known:
                self._known.setdefault(child.get("as"), self._known[child.get("id")])
            elif child.get("id") and child.tag != "ref":
                self._known.setdefault(child.get("id"), child)
            self._remember(child)

    def add_shapes(self, elements: list[Element], parent: int) -> None:
        for shape in elements:
            if shape.tag != "shape" or shape.get("type") == "shapegroup":
                continue
            if len(self.tree.nodes) > MAX_NODES:
                shape.refuse(f"the scene has more than {MAX_NODES} shapes")
            if shape.get("type") == "instance":
                self._add_instance(shape, parent)
            elif shape.get("type") == "merge":
                self.add_shapes(shape.children, parent)
            elif shape.get("type") in KNOWN:
                self._add_shape(shape, parent)
            else:
                self.tree.count(f"a shape of the type '{shape.get('type')[:60]}' is left out")

    def _add_shape(self, shape: Element, parent: int) -> None:
        placement = self._placement(shape)
        surfaces = self._shapes.surfaces(shape)
        if placement is None or not surfaces:
            if not surfaces:
                self.tree.count("a shape without any area is left out")
            return
        bsdf = bsdf_of(shape, self._known)
        name = shape.get("id").removeprefix("mesh-") or _stem(shape)
        if len(surfaces) > 1:
            parent, placement = self.tree.add(name, parent, placement=placement), None
        for part in surfaces:
            self.tree.add(name if len(surfaces) == 1 else part.full_name, parent, placement=placement, mesh=part.mesh,
                          smooth=part.smooth, foreign_material=foreign_name(bsdf) or part.material,
                          material=radio_material(bsdf), kind=kind_of(bsdf))

    def _add_instance(self, shape: Element, parent: int) -> None:
        reference = next((child for child in shape.children if child.tag == "ref"), None)
        group = self._known.get(reference.get("id")) if reference is not None else None
        if group is None or group.get("type") != "shapegroup":
            shape.refuse("must refer to a shape group of the file")
        placement = self._placement(shape)
        if placement is not None:
            name = shape.get("id").removeprefix("mesh-") or group.get("id")
            self.add_shapes([one for one in group.children if one.get("type") != "instance"],
                            self.tree.add(name, parent, placement=placement))

    def _placement(self, shape: Element) -> np.ndarray | None:
        """[4, 4] in m; None, counted, where it flattens space."""
        placement = self._axes.matrices(to_world(shape))
        if np.linalg.det(placement[:3, :3]) == 0.0:
            self.tree.count("a shape whose transform flattens it is left out")
            return None
        return placement


def _stem(shape: Element) -> str:
    return Path(shape.value("filename", "string") or shape.get("type")).stem
