"""Objects of a scene, to be read and changed in place: what `scene["street/car"]` is."""
from __future__ import annotations

import math

import numpy as np

from .. import _core
from ..arguments.checks import ArrayLike, anything, checked, flag, real, refused, vector
from ..arguments.frame_times import lifetime_rule
from ..base.classes.known_attributes import known_attributes
from ..base.classes.made_by import made_by
from ..base.materials import known_material
from ..base.numerics import placements
from ..base.text.counts import counted
from ..trajectories.trajectory import Trajectory
from .carried import carried_motion

ANGLE = real(unit="rad")
ALWAYS = -math.inf, math.inf  # s, the lifetime of what has none


class FixedArray(np.ndarray):
    """A read-only array: its entries cannot be set, and `+=` and the like make a new array."""

    def __new__(cls, values) -> FixedArray:
        array = np.array(values, np.float64).view(cls)
        array.flags.writeable = False
        return array

    def __iadd__(self, other):
        return self + other

    def __isub__(self, other):
        return self - other

    def __imul__(self, other):
        return self * other

    def __itruediv__(self, other):
        return self / other


def _during(argument: str, value) -> tuple[float, float]:
    begin, end = lifetime_rule(argument, value)
    if not math.isfinite(end - begin):
        raise refused(ValueError, argument, "finite", value)
    return begin, end


