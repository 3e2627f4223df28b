"""Actors: named parts, each a mesh with a material and a motion of its own."""
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Part:
    """One labelled part of an actor.

    name: path below the actor; '/' makes group nodes, so "arm_left/hand" is the node "hand" in the group "arm_left".
    mesh: echopath.Mesh. material: a name in echopath.materials, or an echopath.Material.
    motion: motion relative to the actor's root (group nodes do not move), or None.
    position: [3] place of the mesh in the actor's frame in m, which the motion adds to.
    smooth: whether the mesh stands for a curved surface (Scene.add).
    """

    name: str
    mesh: Any
    material: Any
    motion: Any = None
    position: tuple = (0.0, 0.0, 0.0)
    smooth: bool = False


@dataclass(frozen=True)
class Actor:
    """Parts that are placed in a scene as one object.

    The actor's frame has x forward, y left, z up and the floor at z = 0.
    parts: list of Part, whose names differ.
    """

    parts: list = field(default_factory=list)

    def __post_init__(self):
        names = [part.name for part in self.parts]
        for name in names:
            if not name or any(not step for step in name.split("/")):
                raise ValueError(f"parts must have names without empty steps, got {name!r}")
            if names.count(name) > 1:
                raise ValueError(f"parts must have different names, got {name!r} twice")

    @property
    def num_triangles(self):
        """Of all parts."""
        return sum(len(part.mesh.triangles) for part in self.parts)

    def __repr__(self):
        return f"Actor({len(self.parts)} parts, {self.num_triangles} triangles)"


@dataclass(frozen=True)
class PartArrays:
    """A part as plain arrays.

    vertices [V, 3] in m, triangles [F, 3]; keyframes times [T] in s, translations [T, 3] in m and rotations [T, 4]
    (unit quaternions w, x, y, z) of the part relative to the actor's root. times None: the part rests. smooth: as of Part.
    """

    name: str
    vertices: Any
    triangles: Any
    material: Any
    times: Any = None
    translations: Any = None
    rotations: Any = None
    smooth: bool = False

    def build(self):
        """The Part with its Mesh and KeyframeMotion."""
        from echopath import _core

        motion = None
        if self.times is not None:
            motion = _core.KeyframeMotion(times=self.times, translations=self.translations, rotations=self.rotations)
        return Part(self.name, _core.Mesh(self.vertices, self.triangles), self.material, motion, smooth=self.smooth)
