"""Actors: named parts, each a mesh with a material and a motion of its own."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from .. import _core
from ..arguments.checks import an, refused, text
from ..base.text.counts import counted


@dataclass(frozen=True)
class Part:
    """One labelled part of an actor.

    name: path below the actor; '/' makes group nodes, so "arm_left/hand" is the node "hand" in the group "arm_left".
    mesh: echopath.Mesh. material: a name in echopath.materials, or an echopath.Material.
    motion: motion relative to the actor's root (group nodes do not move), or None.
    position: [3] place of the mesh in the actor's frame in m, which the motion adds to.
    smooth: whether the mesh stands for a curved surface (Scene.add).
    Raises TypeError or ValueError naming name or mesh; Scene.add checks the others.
    """

    name: str
    mesh: _core.Mesh
    material: _core.Material | str
    motion: _core.Motion | _core.Deformation | None = None
    position: Sequence[float] = (0.0, 0.0, 0.0)
    smooth: bool = False

    def __post_init__(self):
        text("name", self.name)
        an(_core.Mesh)("mesh", self.mesh)


@dataclass(frozen=True)
class Actor:
    """Parts that are placed in a scene as one object.

    The actor's frame has x forward, y left, z up and the floor at z = 0.
    parts: list of Part, whose names differ.
    motion: of the whole, such as the Trajectory that it follows; None: Scene.add says.
    """

    parts: list[Part] = field(default_factory=list)
    motion: _core.Motion | None = None

    def __post_init__(self):
        if not isinstance(self.parts, Sequence) or not all(isinstance(part, Part) for part in self.parts):
            raise refused(TypeError, "parts", "a list of Part", self.parts)
        object.__setattr__(self, "parts", list(self.parts))  # its own, which the caller's list does not change
        names = [part.name for part in self.parts]
        for name in names:
            if not name or any(not step for step in name.split("/")):
                raise refused(ValueError, "parts", "of names without empty steps", name)
            if names.count(name) > 1:
                raise refused(ValueError, "parts", "of different names", name)

    @property
    def num_triangles(self) -> int:
        """Of all parts."""
        return sum(len(part.mesh.triangles) for part in self.parts)

    def __repr__(self):
        return f"Actor({counted(len(self.parts), 'part')}, {counted(self.num_triangles, 'triangle')})"


@dataclass(frozen=True)
class PartArrays:
    """A part as plain arrays.

    vertices [V, 3] in m, triangles [F, 3]; keyframes times [T] in s, translations [T, 3] in m and rotations [T, 4]
    (unit quaternions w, x, y, z) of the part relative to the actor's root. times None: the part rests. rates: those of both per
    s, ([T, 3], [T, 4]), for a CurveMotion through them, which holds its ends; None: a KeyframeMotion. smooth: as of Part.
    """

    name: str
    vertices: Any
    triangles: Any
    material: Any
    times: Any = None
    translations: Any = None
    rotations: Any = None
    smooth: bool = False
    rates: Any = None

    def build(self):
        """The Part with its Mesh and motion."""
        motion = None
        if self.rates is not None:
            curves = [_core.Curve(self.times, values, "hermite", in_tangents=rates, out_tangents=rates)
                      for values, rates in zip((self.translations, self.rotations), self.rates)]
            motion = _core.CurveMotion(*curves)
        elif self.times is not None:
            motion = _core.KeyframeMotion(times=self.times, translations=self.translations, rotations=self.rotations)
        return Part(self.name, _core.Mesh(self.vertices, self.triangles), self.material, motion, smooth=self.smooth)
