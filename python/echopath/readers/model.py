"""What a foreign file holds, in the axes and units of a scene."""
from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from ..arguments.checks import an, anything, checked, optional, positive, real, vector
from ..base.classes.equality import has_same_fields
from ..base.numerics.placements import placement
from ..base.text.counts import counted
from ..trajectories import Trajectory


@dataclass(frozen=True, eq=False)
class ModelNode:
    """One node of a model.

    name: its own, without the parent's; unique among its siblings and fit for a scene (readers see to both)
    parent: index of an earlier node of the model, -1: the model itself
    placement: [4, 4] at rest, relative to the parent, m; None: at the parent's place
    motion: a Motion relative to the parent, or None; a node with a deformation has none, as in a scene
    mesh: ep.Mesh, or None for a group; deformation: a VertexSequence or a Skin of that mesh, or None
    material: ep.Material or a name in ep.materials, None without a mesh; foreign_material: its name in the file, ""
    without one; smooth: whether the mesh stands for a curved surface (Scene.add)
    """

    name: str
    parent: int = -1
    placement: NDArray[np.float64] | None = None
    motion: _core.Motion | None = None
    mesh: _core.Mesh | None = None
    deformation: _core.Deformation | None = None
    material: _core.Material | str | None = None
    foreign_material: str = ""
    smooth: bool = False

    def __eq__(self, other) -> bool:
        return has_same_fields(self, other) if isinstance(other, ModelNode) else NotImplemented

    def __hash__(self) -> int:
        return hash((self.name, self.parent, self.foreign_material))


@dataclass(frozen=True)
class Model:
    """A tree of nodes read from a file: x forward, y left, z up, lengths in m (Scene.add puts it into a scene).

    nodes: tuple of ModelNode, parents before their children
    format: of the file, such as "glTF 2.0"; unit: m per unit of the file; up: its vertical axis, "x", "y" or "z"
    animations: names of all animations of the file; animation: the one that the motions follow, None: at rest
    duration: of that animation in s, 0 at rest
    notes: sentences that say what of the file was left out, guessed or mended
    motion: of the whole, such as the Trajectory that it goes along; None: Scene.add says
    """

    nodes: tuple[ModelNode, ...]
    format: str = ""
    unit: float = 1.0
    up: str = "z"
    animations: tuple[str, ...] = ()
    animation: str | None = None
    duration: float = 0.0
    notes: tuple[str, ...] = field(default=())
    motion: _core.Motion | None = None

    @checked(self=anything, position=vector, yaw=real(unit="rad"))
    def placed(self, *, position: ArrayLike = (0.0, 0.0, 0.0), yaw: float = 0.0) -> Model:
        """The model moved and turned in its own axes, so that it stands at its origin and looks along +x.

        For files that have it elsewhere: what moves a model, such as a trajectory, carries its origin and turns about it.
        position: [3] m, where what was the origin comes to be; yaw: rad about z (left positive), by which it is turned before
        Returns a Model with one node more. Raises TypeError or ValueError naming the argument; warns (RuntimeWarning) of a yaw
        beyond a turn, which looks like degrees.
        """
        _core.warn_of_turns(yaw)
        above = ModelNode("placed", placement=placement(position, yaw, None))
        return replace(self, nodes=(above, *(replace(node, parent=node.parent + 1) for node in self.nodes)))

    def along(self, trajectory: Trajectory, *, way: float | None = None) -> Model:
        """The model as it goes along a trajectory: its looped animation is played by the distance, and stops with it.

        Of glTF and USD files, loaded with loop=True; nodes, skins and morph targets move as animated, whatever the offset: the
        first pose is that at the begin of the trajectory. A way that the animation makes by itself is taken out of it.
        trajectory: of the model's origin; way: m of one loop. None: as far as the animation goes ahead, or, of those that stay in
            place, as far as points on the ground are pushed back: feet that stand then stand on a straight way. In curves they
            turn with the body
        Returns a Model that `Scene.add` puts on its trajectory. Raises TypeError or ValueError naming the argument, also where
        the animation is not looped, or nothing tells the way.
        """
        from ..scene.along import model_along

        return model_along(self, an(Trajectory)("trajectory", trajectory), optional(positive("m"))("way", way))

    @property
    def num_triangles(self) -> int:
        """Of all meshes."""
        return sum(len(node.mesh.triangles) for node in self.nodes if node.mesh is not None)

    def __repr__(self) -> str:
        meshes = sum(node.mesh is not None for node in self.nodes)
        return f"Model({self.format}, {counted(meshes, 'mesh')}, {counted(self.num_triangles, 'triangle')})"