@known_attributes
@made_by('scene["name"]')
class SceneNode:
    """An object of a scene, read and changed in place: `scene["street/car"].position += (1.0, 0.0, 0.0)`.

    It stands for a full name, so once the object is removed it raises KeyError. What is traced after a change is what a
    scene would give that was built so from the start; paths that were traced before it keep the scene that they saw.
    """

    __slots__ = ("_scene", "_name")

    def __init__(self, scene: _core.Scene, name: str):
        self._scene, self._name = scene, name

    @property
    def name(self) -> str:
        """Full name, "street/car"."""
        return self._name

    @property
    def parent(self) -> SceneNode | None:
        """The object that carries it, None: the scene itself."""
        above, _, _ = self._name.rpartition("/")
        return SceneNode(self._scene, above) if above else None

    @property
    def children(self) -> list[SceneNode]:
        """The objects right below it, in their order."""
        above = self._node.name
        return [SceneNode(self._scene, node.name) for node in self._scene.nodes if node.name.rpartition("/")[0] == above]

    @property
    def mesh(self) -> _core.Mesh | None:
        """Its own Mesh, None where it has none, as an actor, whose parts have them."""
        return self._node.mesh

    @property
    def meshes(self) -> list[_core.SceneMesh]:
        """Of `scene.meshes`, with their mesh IDs, its own and those below it; none of what is not visible."""
        names = (self._node.name, self._name + "/")
        return [mesh for mesh in self._scene.meshes if mesh.name == names[0] or mesh.name.startswith(names[1])]

    @property
    def position(self) -> FixedArray:
        """[3] in m: where its own origin is at rest, in the axes of its parent."""
        return FixedArray(self._node.placement[:3, 3])

    @position.setter
    def position(self, value) -> None:
        with self._scene._edit():
            self._change(placement=placements.moved_to(self._node.placement, vector("position", value)))

    @property
    def yaw(self) -> float:
        """rad about the parent's z, left positive: where its own +x points at rest. To set it turns the object about its
        own origin; its motion stays, which is in the axes of the parent."""
        return placements.yaw_of(self._node.placement)

    @yaw.setter
    def yaw(self, value) -> None:
        yaw = ANGLE("yaw", value)
        _core.warn_of_turns(yaw)
        with self._scene._edit():
            self._change(placement=placements.turned_to(self._node.placement, yaw))

    @property
    def transform(self) -> FixedArray:
        """[4, 4] in m: parent_from_object at rest, which position and yaw are part of."""
        return FixedArray(self._node.placement)

    @transform.setter
    def transform(self, value) -> None:
        self._change(placement=placements.matrix4(value))

    @property
    def motion(self) -> _core.Motion | _core.Deformation | None:
        """A LinearMotion, KeyframeMotion, CurveMotion, VertexSequence, MorphTargets or Skin, in the axes of the parent about
        the object's own origin (`Scene.add`); None: at rest. To set a Skin the object must be a part of a mesh, as
        `Scene.add` makes them. A Trajectory brings its `lifetime`, which goes when another motion is set; one that was set by
        hand stays."""
        node = self._node
        return node.deformation or node.motion

    @motion.setter
    def motion(self, value: _core.Motion | _core.Deformation | None) -> None:
        with self._scene._edit():
            mesh = self._node.mesh
            if isinstance(value, _core.Skin) and mesh is not None and mesh.whole is None:
                rule = f"none that divides its mesh, as a Skin does; remove '{self._name}' and add it anew"
                raise refused(ValueError, "motion", rule, value)
            motion, deformation = split_motion(value, mesh, self._name)
            self._change(motion=motion, deformation=deformation, lifetime=lifetime_of(value) or _lifetime_by_hand(self._node))

    @property
    def material(self) -> _core.Material | None:
        """The Material of all meshes at and below it, None where they differ or there are none. To set it gives them all the
        same: a Material or a name in `materials`."""
        found = [node.material for _, node in self._with_meshes()]
        return found[0] if found and all(material == found[0] for material in found) else None

    @material.setter
    def material(self, value) -> None:
        material, material_name = known_material(value)
        with self._scene._edit():
            found = self._with_meshes()
            if not found:
                raise refused(ValueError, "material", f"of an object with meshes, which '{self._name}' is not", value)
            for index, node in found:
                self._scene._change(index, node.replace(material=material, material_name=material_name))

    @property
    def visible(self) -> bool:
        """False: neither it nor what is below it takes part in anything. Rays do not meet it, it has no mesh ID, and labels
        leave it out, but it stays in the scene and in frame files, and selections may name it."""
        return self._node.visible

    @visible.setter
    def visible(self, value) -> None:
        self._change(visible=flag("visible", value))

    @property
    def lifetime(self) -> tuple[float, float] | None:
        """(begin, end) in s, either of which may be infinite: it and what is below it take part in the frames that lie wholly
        between them, and are not visible in others. None: in all. A Trajectory with outside="absent" brings its own."""
        return self._node.lifetime

    @lifetime.setter
    def lifetime(self, value) -> None:
        self._change(lifetime=value)

    @checked(self=anything, place=vector, during=_during)
    def carried(self, place: ArrayLike = placements.ORIGIN, *, during: tuple[float, float]) -> _core.CurveMotion:
        """The way in the world of a place on it, as a radar goes that rides there: on a trailer, a drone, the arm of a robot.

        `radar.replace(position=(0, 0, 0), motion=scene["robot/arm"].carried((0, 0, 0.3), during=(0.0, 5.0)))` looks where the
        +x of the object points, turned by the radar's own yaw and pitch.
        place: [3] m in the axes of the object, those of its mesh; during: (begin, end) in s, before and after which it stands
        Positions err by some micrometres at most and directions by some 1e-6 rad. Later changes of the scene do not matter.
        Raises TypeError or ValueError naming the argument, also where motions of it or of what carries it do not cover the time,
        ValueError where one of these deforms or is mirrored: give an object that it carries.
        """
        nodes = [self._node]
        while nodes[0].parent >= 0:
            nodes.insert(0, self._scene.nodes[nodes[0].parent])
        return carried_motion(nodes, self._name, place, during)

    @property
    def _index(self) -> int:
        return self._scene._index_of(self._name)

    @property
    def _node(self) -> _core.Node:
        return _core.Scene.__getitem__(self._scene, self._name)  # in one step: no edit of another thread comes between

    def _change(self, **fields) -> None:
        with self._scene._edit():
            index = self._index
            self._scene._change(index, self._scene._node(index).replace(**fields))

    def _with_meshes(self) -> list:
        """(index, Node) of what has a mesh, at and below it, visible or not."""
        below = self._name + "/"
        return [(index, node) for index, node in enumerate(self._scene.nodes)
                if node.mesh is not None and (node.name == self._name or node.name.startswith(below))]

    def __eq__(self, other) -> bool:
        return isinstance(other, SceneNode) and self._scene is other._scene and self._name == other._name

    def __hash__(self) -> int:
        return hash((id(self._scene), self._name))

    def __repr__(self) -> str:
        if self._name not in self._scene:
            return f"SceneNode('{self._name}', removed)"
        position = ", ".join(f"{value:g}" for value in self.position)
        hidden = "" if self._scene._takes_part(self._index) else ", not visible"
        meshes = counted(len(self.meshes), "mesh")
        return f"SceneNode('{self._name}', position=({position}) m, yaw={self.yaw:g} rad, {meshes}{hidden})"


def lifetime_of(motion) -> tuple[float, float] | None:
    """When what moves so is there, (begin, end) in s; None: always."""
    return motion.lifetime if isinstance(motion, Trajectory) else None


def _lifetime_by_hand(node: _core.Node) -> tuple[float, float] | None:
    """The lifetime of a node, but for one that is that of its way, as a Trajectory has brought it."""
    motion = node.motion
    if isinstance(motion, _core.CurveMotion) and motion.translation is not None:
        times = np.asarray(motion.translation.times) - motion.offset
        if node.lifetime == (times[0], times[-1]):
            return None
    return node.lifetime


def split_motion(motion, mesh, name: str) -> tuple:
    """What moves an object as the core has it: (Motion or None, Deformation or None), one of them at most."""
    if isinstance(motion, Trajectory):
        motion = motion.motion()
    deformation = motion if isinstance(motion, _core.Deformation) else None
    if deformation is not None and mesh is None:
        raise ValueError(f"motion: a {type(motion).__name__} needs a mesh, and '{name}' has none of its own")
    if not (motion is None or deformation or isinstance(motion, _core.Motion)):
        raise refused(TypeError, "motion", "a Motion, a Deformation or None", motion)
    return (None if deformation else motion), deformation
